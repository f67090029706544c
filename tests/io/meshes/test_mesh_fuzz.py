"""Files of meshes and grids, changed at random: each can be used, or is one clear error."""

from __future__ import annotations

import gzip
import time
import tracemalloc
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from daguerre.errors import InputError
from daguerre.files.notes import Notes
from daguerre.io.meshes import obj, ply, serialized
from daguerre.io.meshes.file_mesh import FileMesh
from daguerre.io.volumes import nanovdb, vol
from daguerre.io.volumes.grid import FileGrid
from daguerre.scene.scene import Scene
from tests.support import mesh_files as write
from tests.support.nanovdb_files import Writer, segment

_RNG = np.random.default_rng(6)
_POINTS = dict(zip("xyz", _RNG.random((3, 12)), strict=True))
_MORE = _POINTS | dict(
    zip(("nx", "ny", "nz", "u", "v", "r", "g", "b"), _RNG.random((8, 12)), strict=True)
)
_FACES = [tuple(_RNG.integers(0, 12, n).tolist()) for n in (3, 3, 4, 3, 5, 4, 3)]
_UV = [[0.5] * (2 * len(face)) for face in _FACES]
_OBJ = (
    "# comment\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.5\nvt 0 0\nvt 1 1\nvn 0 0 1\ng a\n"
    "f 1/1/1 2/2/1 3/1/1 4//1\nf -1 -2 \\\n -3\nusemtl b\nf 1//1 2//1 3//1\nl 1 2\n"
)
#: Words that break things.
_WORDS = (
    *b"0 -1 1e39 nan inf 4294967295 99999999999 3.5 / list float uchar 1//2/3 # \\".split(),
    *(b"", b"\n", b"\xff", b"\x1f\x8b", b"element face 7"),
)
_NUMBERS = (0, 1, 0x7FFFFFFF, 0xFFFFFFFF, 0x10000)
_LIMIT_S, _LIMIT_BYTES = 5.0, 300 << 20


@cache
def seeds() -> dict[str, bytes]:
    """Good files by the end of their names."""
    mesh: dict[str, Any] = {
        "positions": _RNG.random((6, 3)), "normals": _RNG.random((6, 3)), "uv": _RNG.random((6, 2)),
        "triangles": [(0, 1, 2), (3, 4, 5)], "name": "mesh",
    }  # fmt: skip
    grid = Writer({(0, 0, 0): 1.0, (9, 0, 0): 2.0}).bytes()
    return {
        "text.ply": write.ply(_MORE, _FACES, ""),
        "little.ply": write.ply(_MORE, _FACES, "<", uv=_UV),
        "big.ply": write.ply(_POINTS, _FACES, ">", length="i4", index="u2"),
        "triangles.ply": write.ply(_POINTS, _FACES[:2] * 50, "<"),
        "packed.ply": gzip.compress(write.ply(_MORE, _FACES)),
        "mesh.obj": _OBJ.encode(),
        "four.serialized": write.serialized([mesh, mesh]),
        "three.serialized": write.serialized([mesh, mesh], 3, "<f8"),
        "smoke.vol": write.vol(_RNG.random((2, 3, 4, 1))),
        "raw.nvdb": grid,
        "plain.nvdb": segment([("a", grid), ("b", grid)]),
        "zipped.nvdb": segment([("a", grid)], 1),
    }


READ: dict[str, Callable[[Path], Any]] = {
    ".ply": lambda path: ply.read(path, Notes()),
    ".obj": lambda path: obj.read(path, Notes()),
    ".serialized": lambda path: [serialized.read(path, i) for i in (0, 1)],
    ".vol": vol.read,
    ".nvdb": nanovdb.read,
}


def broken(data: bytes, rng: np.random.Generator) -> bytes:
    """A file with bytes, words, numbers or parts changed, doubled or cut."""
    out = bytearray(data)
    # Heads lie more often than bodies: places are near the beginning or the end, or anywhere.
    size = max(len(out), 1)
    for _ in range(rng.integers(1, 5)):
        at = int(rng.choice([rng.integers(0, min(size, 400)), rng.integers(0, size),
                             max(size - 1 - rng.integers(0, 60), 0)]))  # fmt: skip
        how = rng.integers(0, 7)
        if how == 0:
            out[at : at + 1] = bytes([rng.integers(0, 256)])
        elif how == 1:
            out[at : at + 4] = rng.choice(_NUMBERS).astype("<u4").tobytes()
        elif how == 2:
            out[at : at + 8] = rng.integers(-(1 << 40), 1 << 40, 1).astype("<i8").tobytes()
        elif how == 3:
            del out[at:]
        elif how == 4:
            word = _WORDS[rng.integers(0, len(_WORDS))]
            end = out.find(b" ", at)
            out[at : max(end, at)] = word if end - at < 80 else b""
        elif how == 5:
            out[at:at] = out[at : at + int(rng.integers(1, 200))]
        else:
            del out[at : at + int(rng.integers(1, 40))]
        size = max(len(out), 1)
    return bytes(out)


def check(path: Path) -> bool:
    """Whether the file can be used; all else is one error that names it."""
    started = time.process_time()
    tracemalloc.start()
    try:
        found = READ[path.suffix](path)
        for one in found if isinstance(found, list) else [found]:
            _use(one)
        return True
    except InputError as error:
        told = str(error)
    finally:
        _, peak = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        assert peak < _LIMIT_BYTES
        assert time.process_time() - started < _LIMIT_S
    assert told.startswith(str(path)), told
    assert len(told) < 600
    return False


def _use(found: FileMesh | FileGrid) -> None:
    if isinstance(found, FileGrid):
        assert np.isfinite(found.values).all()
        assert np.isfinite(found.transform).all()
        return
    scene = Scene()
    try:
        found.add_to(scene, "m")
    except InputError as error:  # numbers of a face that is no polygon, at worst
        raise AssertionError(f"a mesh that is read can be used, got {error}") from None
    repr(found)


def run(tmp_path: Path, count: int, seed: int) -> int:
    """Number of files that can be used."""
    rng, good = np.random.default_rng(seed), 0
    names = list(seeds())
    for i in range(count):
        name = names[i % len(names)]
        path = tmp_path / name
        path.write_bytes(broken(seeds()[name], rng))
        good += check(path)
    return good


def test_the_seeds_themselves_can_be_used(tmp_path: Path) -> None:
    for name, data in seeds().items():
        path = tmp_path / name
        path.write_bytes(data)
        assert check(path), name


def test_broken_files_can_be_used_or_are_errors(tmp_path: Path) -> None:
    assert 60 < run(tmp_path, 600, 1) < 540


@pytest.mark.slow
def test_very_many_broken_files(tmp_path: Path) -> None:
    run(tmp_path, 20_000, 2)
