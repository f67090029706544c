"""Density grids of media, from files."""

from __future__ import annotations

import os

from daguerre.errors import InputError
from daguerre.scene.media import DensityGrid

from . import nanovdb, vol
from .grid import FileGrid


def of_nanovdb(path: str | os.PathLike[str], grid: str = "") -> DensityGrid:
    """Reads a grid of a NanoVDB file.

    Args:
        path: The file.
        grid: Name of the grid. Default: the first grid.

    Raises:
        InputError: The file cannot be read, has no such grid, or its numbers are no densities.
    """
    return _density(path, nanovdb.read(path, grid))


def of_vol(path: str | os.PathLike[str]) -> DensityGrid:
    """Reads a grid of Mitsuba.

    Raises:
        InputError: The file cannot be read, or its numbers are no densities.
    """
    return _density(path, vol.read(path))


def _density(path: str | os.PathLike[str], grid: FileGrid) -> DensityGrid:
    channels = grid.values.shape[3]
    if channels != 1:
        raise InputError(f"{path}: wanted one number per cell, got {channels}")
    try:
        return DensityGrid(grid.values[..., 0], grid.transform)
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
