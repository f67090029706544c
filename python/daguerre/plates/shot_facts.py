"""Converts EXIF metadata of a shot to the names and units of OpenEXR.

Tags and units: Exif 3.0 (CIPA DC-008-2023), 4.6.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from daguerre.io.exif import FULL_FRAME_DIAGONAL_MM, rational

#: EXIF's names and ours; the first one present counts.
_NUMBERS = {
    "ExposureTime": "expTime",
    "FNumber": "aperture",
    "FocalLength": "nominalFocalLength",
    "PhotographicSensitivity": "isoSpeed",
    "ISOSpeedRatings": "isoSpeed",
    "SubjectDistance": "focus",
}
_TEXTS = {
    "LensMake": "lensMake",
    "LensModel": "lensModel",
    "Make": "cameraMake",
    "Model": "cameraModel",
    "DateTimeOriginal": "capDate",
}
#: Units of the resolution of the focal plane, mm.
_UNITS_MM = {2: 25.4, 3: 10.0, 4: 1.0, 5: 1e-3}


def shot_facts(tags: Mapping[str, Any], size: tuple[int, int]) -> dict[str, Any]:
    """Returns metadata by OpenEXR's names.

    Args:
        tags: Values by EXIF's names; rationals as numbers or as pairs.
        size: Width and height of the picture as stored in the file, px.

    Returns:
        Values that are present; ``sensorOverallDimensions`` (mm) if the resolution of the focal
        plane or the equivalent focal length determines it.
    """
    facts: dict[str, Any] = {}
    for theirs, ours in _NUMBERS.items():
        value = exif_number(tags.get(theirs))
        if value is not None and value > 0:
            # Fractions may be 32-bit floats: 1/125 s is 0.00800000038.
            above, below = rational(value)
            facts.setdefault(ours, above / below)
    for theirs, ours in _TEXTS.items():
        text = tags.get(theirs)
        if isinstance(text, str) and text.strip("\0 "):
            facts[ours] = text.strip("\0 ")
    sensor = _by_focal_plane(tags, size) or _by_equivalent(tags, facts, size)
    return facts if sensor is None else facts | {"sensorOverallDimensions": sensor}


def exif_number(value: Any) -> float | None:
    """Converts to a finite number: a pair is a rational; of other lists the first one counts."""
    try:
        if isinstance(value, tuple | list):
            value = float(value[0]) / float(value[1]) if len(value) == 2 else value[0]
        number = float(value)
    except (TypeError, ValueError, ZeroDivisionError, IndexError):
        return None
    return number if math.isfinite(number) else None


def _by_focal_plane(tags: Mapping[str, Any], size: tuple[int, int]) -> tuple[float, float] | None:
    """Sensor size, mm, from pixels and their density; reduced pictures keep both tags."""
    unit = _UNITS_MM.get(int(exif_number(tags.get("FocalPlaneResolutionUnit")) or 2))
    across = exif_number(tags.get("FocalPlaneXResolution"))
    down = exif_number(tags.get("FocalPlaneYResolution")) or across
    if unit is None or across is None or down is None or min(across, down) <= 0:
        return None
    columns = exif_number(tags.get("PixelXDimension")) or size[0]
    width_mm = columns / across * unit
    return _plausible((width_mm, width_mm * size[1] / size[0] * across / down))


def _by_equivalent(
    tags: Mapping[str, Any], facts: Mapping[str, Any], size: tuple[int, int]
) -> tuple[float, float] | None:
    """Sensor size, mm, from the equivalent focal length: same diagonal field on 36 x 24 mm."""
    equivalent = exif_number(tags.get("FocalLengthIn35mmFilm"))
    focal = facts.get("nominalFocalLength")
    if not equivalent or equivalent <= 0 or focal is None:
        return None
    diagonal = FULL_FRAME_DIAGONAL_MM * focal / equivalent
    scale = diagonal / math.hypot(*size)
    return _plausible((size[0] * scale, size[1] * scale))


def _plausible(sensor: tuple[float, float]) -> tuple[float, float] | None:
    """Returns a credible sensor size, else None; some files have wrong units."""
    return sensor if all(1 <= side <= 250 for side in sensor) else None
