"""Reads pictures of an iris opening."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import InputError
from daguerre.files.reading import size_of

from .exr.reader import ExrReader, is_exr, light_names
from .images import read_file


def read_grey(path: Path) -> NDArray[np.float32]:
    """Reads the opening of an iris, shape (H, W): 1 lets light through, 0 stops it.

    Raises:
        InputError: The file cannot be read, or has no opening.
    """
    pixels = _read(path)[:, :, :3]
    grey = np.ascontiguousarray(pixels.mean(axis=2), np.float32)
    if not (np.isfinite(grey).all() and grey.min() >= 0 and grey.max() > 0):
        raise InputError(f"{path}: iris picture: values must be at least 0, and some above 0")
    return grey


def _read(path: Path) -> NDArray[np.float32]:
    """Reads pixels, shape (H, W, C), integers scaled to 0 .. 1."""
    size_of(path)
    if is_exr(path):
        return _of_exr(path)
    return np.asarray(read_file(path, floats=True), np.float32)


def _of_exr(path: Path) -> NDArray[np.float32]:
    with ExrReader(path) as reader:
        names = light_names(list(reader.channels), str(path))
        planes = reader.rows(0, reader.height, names)
    return np.stack([planes[name] for name in names], axis=2, dtype=np.float32)
