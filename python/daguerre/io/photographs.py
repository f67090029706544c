"""Photographs as their files have them: numbers, upright, and what EXIF says of the exposure."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import InputError

from .images import _read, _rgb, _upright, checked_suffix, read_environment

LINEAR = (".exr", ".hdr")
CODED = (".jpg", ".jpeg", ".png", ".tif", ".tiff")
#: Names of OpenImageIO, older ones last, and ours: those of OpenEXR where it has one.
_FACTS = {
    "expTime": ("ExposureTime",),
    "aperture": ("FNumber",),
    "isoSpeed": ("Exif:PhotographicSensitivity", "Exif:ISOSpeedRatings"),
    "focal_35mm": ("Exif:FocalLengthIn35mmFilm",),
}


@dataclass(frozen=True)
class Photograph:
    """A photograph as its file has it.

    Attributes:
        numbers: Upright, shape (H, W, 3): uint8 or uint16 as they are coded, float32 linear.
        orientation: EXIF's, 1 to 8, which was applied.
        facts: Numbers of EXIF: expTime (s), aperture, isoSpeed, focal_35mm (mm); known ones alone.
        profile: Name of the colour profile; empty: none.
    """

    numbers: NDArray[Any]
    orientation: int = 1
    facts: dict[str, float] = field(default_factory=dict)
    profile: str = ""


def read_photograph(path: str | os.PathLike[str]) -> Photograph:
    """Reads a JPEG, PNG or TIFF with its EXIF, or linear light of a .hdr or .exr.

    Raises:
        InputError: It is not there, another kind of file, truncated, or holds NaN.
    """
    file = Path(path)
    suffix = file.suffix.lower()
    if suffix not in LINEAR + CODED:
        wanted = ", ".join((*CODED, *LINEAR))
        raise InputError(f"{file}: photograph: wanted {wanted}, got {suffix or 'no suffix'}")
    if suffix in LINEAR:
        return Photograph(read_environment(file))
    if not file.is_file():
        got = "a folder" if file.is_dir() else "no such file"
        raise InputError(f"{file}: wanted a photograph, got {got}")
    if suffix not in (".tif", ".tiff"):
        checked_suffix(file.read_bytes(), str(file))
    pixels, spec, _ = _read(str(file), str(file))
    orientation = int(spec.get_int_attribute("Orientation", 1))
    numbers = np.ascontiguousarray(_upright(_rgb(pixels, spec, file), orientation))
    if numbers.dtype not in (np.uint8, np.uint16):
        numbers = _light(numbers.astype(np.float32), file)
    profile = str(spec.getattribute("ICCProfile:profile_description") or "")
    return Photograph(numbers, orientation, _facts(spec), profile)


def _facts(spec: Any) -> dict[str, float]:
    known: dict[str, float] = {}
    for ours, theirs in _FACTS.items():
        for name in theirs:
            value = spec.getattribute(name)
            if isinstance(value, int | float) and 0 < value < math.inf:
                known.setdefault(ours, float(value))
    return known


def _light(numbers: NDArray[np.float32], file: Path) -> NDArray[np.float32]:
    """Numbers of a picture in float, which are light."""
    bad = int((~(np.isfinite(numbers) & (numbers >= 0))).any(axis=2).sum())
    if bad:
        raise InputError(f"{file}: wanted finite light of at least 0, got {bad} other pixels")
    return numbers
