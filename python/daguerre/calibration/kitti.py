"""KITTI's texts of calibrations: of odometry and objects (``P0`` ..), and ``calib_cam_to_cam``.

``P0`` to ``P3`` and ``P_rect_00`` to ``P_rect_03`` project points of the first rectified camera, so
their last column places each camera. ``K``, ``D``, ``R``, ``T`` of ``calib_cam_to_cam`` are those
of OpenCV for the raw pictures; ``R`` and ``T`` take points of the first camera to another's frame.

Source: the development kits of KITTI's data sets (raw data, odometry, object).
"""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Any

import numpy as np

from daguerre.errors import InputError
from daguerre.files.json_item import Item
from daguerre.files.reading import document, is_file, opened
from daguerre.files.source import Source

from .calibration import FLIP, Calibration, FloatArray, projection
from .source import agreed, camera_matrix, matrix, read_bytes, row

_ROW = re.compile(r"(\w+):\s*(.*)")
_PROJECTION = re.compile(rb"^P(?:_rect_0)?[0-3]: *[-+.\d]", re.MULTILINE)
_START = 1 << 16


def is_kitti(source: object) -> bool:
    """Whether a source is such a text."""
    if not isinstance(source, str | os.PathLike):
        return False
    path = Path(source)
    if path.suffix.lower() != ".txt" or not is_file(path):
        return False
    with opened(path) as file:
        return _PROJECTION.search(file.read(_START)) is not None


def read_kitti(
    source: Source, *, size: tuple[int, int] | None = None, rectified: bool = False
) -> dict[str, Calibration]:
    """Reads all cameras: P0, P1, ... or 00, 01, ...

    Args:
        source: The file.
        size: Width and height of the pictures, px, where the file does not have them.
        rectified: Whether to read the rectified pictures of ``calib_cam_to_cam``; pictures of other
            files are always rectified.

    Raises:
        InputError: The file cannot be used; the message has the place in it.
    """
    root = _rows(source)
    numbers = [n for n in range(100) if root.get(f"K_{n:02}") is not None]
    if not numbers:
        names = [f"P{n}" for n in range(100) if root.get(f"P{n}") is not None]
        pixels = agreed(root, "S_rect", None, size) if names else (0, 0)
        found = {name: _rectified(root.need(name), pixels, name) for name in names}
    else:
        found = {}
        for n in numbers:
            told = row(root.need(f"S_rect_{n:02}" if rectified else f"S_{n:02}"), (2,))
            pixels = agreed(root, "S", (round(told[0]), round(told[1])), size)
            name = f"{n:02}"
            if rectified:
                found[name] = _rectified(root.need(f"P_rect_{name}"), pixels, name)
            else:
                found[name] = _raw(root, name, pixels)
    if not found:
        root.fail("missing: P0, P1, ... or K_00, K_01, ...")
    return found


def _rows(source: Source) -> Item:
    """Numbers of each row by its name."""
    if isinstance(source, dict):
        return Item(source, "calibration")
    path = Path(source)
    found: dict[str, Any] = {}
    for number, line in enumerate(document(read_bytes(path), str(path)).splitlines(), 1):
        match = _ROW.fullmatch(line.strip())
        if match is None:
            continue
        if match[1] in found:
            raise InputError(f"{path}: line {number}: {match[1]} appears twice")
        try:
            found[match[1]] = [float(word) for word in match[2].split()]
        except ValueError:
            found[match[1]] = match[2]
    return Item(found, str(path))


def _rectified(item: Item, size: tuple[int, int], name: str) -> Calibration:
    """Camera of a P = K [1 | t]; it stands at -t in the frame of the first."""
    p = matrix(item, 3, 4)
    focal, principal = camera_matrix(item.holding(p[:, :3].tolist()))
    stands = np.eye(4)
    stands[:3, 3] = -np.linalg.solve(p[:, :3], p[:, 3])
    where = f"{item.file}: {name}"
    made = projection(where, "rectilinear", size, focal, principal, ())
    return Calibration(made, name, _ours(stands))


def _raw(root: Item, name: str, size: tuple[int, int]) -> Calibration:
    focal, principal = camera_matrix(root.need(f"K_{name}"))
    values = row(root.need(f"D_{name}"), (5,))
    camera_from_first = np.eye(4)
    camera_from_first[:3, :3] = matrix(root.need(f"R_{name}"), 3, 3)
    camera_from_first[:3, 3] = row(root.need(f"T_{name}"), (3,))
    where = f"{root.file}: camera {name}"
    made = projection(where, "opencv", size, focal, principal, values)
    return Calibration(made, name, _ours(np.asarray(np.linalg.inv(camera_from_first), np.float64)))


def _ours(stands: FloatArray) -> FloatArray:
    return np.asarray(FLIP @ stands @ FLIP, np.float64)
