"""Reads raw files of cameras, and Daguerre's DNG, with LibRaw, as channels for development."""

from __future__ import annotations

import logging
import math
import os
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.color import illuminants
from daguerre.errors import InputError
from daguerre.files import extras

from . import libraw
from .channels import USUAL, XY, Channels, Demosaic
from .libraw import RawFile

#: Largest exposure by which a DNG may be brightened or darkened, EV.
MOST_STOPS = 32
FloatArray = NDArray[np.float64]
Matrix = Callable[[XY], FloatArray]
#: Correlated colour temperatures of EXIF's light sources, K (DNG 1.7.1, CalibrationIlluminant1).
_ILLUMINANTS = {
    3: 2850.0, 17: 2856.0, 24: 3200.0, 23: 5003.0, 20: 5503.0, 1: 5500.0, 21: 6504.0, 22: 7504.0,
}  # fmt: skip
#: EXIF's names in tifffile, and the names of metadata.
_FACTS = {
    "ExposureTime": "expTime",
    "FNumber": "aperture",
    "FocalLength": "nominalFocalLength",
    "ISOSpeedRatings": "isoSpeed",
    "LensModel": "lensModel",
    "LensMake": "lensMake",
    "SubjectDistance": "focus",
    "DateTimeOriginal": "capDate",
}


def read_shot(path: str | os.PathLike[str], demosaic: Demosaic = USUAL) -> Channels:
    """Reads a camera's raw file and demosaics it; colours are the camera's.

    Args:
        path: Path of a DNG or another file that LibRaw reads.
        demosaic: Demosaicing; for X-Trans below 516 px LibRaw has only the fast method.

    Raises:
        InputError: The file is not a raw file, or the colours of its camera are unknown.
    """
    tags = tags_of(path)
    file = libraw.read(path, "picture", demosaic)
    libraw.check_colors(file, path)
    matrix = _grey if file.colors == 1 else _camera_from_xyz(path, file, tags)
    if file.pixels is None:
        raise InputError(f"{path}: cannot read: the helper process sent no picture")
    white = demosaic.scale(libraw.balance_of(file, path), 1.0)
    three = np.broadcast_to(file.pixels, (*file.pixels.shape[:2], 3))
    return Channels(
        pixels=np.ascontiguousarray(three),
        unit=white / 2.0 ** _baseline(path, tags),
        full=np.minimum(white, 65535.0),
        xyz_from=lambda white: np.asarray(np.linalg.inv(matrix(white)), np.float64),
        as_shot=white_of_shot(path, file, tags),
        metadata=_facts(tags),
    )


def white_of_shot(path: object, file: RawFile, tags: Mapping[str, Any]) -> XY:
    """Returns the white balance of a raw file, without developing it.

    Args:
        path: Name of the file, for messages.
        file: The file as LibRaw reads it.
        tags: Tags from ``tags_of``.
    """
    if file.colors == 1:
        return illuminants.D65_XY
    return _white(libraw.neutral_of(file, path), _camera_from_xyz(path, file, tags))


def _grey(white: XY) -> FloatArray:
    return np.asarray(np.diag(1 / illuminants.xyz_of_xy(white)))


def _camera_from_xyz(path: object, file: RawFile, tags: Mapping[str, Any]) -> Matrix:
    """Interpolates a DNG's two matrices by reciprocal temperature; else LibRaw's for daylight."""
    known = [
        (_ILLUMINANTS.get(int(_number(tags.get(f"CalibrationIlluminant{k}"), 21)), 6504.0), table)
        for k in (1, 2)
        if (table := _matrix(tags.get(f"ColorMatrix{k}"))) is not None
    ]
    if not known:
        daylight = file.xyz_matrix
        if not daylight.any() or daylight.shape != (3, 3):
            raise InputError(f"{path}: ColorMatrix1: wanted the camera's colour matrix, got none")
        known = [(6504.0, daylight)]
    (first, one), (last, other) = known[0], known[-1]

    def matrix(white: XY) -> FloatArray:
        if first == last:
            return _scaled(one)
        at = 1 / max(illuminants.kelvin_of(white), 1000.0)
        part = np.clip((at - 1 / first) / (1 / last - 1 / first), 0, 1)
        return _scaled((1 - part) * one + part * other)

    return matrix


def _scaled(matrix: FloatArray) -> FloatArray:
    """Scales a matrix so that daylight of Y = 1 is 1 in the strongest channel."""
    return np.asarray(matrix / (matrix @ illuminants.xyz_of_xy(illuminants.D65_XY)).max())


def _white(neutral: FloatArray, matrix: Matrix) -> XY:
    """Finds the light in which white has the neutral's values; iterates as DNG 1.7.1, chapter 6."""
    white = illuminants.D65_XY
    for _ in range(8):
        xyz = np.linalg.solve(matrix(white), neutral)
        white = (float(xyz[0] / xyz.sum()), float(xyz[1] / xyz.sum()))
        if not (0.05 < white[0] < 0.8 and 0.05 < white[1] < 0.8):
            return illuminants.D65_XY
    return white


def _matrix(value: object) -> FloatArray | None:
    """Matrix of 9 rationals; None: absent or singular."""
    if not isinstance(value, tuple | list) or len(value) != 18:
        return None
    with np.errstate(all="ignore"):
        pairs = np.reshape(np.asarray(value, np.float64), (9, 2))
        table = (pairs[:, 0] / pairs[:, 1]).reshape(3, 3)
    usable = np.isfinite(table).all() and np.linalg.cond(table) < 1e4
    return table if usable else None


def tags_of(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Returns TIFF tags of the first directory and of the EXIF directory; empty if not a TIFF.

    Raises:
        UsageError: The package that reads them is not installed.
    """
    extras.need("tifffile", f"{path}: a raw file")
    import tifffile

    log = logging.getLogger("tifffile")  # LibRaw reports a bad file, once
    level = log.level
    log.setLevel(logging.CRITICAL + 1)
    try:
        with tifffile.TiffFile(path) as file:
            first: Any = file.pages[0]
            found = {tag.name: tag.value for tag in first.tags}
            return found | dict(found.get("ExifTag") or {})
    except Exception:  # broken files raise any kind of exception
        return {}
    finally:
        log.setLevel(level)


def _baseline(path: object, tags: Mapping[str, Any]) -> float:
    """Exposure by which a DNG is brightened, EV."""
    stops = _number(tags.get("BaselineExposure"), 0.0)
    if not abs(stops) <= MOST_STOPS:
        raise InputError(
            f"{path}: BaselineExposure: wanted -{MOST_STOPS} to {MOST_STOPS}, got {stops}"
        )
    return stops


def _facts(tags: Mapping[str, Any]) -> dict[str, Any]:
    facts: dict[str, Any] = {}
    for theirs, ours in _FACTS.items():
        value = tags.get(theirs)
        if isinstance(value, str):
            facts[ours] = value
        elif value is not None and (number := _number(value, 0.0)) > 0:
            facts[ours] = number
    for theirs, ours in (("Make", "cameraMake"), ("Model", "cameraModel")):
        if isinstance(tags.get(theirs), str):
            facts[ours] = tags[theirs]
    return facts


def _number(value: Any, default: float) -> float:
    """Reads a number, or a rational as a pair; of a longer tuple the first number."""
    try:
        if isinstance(value, tuple | list):
            value = float(value[0]) / float(value[1]) if len(value) == 2 else value[0]
        number = float(value)
        return number if math.isfinite(number) else default
    except (TypeError, ValueError, ZeroDivisionError, IndexError):
        return default
