"""Peak memory of ``daguerre render`` above the imported package, against what the picture needs.

    python bench/memory.py [--json] [--case NAME ...] [--scene FILE.glb ...]

Allowed: 3 x (vertices + indices + decoded 8-bit textures) + 200 B per pixel + 32 MB. The scenes are
made here, in a temporary folder; each case is a process of its own. ``peak_memory_mb`` is the
process's largest resident memory less that after the import of ``daguerre``, its cameras and its
scenes. It reads /proc: Linux only.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

MB = 1e6
CHILD = """
import json, sys
import daguerre
daguerre.Camera, daguerre.Scene  # imported on first use, with numpy
def resident(key):  # ru_maxrss would count the process that started this one
    lines = open("/proc/self/status").read().splitlines()
    return int(next(line for line in lines if line.startswith(key)).split()[1]) << 10
before = resident("VmRSS")
from daguerre.cli import main
code = main(sys.argv[1:])
print(json.dumps({"code": code or 0, "before": before, "peak": resident("VmHWM")}))
"""


@dataclass(frozen=True)
class Case:
    """One render.

    Attributes:
        make: Writes the scene and returns the bytes of its vertices and indices, and of its
            decoded textures.
        arguments: For ``daguerre render``, besides scene and outputs.
        pixels: Pixels of the picture.
        outputs: Files that are written. A PNG loads OpenImageIO, 32 MB of code that counts too.
    """

    make: Callable[[Path], tuple[int, int]]
    arguments: tuple[str, ...]
    pixels: int
    outputs: tuple[str, ...] = ("out.exr", "out.png")


class Glb:
    """A binary glTF in the making; buffers go straight to the file."""

    def __init__(self) -> None:
        self.blobs: list[bytes] = []
        self.root: dict[str, list[object]] = {
            key: [] for key in ("bufferViews", "accessors", "images", "textures", "materials")
        }

    def view(self, data: bytes) -> int:
        """Adds a bufferView; returns its index."""
        offset = sum(map(len, self.blobs))
        self.blobs.append(data + b"\0" * (-len(data) % 4))
        self.root["bufferViews"].append(
            {"buffer": 0, "byteOffset": offset, "byteLength": len(data)}
        )
        return len(self.root["bufferViews"]) - 1

    def accessor(self, values: np.ndarray) -> int:
        """Adds an array; returns its index."""
        kind = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}[
            1 if values.ndim == 1 else values.shape[1]
        ]
        rows = values.reshape(len(values), -1)
        self.root["accessors"].append(
            {
                "bufferView": self.view(np.ascontiguousarray(values).tobytes()),
                "componentType": 5126 if values.dtype == np.float32 else 5125,
                "count": len(values),
                "type": kind,
                "min": rows.min(axis=0).tolist(),
                "max": rows.max(axis=0).tolist(),
            }
        )
        return len(self.root["accessors"]) - 1

    def write(self, path: Path, meshes: list[object]) -> None:
        """Every mesh once, and a camera that looks along -z from above."""
        nodes: list[object] = [{"mesh": i} for i in range(len(meshes))]
        down = {"rotation": [-0.70710678, 0, 0, 0.70710678]}
        nodes.append({**down, "extensions": {"KHR_lights_punctual": {"light": 0}}})
        look = {"rotation": [-0.38268343, 0, 0, 0.92387953], "translation": [0, 3, 3], "camera": 0}
        root = {
            "asset": {"version": "2.0"},
            "buffers": [{"byteLength": sum(map(len, self.blobs))}],
            "meshes": meshes,
            "nodes": [*nodes, look],
            "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}}],
            "scenes": [{"nodes": list(range(len(nodes) + 1))}],
            "scene": 0,
            "extensionsUsed": ["KHR_lights_punctual"],
            "extensions": {"KHR_lights_punctual": {"lights": [{"type": "directional"}]}},
            **{key: value for key, value in self.root.items() if value},
        }
        text = json.dumps(root).encode()
        text += b" " * (-len(text) % 4)
        size = sum(map(len, self.blobs))
        with path.open("wb") as file:
            header = np.array([0x46546C67, 2, 28 + len(text) + size, len(text), 0x4E4F534A], "<u4")
            file.write(header.tobytes() + text)
            file.write(np.array([size, 0x004E4942], "<u4").tobytes())
            for blob in self.blobs:
                file.write(blob)


def sheet(triangles: int) -> dict[str, np.ndarray]:
    """A wavy grid of 4 m with about so many triangles."""
    n = round((triangles / 2) ** 0.5) + 1
    x = np.linspace(-2, 2, n, dtype=np.float32)
    points = np.empty((n, n, 3), np.float32)
    points[:, :, 0], points[:, :, 2] = x, x[:, None]
    points[:, :, 1] = 0.1 * np.sin(7 * x) * np.cos(9 * x[:, None])
    corner = (np.arange(n - 1, dtype=np.uint32)[:, None] * n + np.arange(n - 1)).ravel()
    quad = corner[:, None] + np.array([0, n, 1, 1, n, n + 1], np.uint32)
    uv = np.stack(np.broadcast_arrays(x[None] / 4 + 0.5, x[:, None] / 4 + 0.5), axis=2)
    return {
        "POSITION": points.reshape(-1, 3),
        "indices": quad.ravel().astype(np.uint32),
        "TEXCOORD_0": uv.reshape(-1, 2).astype(np.float32),
        "NORMAL": np.tile(np.array([0, 1, 0], np.float32), (n * n, 1)),
    }


def make_grid(path: Path, *, bare: bool = True, triangles: int = 5_000_000) -> tuple[int, int]:
    """One large mesh; ``bare``: positions and indices alone, which leaves the least room."""
    arrays = sheet(triangles)
    indices = arrays.pop("indices")
    if bare:
        arrays = {"POSITION": arrays["POSITION"]}
    made = Glb()
    attributes = {key: made.accessor(values) for key, values in arrays.items()}
    made.write(
        path, [{"primitives": [{"attributes": attributes, "indices": made.accessor(indices)}]}]
    )
    return indices.nbytes + sum(a.nbytes for a in arrays.values()), 0


def make_textured(path: Path, *, count: int = 20, size: int = 4096) -> tuple[int, int]:
    """Squares with a JPEG each."""
    made, meshes = Glb(), []
    arrays = sheet(2)
    indices = arrays.pop("indices")
    attributes = {key: made.accessor(values) for key, values in arrays.items()}
    corners = made.accessor(indices)
    y, x = np.mgrid[0:size, 0:size]
    for i in range(count):
        picture = np.stack([(x * (i + 1) // 16) & 255, (y >> 4) & 255, (x ^ y) >> 4 & 255], axis=2)
        data = _jpeg(path.with_name("texture.jpg"), picture.astype(np.uint8))
        made.root["images"].append({"bufferView": made.view(data), "mimeType": "image/jpeg"})
        made.root["textures"].append({"source": i})
        made.root["materials"].append({"pbrMetallicRoughness": {"baseColorTexture": {"index": i}}})
        meshes.append(
            {"primitives": [{"attributes": attributes, "indices": corners, "material": i}]}
        )
    made.write(path, meshes)
    return indices.nbytes + sum(a.nbytes for a in arrays.values()), count * size * size * 3


def _jpeg(path: Path, pixels: np.ndarray) -> bytes:
    import OpenImageIO as oiio

    output = oiio.ImageOutput.create(str(path))
    height, width, channels = pixels.shape
    output.open(str(path), oiio.ImageSpec(width, height, channels, oiio.UINT8))
    output.write_image(pixels)
    output.close()
    return path.read_bytes()


def make_small(path: Path) -> tuple[int, int]:
    """Two hundred triangles: the picture is what takes memory."""
    return make_grid(path, bare=False, triangles=200)


def of_file(file: Path) -> Callable[[Path], tuple[int, int]]:
    """A scene that exists; what it needs is what the reader found."""

    def make(path: Path) -> tuple[int, int]:
        import daguerre as dg

        scene = dg.load(file)
        arrays = {
            id(a): a.nbytes
            for m in scene.meshes
            for a in (m.positions, m.indices, m.normals, m.uv, m.uv1, m.tangents, m.colors)
            if a is not None
        }
        pictures = {id(t.pixels): t.pixels.nbytes for t in scene.textures}
        path.symlink_to(file.resolve())
        return sum(arrays.values()), sum(pictures.values())

    return make


SMALL = ("--res", "320x180", "--spp", "1", "-q")
LARGE = ("--res", "3840x2160", "--spp", "1", "-q")
TWICE = ("--res", "3840x2160", "--spp", "2", "--checkpoint", "1", "-q")  # one is in between
LENS = ("--lens", "double-gauss-50mm-f2", "--f-stop", "2")
CASES = {
    "grid-5m": Case(make_grid, SMALL, 320 * 180, ("out.exr",)),
    "grid-5m-all": Case(lambda path: make_grid(path, bare=False), SMALL, 320 * 180),
    "textures-20x4096": Case(make_textured, SMALL, 320 * 180),
    "4k": Case(make_small, LARGE, 3840 * 2160),
    "4k-lens": Case(make_small, (*LARGE, *LENS), 3840 * 2160),
    "4k-lens-checkpoint": Case(make_small, (*TWICE, *LENS), 3840 * 2160),
}


def measure(name: str, case: Case) -> dict[str, object]:
    """Renders in a process of its own."""
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder) / "scene.glb"
        vertices, textures = case.make(scene)
        command = [sys.executable, "-c", CHILD, "render", str(scene)]
        command += [*case.arguments, *(f"-o{folder}/{name}" for name in case.outputs)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise SystemExit(f"{name}: {done.stderr}")
    facts = json.loads(done.stdout.splitlines()[-1])
    if facts["code"]:
        raise SystemExit(f"{name}: {done.stderr}")
    allowed = 3 * (vertices + textures) + 200 * case.pixels + 32 * MB
    return {
        "peak_memory_mb": round((facts["peak"] - facts["before"]) / MB, 1),
        "allowed_mb": round(allowed / MB, 1),
        "vertices_and_indices_mb": round(vertices / MB, 1),
        "textures_mb": round(textures / MB, 1),
        "imported_mb": round(facts["before"] / MB, 1),
        "passed": facts["peak"] - facts["before"] <= allowed,
    }


def main() -> None:
    """Measures the cases and prints them."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--json", action="store_true", help="one JSON object")
    parser.add_argument("--case", action="append", choices=list(CASES), help="only these")
    parser.add_argument("--scene", action="append", type=Path, help="a file instead of the cases")
    options = parser.parse_args()
    cases = {name: CASES[name] for name in options.case or (() if options.scene else CASES)}
    for file in options.scene or ():
        cases[file.stem] = Case(of_file(file), SMALL, 320 * 180)
    results = {}
    for name, case in cases.items():
        results[name] = measure(name, case)
        if not options.json:
            print(f"{name}: {json.dumps(results[name])}", flush=True)
    if options.json:
        print(json.dumps(results, indent=1))


if __name__ == "__main__":
    main()
