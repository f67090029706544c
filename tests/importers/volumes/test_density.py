"""Density grids from files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from tests.support.formats import mesh_files, nanovdb_files

_VALUES = np.random.default_rng(5).random((2, 3, 4, 1)).astype(np.float32)


def test_a_grid_of_mitsuba_stands_in_its_box(tmp_path: Path) -> None:
    (tmp_path / "smoke.vol").write_bytes(mesh_files.vol(_VALUES, (-1, -2, -3, 1, 3, 7)))
    grid = dg.DensityGrid.load(tmp_path / "smoke.vol")
    np.testing.assert_array_equal(grid.values, _VALUES[..., 0])
    np.testing.assert_array_equal(grid.transform @ (0, 0, 0, 1), (-1, -2, -3, 1))


def test_grids_of_nanovdb_go_by_name(tmp_path: Path) -> None:
    grids = [(name, nanovdb_files.Writer({(0, 0, 0): value}).bytes(name=name))
             for name, value in (("heat", 2.0), ("density", 3.0))]  # fmt: skip
    path = tmp_path / "smoke.nvdb"
    path.write_bytes(nanovdb_files.segment(grids))
    assert dg.DensityGrid.load(path).values.max() == 2.0
    assert dg.DensityGrid.load(path, "density").values.max() == 3.0
    with pytest.raises(dg.InputError, match=r"wanted a grid 'dens', got 'heat', 'density'"):
        dg.DensityGrid.load(path, "dens")


@pytest.mark.parametrize(
    ("name", "values", "wrong"),
    [
        ("a.vol", np.concatenate([_VALUES] * 3, axis=3), "wanted one number per cell, got 3"),
        ("a.vol", -_VALUES, "numbers must be finite and at least 0"),
        ("a.vdb", _VALUES, r"wanted \.nvdb or \.vol, got \.vdb"),
        ("missing/a.vol", None, "no such file"),
    ],
)
def test_a_wrong_file_is_one_error(
    tmp_path: Path, name: str, values: np.ndarray | None, wrong: str
) -> None:
    path = tmp_path / name
    if values is not None:
        path.write_bytes(mesh_files.vol(values))
    with pytest.raises(dg.InputError, match=wrong) as error:
        dg.DensityGrid.load(path)
    assert str(path) in str(error.value)


def test_a_grid_of_mitsuba_has_no_name(tmp_path: Path) -> None:
    (tmp_path / "a.vol").write_bytes(mesh_files.vol(_VALUES))
    with pytest.raises(dg.UsageError, match="no option 'grid'"):
        dg.DensityGrid.load(tmp_path / "a.vol", "density")
