"""Reads Mitsuba's grids: ``.vol`` files, version 3.

Source: the documentation of Mitsuba 3's ``gridvolume`` and of Mitsuba 0.6's, which has more types.
"""

from __future__ import annotations

import math
import os
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from daguerre.checks import freeze_in_place
from daguerre.errors import InputError
from daguerre.importers.file_bytes import read_bytes

from .grid import MAX_VALUES, FileGrid

Array = NDArray[np.float64]
_HEAD = np.dtype(
    [("magic", "S3"), ("version", "u1"), ("type", "<i4"), ("size", "<i4", 3), ("channels", "<i4"),
     ("box", "<f4", (2, 3))]
)  # fmt: skip
#: Type of a value, and its factor.
_TYPES = {1: ("<f4", 1.0), 2: ("<f2", 1.0), 3: ("u1", 1 / 255)}
_MOST_CHANNELS = 64


def read(path: str | os.PathLike[str]) -> FileGrid:
    """Reads a grid.

    The transform is from the box in the file, which Mitsuba uses only on request
    (``use_grid_bbox``); else the grid fills the unit cube.

    Raises:
        InputError: The file is not a grid of Mitsuba, or its numbers do not fit together.
    """
    file = Path(path)
    data = read_bytes(file)
    if len(data) < _HEAD.itemsize or data[:3].tobytes() != b"VOL":
        raise InputError(f"{file}: not a grid of Mitsuba: wanted VOL, got {data[:3].tobytes()!r}")
    head = data[: _HEAD.itemsize].view(_HEAD)[0]
    if head["version"] != 3:
        raise InputError(f"{file}: wanted version 3, got {head['version']}")
    if int(head["type"]) not in _TYPES:
        raise InputError(
            f"{file}: wanted values of type 1 (single), 2 (half) or 3 (bytes), got {head['type']}"
        )
    kind, factor = _TYPES[int(head["type"])]
    x, y, z = (int(n) for n in head["size"])
    channels = int(head["channels"])
    if min(x, y, z) < 1 or not 1 <= channels <= _MOST_CHANNELS:
        raise InputError(
            f"{file}: wanted at least 1 cell along each axis and 1 .. {_MOST_CHANNELS} channels, "
            f"got {x} x {y} x {z} and {channels}"
        )
    count = math.prod((x, y, z, channels))
    wanted = count * np.dtype(kind).itemsize
    if count > MAX_VALUES:
        raise InputError(f"{file}: wanted at most {MAX_VALUES} values, got {count}")
    if len(data) - _HEAD.itemsize < wanted:
        raise InputError(
            f"{file}: wanted {wanted} bytes of values for {x} x {y} x {z} cells, "
            f"got {len(data) - _HEAD.itemsize}"
        )
    raw = np.frombuffer(data, kind, count, _HEAD.itemsize).reshape(z, y, x, channels)
    with np.errstate(invalid="ignore"):
        values = raw.astype(np.float32) * np.float32(factor)
    if not (np.isfinite(values).all() and np.isfinite(head["box"]).all()):
        raise InputError(f"{file}: numbers must be finite")
    return FileGrid(freeze_in_place(values), _of_box(*head["box"].astype(np.float64)))


def _of_box(low: Array, high: Array) -> Array:
    """Transform from the unit cube to a box."""
    transform = np.diag([*(high - low), 1.0])
    transform[:3, 3] = low
    return transform
