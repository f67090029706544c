"""Speed of subdivision surfaces: limit faces for each second of CPU time, on one thread.

    python bench/subdivision.py [--json] [--faces 1000000] [--runs 5]

Control meshes: ``torus``, of quadrangles; ``creased``, the same with semi-sharp creases of 1.5
along every tenth ring; ``open``, a grid with a boundary, and a seam of texture coordinates; and
``triangles``, a torus for Loop. Level 2. ``first`` is a whole surface (checks, topology, positions,
normals); ``again`` are positions and normals for other control points; ``seams`` are values per
corner, ``first`` included. Each is the median of runs, in faces per second.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import time
from collections.abc import Callable
from typing import Any

for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(name, "1")  # before numpy reads them

import numpy as np  # noqa: E402

from daguerre.scene.subdivision import Refiner, Rules  # noqa: E402

LEVEL = 2


def grid(side: int, closed: bool) -> tuple[np.ndarray, np.ndarray]:
    """Points, and quadrangles of a torus or of an open square."""
    step = side if closed else side + 1
    i, j = (part.reshape(-1) for part in np.meshgrid(*[np.arange(side)] * 2, indexing="ij"))
    a, b = (i + 1) % step, (j + 1) % step
    quads = np.stack([i * step + j, a * step + j, a * step + b, i * step + b], axis=1)
    u, v = np.meshgrid(*[2 * np.pi * np.arange(step) / step] * 2, indexing="ij")
    if not closed:
        return np.stack([u, v, np.sin(3 * u) * np.sin(v)], axis=-1).reshape(-1, 3), quads
    far = 2 + np.cos(v)
    return np.stack([far * np.cos(u), far * np.sin(u), np.sin(v)], axis=-1).reshape(-1, 3), quads


def case(name: str, faces: int) -> tuple[np.ndarray, np.ndarray, str, Rules]:
    """Control points, faces, scheme and rules."""
    side = round((faces / 4**LEVEL / (2 if name == "triangles" else 1)) ** 0.5)
    points, quads = grid(side, name != "open")
    if name == "triangles":
        return points, np.concatenate([quads[:, :3], quads[:, [0, 2, 3]]]), "loop", Rules()
    if name != "creased":
        return points, quads, "catmull-clark", Rules()
    ring = np.arange(side)
    creases = [np.stack([i * side + ring, i * side + (ring + 1) % side], 1) for i in ring[::10]]
    rules = Rules(creases=np.concatenate(creases), crease_sharpness=1.5)
    return points, quads, "catmull-clark", rules


def speed(act: Callable[[], Any], faces: int, runs: int) -> int:
    """Faces per second of CPU time."""
    times = []
    for _ in range(runs):
        before = time.process_time()
        act()
        times.append(time.process_time() - before)
    return round(faces / statistics.median(times))


def measure(name: str, faces: int, runs: int) -> dict[str, Any]:
    """Speeds of one mesh."""
    points, polygons, scheme, rules = case(name, faces)
    sizes = np.full(len(polygons), polygons.shape[1])
    corners = polygons.reshape(-1)

    def whole() -> Refiner:
        made = Refiner(len(points), sizes, corners, scheme, LEVEL, rules)
        made.surface(points)
        assert made.vertices.size
        return made

    made = whole()
    count = len(made.parents)
    found = {
        "mesh": name,
        "faces": count,
        "first": speed(whole, count, runs),
        "again": speed(lambda: made.surface(points), count, runs),
    }
    if name == "open":
        uv = points[corners, :2] + (points[corners, :1] > np.pi)

        def seams() -> None:
            fresh = Refiner(len(points), sizes, corners, scheme, LEVEL, rules)
            fresh.face_varying(uv)

        found["seams"] = speed(seams, count, runs)
    return found


def main() -> None:
    """Prints a line for each mesh."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--faces", type=int, default=1_000_000)
    parser.add_argument("--runs", type=int, default=5)
    options = parser.parse_args()
    for name in ("torus", "creased", "open", "triangles"):
        found = measure(name, options.faces, options.runs)
        if options.json:
            print(json.dumps(found))
        else:
            speeds = (f"{key} {found[key] / 1e6:.2f} M/s" for key in ("first", "again", "seams")
                      if key in found)  # fmt: skip
            print(f"{name:10} {found['faces']:8} faces  {'  '.join(speeds)}")


if __name__ == "__main__":
    main()
