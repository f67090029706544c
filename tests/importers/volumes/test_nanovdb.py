"""NanoVDB: cells and blocks in dense grids, transforms, segments, packing, lies."""

from __future__ import annotations

import re
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.importers.volumes import nanovdb
from daguerre.importers.volumes.grid import FileGrid
from tests.support.formats.nanovdb_files import (
    GRID,
    LOWER,
    ROOT,
    TILE,
    TREE,
    UPPER,
    Writer,
    segment,
)

#: Cells in leaves of several nodes, on both sides of 0.
CELLS = {(0, 0, 0): 1.0, (1, 2, 3): 2.0, (7, 7, 7): 3.0, (8, 7, 7): 4.0, (130, 20, 5): 5.0,
         (-1, -9, -3): 6.0, (-1, 0, 0): 7.0}  # fmt: skip


def put(tmp_path: Path, data: bytes) -> Path:
    path = tmp_path / "smoke.nvdb"
    path.write_bytes(data)
    return path


def value(grid: FileGrid, world: Any) -> float:
    """Value of the cell at a place, which must be a centre of one."""
    unit = np.linalg.solve(grid.transform, [*world, 1.0])[:3]
    z, y, x, _ = grid.values.shape
    cell = unit * (x, y, z) - 0.5
    index = np.round(cell).astype(int)
    np.testing.assert_allclose(cell, index, atol=1e-9)
    return float(grid.values[index[2], index[1], index[0], 0])


def test_cells_stand_where_the_file_has_them(tmp_path: Path) -> None:
    grid = nanovdb.read(put(tmp_path, segment([("density", Writer(CELLS).bytes())])))
    for cell, want in CELLS.items():
        assert value(grid, cell) == want
    assert np.count_nonzero(grid.values) == len(CELLS)
    # The box of active cells, and a layer of background around it.
    assert grid.values.shape == (7 + 3 + 1 + 2, 20 + 9 + 1 + 2, 130 + 1 + 1 + 2, 1)
    assert grid.name == "density"


def test_blocks_and_background(tmp_path: Path) -> None:
    blocks = {((16, 8, 0), 8): 2.5, ((128, 0, 0), 128): 1.5}
    made = Writer({(0, 0, 0): 1.0}, blocks, background=0.25)
    grid = nanovdb.read(put(tmp_path, made.bytes()))
    assert value(grid, (0, 0, 0)) == 1.0
    assert value(grid, (1, 0, 0)) == 0.25
    assert [value(grid, (x, 8, 0)) for x in (15, 16, 23, 24)] == [0.25, 2.5, 2.5, 0.25]
    assert [value(grid, (x, 127, 127)) for x in (127, 128, 255, 256)] == [0.25, 1.5, 1.5, 0.25]
    assert int((grid.values == 2.5).sum()) == 8**3
    assert int((grid.values == 1.5).sum()) == 128**3


def test_the_transform_of_the_file(tmp_path: Path) -> None:
    """Index (x, y, z) lies at M (x, y, z) + t; M has rows."""
    matrix = (0.5, 0.1, 0, 0, 0.25, 0, 0, 0.2, 2)
    data = Writer({(1, 2, 3): 2.0}).bytes(matrix, (10, 20, 30))
    grid = nanovdb.read(put(tmp_path, data))
    assert value(grid, (10 + 0.5 + 0.2, 20 + 0.5, 30 + 0.4 + 6)) == 2.0


@pytest.mark.parametrize("codec", [0, 1])
def test_grids_by_name_in_several_segments(tmp_path: Path, codec: int) -> None:
    one, two, three = (Writer({(0, 0, 0): v}).bytes(name=f"n{v:.0f}") for v in (1.0, 2.0, 3.0))
    data = segment([("n1", one), ("n2", two)], codec) + segment([("n3", three)])
    path = put(tmp_path, data)
    assert value(nanovdb.read(path), (0, 0, 0)) == 1.0
    for i in (1, 2, 3):
        assert value(nanovdb.read(path, f"n{i}"), (0, 0, 0)) == i
    with pytest.raises(dg.InputError, match=r"wanted a grid 'n4', got 'n1', 'n2', 'n3' .did you"):
        nanovdb.read(path, "n4")


def test_a_grid_without_active_cells_is_background(tmp_path: Path) -> None:
    grid = nanovdb.read(put(tmp_path, Writer({}, background=0.5).bytes()))
    assert (grid.values == 0.5).all()


def _blosced(grid: bytes, packed: bytes) -> bytes:
    """A file with a grid that Blosc packed."""
    head = segment([("density", grid)], 2)[: 16 + 176 + 8]
    size = struct.pack("<Q", len(packed))
    return head[:24] + struct.pack("<Q", 8 + len(packed)) + head[32:] + size + packed


