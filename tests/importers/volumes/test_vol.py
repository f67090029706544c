"""Mitsuba's grids: order of cells, types, box, lies."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from daguerre.importers.volumes import vol
from tests.support.formats import mesh_files as write

_VALUES = np.random.default_rng(5).random((2, 3, 4, 3)).astype(np.float32)


def put(tmp_path: Path, data: bytes) -> Path:
    path = tmp_path / "smoke.vol"
    path.write_bytes(data)
    return path


@pytest.mark.parametrize(("kind", "error"), [(1, 0.0), (2, 1e-3)])
def test_values_and_box(tmp_path: Path, kind: int, error: float) -> None:
    grid = vol.read(put(tmp_path, write.vol(_VALUES, (-1, -2, -3, 1, 3, 7), kind)))
    np.testing.assert_allclose(grid.values, _VALUES, atol=error)
    np.testing.assert_array_equal(grid.transform @ (0, 0, 0, 1), (-1, -2, -3, 1))
    np.testing.assert_array_equal(grid.transform @ (1, 1, 1, 1), (1, 3, 7, 1))
    assert "4 x 3 x 2 cells, 3 channels" in repr(grid)


def test_bytes_are_shares_of_255(tmp_path: Path) -> None:
    grid = vol.read(put(tmp_path, write.vol(np.array([[[[0], [51], [255]]]]), kind=3)))
    np.testing.assert_allclose(grid.values.reshape(-1), [0, 0.2, 1], rtol=1e-6)


_HEAD = b"VOL" + struct.pack("<B5i6f", 3, 1, 2, 1, 1, 1, 0, 0, 0, 1, 1, 1)


@pytest.mark.parametrize(
    ("data", "told"),
    [
        (b"", "not a grid of Mitsuba: wanted VOL, got b''"),
        (b"VOL\3", "not a grid of Mitsuba"),
        (b"LOV" + _HEAD[3:], "got b'LOV'"),
        (b"VOL\2" + _HEAD[4:], "wanted version 3, got 2"),
        (_HEAD[:4] + b"\4" + _HEAD[5:] + bytes(8), "wanted values of type 1 .single., .* got 4"),
        (_HEAD[:8] + bytes(4) + _HEAD[12:] + bytes(8), "wanted at least 1 cell .* got 0 x 1 x 1"),
        (_HEAD[:8] + b"\xff" * 4 + _HEAD[12:] + bytes(8), "got -1 x 1 x 1"),
        (_HEAD[:20] + b"\xff\xff\0\0" + _HEAD[24:] + bytes(8), "1 .. 64 channels"),
        (_HEAD[:8] + b"\0\x10\0\0" * 3 + _HEAD[20:], "wanted at most 536870912 values"),
        (_HEAD + bytes(7), "wanted 8 bytes of values for 2 x 1 x 1 cells, got 7"),
        (_HEAD + b"\0\0\xc0\x7f" * 2, "numbers must be finite"),
        (_HEAD[:-4] + b"\0\0\x80\x7f" + bytes(8), "numbers must be finite"),
    ],
)
def test_lies_are_one_error(tmp_path: Path, data: bytes, told: str) -> None:
    path = put(tmp_path, data)
    with pytest.raises(dg.InputError, match=told) as caught:
        vol.read(path)
    assert str(caught.value).startswith(str(path))
