"""Mitsuba's serialized meshes: versions, precisions, several meshes, flags, lies, bombs."""

from __future__ import annotations

import struct
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.importers import file_bytes
from daguerre.importers.meshes import serialized
from tests.support.formats import mesh_files as write

_RNG = np.random.default_rng(4)
MESHES: list[dict[str, Any]] = [
    {"positions": _RNG.random((4, 3)), "triangles": [(0, 1, 2), (0, 2, 3)], "name": "eins"},
    {
        "positions": _RNG.random((5, 3)), "normals": _RNG.random((5, 3)), "uv": _RNG.random((5, 2)),
        "colors": _RNG.random((5, 3)), "triangles": [(4, 1, 2)], "name": "zwei",
    },
    {"positions": _RNG.random((3, 3)), "uv": _RNG.random((3, 2)), "triangles": [], "name": "drei"},
]  # fmt: skip


def put(tmp_path: Path, data: bytes) -> Path:
    path = tmp_path / "mesh.serialized"
    path.write_bytes(data)
    return path


@pytest.mark.parametrize("version", [3, 4])
@pytest.mark.parametrize("kind", ["<f4", "<f8"])
def test_all_meshes_of_a_file(tmp_path: Path, version: int, kind: str) -> None:
    path = put(tmp_path, write.serialized(MESHES, version, kind))
    assert serialized.count(path) == 3
    for i, want in enumerate(MESHES):
        mesh = serialized.read(path, i)
        assert mesh.name == (want["name"] if version == 4 else "")
        np.testing.assert_array_equal(mesh.positions, np.float32(want["positions"]))
        np.testing.assert_array_equal(mesh.corners, np.ravel(want["triangles"]))
        assert mesh.sizes is None
        for key in ("normals", "uv", "colors"):
            found = getattr(mesh, key)
            assert (found is not None) == (key in want)
            if found is not None:
                np.testing.assert_array_equal(found, np.float32(want[key]))


def test_a_faceted_mesh_has_no_normals(tmp_path: Path) -> None:
    path = put(tmp_path, write.serialized([MESHES[1] | {"flags": 0x10}]))
    mesh = serialized.read(path)
    assert mesh.normals is None
    assert mesh.uv is not None


def test_the_first_mesh_needs_no_table(tmp_path: Path) -> None:
    data = write.serialized(MESHES[:1])
    path = put(tmp_path, data[:-12])
    assert len(serialized.read(path).positions) == 4
    with pytest.raises(dg.InputError, match="wanted a number of meshes at the end"):
        serialized.read(path, 1)


def _packed(body: bytes, version: int = 4) -> bytes:
    head = struct.pack("<HH", 0x041C, version) + zlib.compress(body, 9)
    return head + struct.pack("<QI", 0, 1)


_COUNTS = struct.pack("<QQ", 3, 1)


@pytest.mark.parametrize(
    ("data", "index", "told"),
    [
        (b"", 0, "not a serialized mesh of Mitsuba: wanted 0x041C, got 0x0000"),
        (b"PLY!", 0, "not a serialized mesh of Mitsuba"),
        (struct.pack("<HHQI", 0x041C, 5, 0, 1), 0, "wanted version 3 or 4, got 5"),
        (write.serialized(MESHES), 3, "shape_index: wanted a mesh of 0 .. 2, got 3"),
        (write.serialized(MESHES), -1, "shape_index: wanted a mesh of 0 .. 2, got -1"),
        (write.serialized(MESHES)[:-4] + b"\xff" * 4, 1,
         "a number of meshes at the end of the file"),
        (write.serialized(MESHES)[:-28] + b"\xff" * 24 + b"\3\0\0\0", 1,
         "wanted meshes before byte"),
        (write.serialized(MESHES)[:-20] + b"\1" + bytes(15) + b"\3\0\0\0", 1,
         "mesh 1: not a serialized mesh"),
        (struct.pack("<HH", 0x041C, 4) + b"nonsense" + struct.pack("<QI", 0, 1), 0,
         "mesh 0: damaged zlib stream"),
        (_packed(b""), 0, "mesh 0: the data end too early: 4 more unpacked bytes"),
        (_packed(bytes(4) + b"name"), 0, "the data end too early: 1 more"),
        (_packed(bytes(4) + b"n" * 5000), 0, "wanted a name of at most 4096 bytes"),
        (_packed(bytes(4) + b"\0" + struct.pack("<QQ", 1 << 40, 1)), 0,
         "wanted at most 2147483647 vertices"),
        (_packed(bytes(4) + b"\0" + struct.pack("<QQ", 1, 1 << 40)), 0,
         "wanted at most 2147483647 triangles"),
        (_packed(bytes(4) + b"\0" + struct.pack("<QQ", 1 << 30, 1)), 0,
         "wanted at most .* bytes of unpacked data"),
        (_packed(bytes(4) + b"\0" + _COUNTS + bytes(35)), 0, "the data end too early: 1 more"),
        (_packed(bytes(4) + b"\0" + _COUNTS + bytes(36) + b"\3\0\0\0" * 3), 0,
         "corner 0: wanted a vertex of 0 .. 2, got 3"),
        (_packed(bytes(4) + b"\0" + _COUNTS + b"\0\0\xc0\x7f" * 9 + bytes(12)), 0,
         "position 0: wanted finite"),
        (_packed(b"\0\x20\0\0\0" + _COUNTS + b"\0" * 7 + b"\x7f" + bytes(64) + bytes(12)), 0,
         "position 0: wanted finite"),
    ],
)  # fmt: skip
def test_lies_are_one_error(tmp_path: Path, data: bytes, index: int, told: str) -> None:
    path = put(tmp_path, data)
    with pytest.raises(dg.InputError, match=told) as caught:
        serialized.read(path, index)
    assert str(caught.value).startswith(str(path))


def test_a_bomb_is_refused_before_memory_is_taken(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Deflated zeros that the header asks for, and that are there."""
    monkeypatch.setattr(file_bytes, "ALWAYS", 1 << 16)
    count = 1 << 20
    body = bytes(4) + b"\0" + struct.pack("<QQ", count, 1) + bytes(12 * count + 12)
    path = put(tmp_path, _packed(body))
    with pytest.raises(dg.InputError, match=r"wanted at most .* bytes of unpacked data"):
        serialized.read(path)
    monkeypatch.setattr(file_bytes, "ALWAYS", 1 << 26)
    assert len(serialized.read(path).positions) == count
