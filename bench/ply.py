"""Speed of reading meshes: megabytes of file for each second of CPU time, on one thread.

    python bench/ply.py [--json] [--size 1000] [--runs 3] [FILE ...]

Files of ``--size`` MB: ``triangles``, binary, with normals and texture coordinates; ``bare``,
with positions alone; ``quads`` in big-endian order; ``mixed``, triangles and quadrangles in turn;
and, of a tenth of the size, ``text`` and ``gzip``, whose bytes are counted unpacked. ``read`` is
the reader alone, ``scene`` with ``Scene.add_mesh``, which checks the numbers and divides polygons.
Or files of your own. Each is the median of runs; files are in the cache of the system.
"""

from __future__ import annotations

import argparse
import gzip
import json
import os
import statistics
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(name, "1")  # before numpy reads them

import numpy as np  # noqa: E402

import daguerre as dg  # noqa: E402
from daguerre.files.notes import Notes  # noqa: E402
from daguerre.importers.file_bytes import read_bytes  # noqa: E402
from daguerre.importers.meshes import obj, ply, serialized  # noqa: E402

_READERS: dict[str, Callable[[Path], Any]] = {
    ".ply": lambda path: ply.read(path, Notes()),
    ".gz": lambda path: ply.read(path, Notes()),
    ".obj": lambda path: obj.read(path, Notes()),
    ".serialized": serialized.read,
}


def grid(side: int) -> tuple[np.ndarray, np.ndarray]:
    """Points of a wavy square, and its quadrangles."""
    u, v = np.meshgrid(*[np.linspace(0, 1, side, dtype=np.float32)] * 2)
    points = np.stack([u, v, 0.1 * np.sin(9 * u) * np.cos(7 * v)], axis=-1).reshape(-1, 3)
    i = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).reshape(-1)
    return points, np.stack([i, i + 1, i + side + 1, i + side], axis=1)


def head(order: str, vertices: int, names: str, faces: int) -> bytes:
    """A header."""
    kind = {"": "ascii", "<": "binary_little_endian", ">": "binary_big_endian"}[order]
    lines = ["ply", f"format {kind} 1.0", f"element vertex {vertices}"]
    lines += [f"property float {name}" for name in names.split()]
    lines += [f"element face {faces}", "property list uchar int vertex_indices", "end_header", ""]
    return "\n".join(lines).encode()


def listed(corners: np.ndarray, order: str) -> np.ndarray:
    """Faces with their lengths in front."""
    kind = np.dtype([("n", "u1"), ("v", order + "i4", (corners.shape[1],))])
    rows = np.empty(len(corners), kind)
    rows["n"], rows["v"] = corners.shape[1], corners
    return rows


def made(name: str, size: float) -> bytes:
    """A file of about ``size`` bytes."""
    if name in ("text", "gzip"):
        size /= 10
    order = {"quads": ">", "text": ""}.get(name, "<")
    full = name in ("triangles", "gzip")
    per_vertex = {"bare": 38, "quads": 29, "mixed": 33.5, "text": 62}.get(name, 58)
    points, quads = grid(int((size / per_vertex) ** 0.5))
    rows = np.concatenate([points, points, points[:, :2]], axis=1) if full else points
    names = "x y z nx ny nz u v" if full else "x y z"
    triangles = quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
    if name == "text":
        body = [" ".join(map(repr, row)) for row in rows.tolist()]
        body += [f"3 {a} {b} {c}" for a, b, c in triangles.tolist()]
        return head(order, len(rows), names, len(triangles)) + "\n".join(body).encode()
    vertices = rows.astype(order + "f4").tobytes()
    if name == "quads":
        return head(order, len(rows), names, len(quads)) + vertices + listed(quads, order).tobytes()
    if name == "mixed":
        half = len(triangles) // 4
        pair = np.dtype(
            [("a", listed(triangles[:1], order).dtype), ("b", listed(quads[:1], order).dtype)]
        )
        both = np.empty(half, pair)
        both["a"], both["b"] = listed(triangles[:half], order), listed(quads[:half], order)
        return head(order, len(rows), names, 2 * half) + vertices + both.tobytes()
    data = (
        head(order, len(rows), names, len(triangles))
        + vertices
        + listed(triangles, order).tobytes()
    )
    return gzip.compress(data, 6) if name == "gzip" else data


def measure(name: str, path: Path, runs: int) -> dict[str, Any]:
    """Speeds of a file."""
    read, whole = [], []
    for _ in range(runs):
        before = time.process_time()
        mesh = _READERS[path.suffix](path)
        read.append(time.process_time() - before)
        mesh.add_to(dg.Scene())
        whole.append(time.process_time() - before)
    size = len(read_bytes(path)) / 1e6
    return {
        "file": name,
        "megabytes": round(size, 1),
        "read": round(size / statistics.median(read), 1),
        "scene": round(size / statistics.median(whole), 1),
    }


def main() -> None:
    """Prints a line for each file."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--size", type=float, default=1000)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("files", nargs="*", type=Path)
    options = parser.parse_args()
    found = [(path.name, path) for path in options.files]
    with tempfile.TemporaryDirectory() as folder:
        for name in () if found else ("triangles", "bare", "quads", "mixed", "text", "gzip"):
            path = Path(folder) / ("mesh.gz" if name == "gzip" else "mesh.ply")
            path.write_bytes(made(name, options.size * 1e6))
            show(measure(name, path, options.runs), options.json)
            path.unlink()
    for name, path in found:
        show(measure(name, path, options.runs), options.json)


def show(found: dict[str, Any], as_json: bool) -> None:
    """Prints a line."""
    if as_json:
        print(json.dumps(found))
    else:
        print("{file:20} {megabytes:8} MB  read {read} MB/s  scene {scene} MB/s".format(**found))


if __name__ == "__main__":
    main()