def test_grids_packed_by_blosc(tmp_path: Path) -> None:
    blosc = pytest.importorskip("blosc")
    data = Writer(CELLS).bytes()
    packed = blosc.compress(data, typesize=4, cname="lz4")
    assert value(nanovdb.read(put(tmp_path, _blosced(data, packed))), (1, 2, 3)) == 2.0
    for lie, told in (
        (packed[:4] + b"\xff" * 4 + packed[8:], "bytes packed by BLOSC, got 4294967295"),
        (packed[:16] + b"\xff" * (len(packed) - 16), "wanted data packed by BLOSC, got"),
        (packed[:12], "bytes packed by BLOSC, got 0"),
    ):
        with pytest.raises(dg.InputError, match=told):
            nanovdb.read(put(tmp_path, _blosced(data, lie)))


def test_a_missing_blosc_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(nanovdb.extras, "missing", lambda name: name == "blosc")
    path = put(tmp_path, segment([("density", Writer(CELLS).bytes())], 2))
    hint = re.escape(nanovdb.extras.hint("blosc"))
    told = rf"compressed by BLOSC: needs the package blosc, .*{hint}.* nanovdb_convert"
    with pytest.raises(dg.InputError, match=told):
        nanovdb.read(path)


_GOOD = Writer({(0, 0, 0): 1.0, (9, 0, 0): 2.0}).bytes()
_ROOT = GRID + TREE
_UPPER = _ROOT + ROOT + TILE
_LOWER = _UPPER + UPPER
_LEAF = _LOWER + LOWER


def _with(at: int, form: str, *values: Any) -> bytes:
    data = bytearray(_GOOD)
    struct.pack_into(form, data, at, *values)
    return bytes(data)


@pytest.mark.parametrize(
    ("data", "told"),
    [
        (b"", "wanted a grid '', got none"),
        (b"NanoVDB2", "byte 0: wanted a segment of NanoVDB, got b'NanoVDB2'"),
        (b"OpenVDB0" + bytes(100), "byte 0: wanted a segment of NanoVDB, got b'OpenVDB0'"),
        (b"NanoVDB1" + bytes(100), "wanted 736 bytes at 0, got 108 in all"),
        (segment([("a", _GOOD)])[:100], "truncated: the header of a grid at byte 16"),
        (segment([("a", _GOOD)])[:193], "truncated: the name of a grid at byte 192"),
        (segment([("a", _GOOD)])[:-1], "grid 'a': wanted .* bytes, got"),
        (segment([("a", _GOOD)], 7), "wanted plain, ZIP or BLOSC data"),
        (segment([("a", _GOOD)], 1)[:-9] + b"nonsense!",
         "grid 'a': damaged zlib stream|more unpacked bytes"),
        (segment([("a", b"x" * 800)], 0), "wanted a grid of NanoVDB, got b'xxxxxxxx'"),
        (_with(16, "<I", 28 << 21), "wanted a grid of NanoVDB 32, got version 28"),
        (_with(636, "<I", 15), "wanted a grid of single-precision numbers .type 1., got type 15"),
        (_with(632, "<I", 1), "got a level set"),
        (_with(GRID + 24, "<q", -100000), "wanted 64 bytes at"),
        (_with(GRID + 24, "<q", 1 << 60), "wanted 64 bytes at"),
        (_with(_ROOT + 24, "<I", 1 << 31), "wanted 68719476736 bytes at"),
        (_with(_ROOT + ROOT + 8, "<q", 1 << 62), "wanted 270400 bytes at"),
        (_with(_UPPER + 8256, "<q", -(1 << 62)), "wanted 33856 bytes at"),
        (_with(_LOWER + 1088, "<q", 1 << 62), "leaves are outside of the grid"),
        (_with(_LEAF + 96, "<f", float("nan")), "numbers must be finite"),
        (_with(384, "<d", float("inf")), "numbers of the transform must be finite"),
        (_with(_UPPER + 32 + 4096, "<4096B", *[255] * 4096), "a node appears twice"),
        (
            _with(_LOWER + 32 + 512, "<512B", *[255] * 512),
            "a node appears twice|leaves are outside",
        ),
        (Writer({}, {((0, 0, 0), 4096): 1.0}).bytes(), "wanted at most 16777216 cells"),
        (Writer({(0, 0, 0): 1.0, (9000, 9000, 9000): 1.0}).bytes(), "9003 x 9003 x 9003"),
    ],
)  # fmt: skip
def test_lies_are_one_error(tmp_path: Path, data: bytes, told: str) -> None:
    path = put(tmp_path, data)
    with pytest.raises(dg.InputError, match=told) as caught:
        nanovdb.read(path)
    assert str(caught.value).startswith(str(path))
