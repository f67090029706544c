"""Converts EXIF metadata of a shot to the names and units of OpenEXR.

EXIF goes before XMP, which may be older than the file. Values of APEX, logarithms that cameras
round, count where no other is given. Tags and units: Exif 3.0 (CIPA DC-008-2023), 4.6 and annex C.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from daguerre.pictures.exif import FULL_FRAME_DIAGONAL_MM, rational
from daguerre.pictures.shot_blocks import ShotTags

#: EXIF's names and ours.
_NUMBERS = {
    "ExposureTime": "expTime",
    "FNumber": "aperture",
    "FocalLength": "nominalFocalLength",
    "SubjectDistance": "focus",
}
_TEXTS = {
    "LensMake": "lensMake",
    "LensModel": "lensModel",
    "Make": "cameraMake",
    "Model": "cameraModel",
    "DateTimeOriginal": "capDate",
}
#: Kinds of ISO, by the number of SensitivityType; 7: all three.
_SENSITIVITIES = (
    "RecommendedExposureIndex",
    "StandardOutputSensitivity",
    "ISOSpeed",
)
#: PhotographicSensitivity has 16 bits; its largest value stands for all higher ISOs.
_MOST_ISO = 65535
#: Words and units of numbers that are compared.
_COMPARED = {
    "expTime": ("exposure time", " s"),
    "aperture": ("f-number", ""),
    "isoSpeed": ("ISO", ""),
    "nominalFocalLength": ("focal length", " mm"),
}
#: Differences of EXIF and XMP, as a share, and of APEX, EV, that rounding does not explain.
_ROUNDING, _ROUNDING_EV = 0.01, 0.4
#: Units of the resolution of the focal plane, mm.
_UNITS_MM = {2: 25.4, 3: 10.0, 4: 1.0, 5: 1e-3}


def facts_and_notes(shot: ShotTags, size: tuple[int, int]) -> tuple[dict[str, Any], list[str]]:
    """Returns metadata by OpenEXR's names, and notes where values disagree.

    Args:
        shot: Tags of the file.
        size: Width and height of the picture as stored in the file, px.
    """
    notes = list(shot.notes)
    exif, xmp = _plain(shot.exif), _plain(shot.xmp)
    notes += _apex_notes(shot.exif)
    for name, (words, unit) in _COMPARED.items():
        ours, theirs = exif.get(name), xmp.get(name)
        if ours and theirs and abs(theirs / ours - 1) > _rounding(name, shot):
            notes.append(f"{words}: EXIF has {ours:.6g}{unit}, XMP {theirs:.6g}{unit}: took EXIF's")
    turns = (_turn(shot.exif), _turn(shot.xmp))
    if None not in turns and turns[0] != turns[1]:
        notes.append(f"orientation: EXIF has {turns[0]}, XMP {turns[1]}: took EXIF's")
    return _with_sensor(xmp | exif, {**shot.xmp, **shot.exif}, size), notes


def _rounding(name: str, shot: ShotTags) -> float:
    """Share by which values of EXIF and XMP may differ; values of APEX are coarse."""
    direct = [tag for tag, ours in _NUMBERS.items() if ours == name]
    given = all(exif_number(tags.get(tag)) for tags in (shot.exif, shot.xmp) for tag in direct)
    return _ROUNDING if given else 2**_ROUNDING_EV - 1


def orientation(shot: ShotTags) -> int:
    """EXIF's number of the orientation, 1 .. 8; 1 if none is given."""
    return _turn(shot.exif) or _turn(shot.xmp) or 1


def shot_facts(tags: Mapping[str, Any], size: tuple[int, int]) -> dict[str, Any]:
    """Returns metadata by OpenEXR's names.

    Args:
        tags: Values by EXIF's names; rationals as numbers or as pairs.
        size: Width and height of the picture as stored in the file, px.

    Returns:
        Values that are present; ``sensorOverallDimensions`` (mm) if the resolution of the focal
        plane or the equivalent focal length determines it.
    """
    return _with_sensor(_plain(tags), tags, size)


def _with_sensor(
    facts: dict[str, Any], tags: Mapping[str, Any], size: tuple[int, int]
) -> dict[str, Any]:
    """Returns metadata with the size of the sensor, mm, if the tags determine it."""
    sensor = _by_focal_plane(tags, size) or _by_equivalent(tags, facts, size)
    return facts if sensor is None else facts | {"sensorOverallDimensions": sensor}


def _plain(tags: Mapping[str, Any]) -> dict[str, Any]:
    """Numbers and texts that the tags give."""
    facts: dict[str, Any] = {}
    apex = {"expTime": _apex_time(tags), "aperture": _apex_stop(tags), "isoSpeed": _iso(tags)}
    found = {ours: exif_number(tags.get(theirs)) for theirs, ours in _NUMBERS.items()}
    for name in (*found, "isoSpeed"):
        value = found.get(name)
        value = value if value is not None and value > 0 else apex.get(name)
        if value is not None:
            # Fractions may be 32-bit floats: 1/125 s is 0.00800000038.
            above, below = rational(value)
            facts[name] = above / below
    for theirs, ours in _TEXTS.items():
        text = tags.get(theirs)
        if isinstance(text, str) and text.strip("\0 "):
            facts[ours] = text.strip("\0 ")
    return facts


def _apex_time(tags: Mapping[str, Any]) -> float | None:
    """Exposure time by APEX, s; None: not given."""
    value = exif_number(tags.get("ShutterSpeedValue"))
    return None if value is None or abs(value) > 30 else 2.0**-value


def _apex_stop(tags: Mapping[str, Any]) -> float | None:
    """F-number by APEX; None: not given, as 0 stands for a lens that tells nothing."""
    value = exif_number(tags.get("ApertureValue"))
    return None if value is None or not 0 < value <= 20 else 2.0 ** (value / 2)


def _iso(tags: Mapping[str, Any]) -> float | None:
    """ISO; beyond 16 bits it has a tag of its own kind."""
    iso = exif_number(tags.get("PhotographicSensitivity", tags.get("ISOSpeedRatings")))
    if iso is not None and 0 < iso < _MOST_ISO:
        return iso
    others = (exif_number(tags.get(name)) for name in _SENSITIVITIES)
    return next((value for value in others if value and value > 0), iso if iso else None)


def _apex_notes(tags: Mapping[str, Any]) -> list[str]:
    """Notes where a value and its logarithm disagree by more than rounding."""
    notes = []
    time, apex = exif_number(tags.get("ExposureTime")), _apex_time(tags)
    if time and time > 0 and apex and abs(math.log2(time / apex)) > _ROUNDING_EV:
        notes.append(
            f"exposure time: EXIF's ExposureTime is {time:.6g} s, its ShutterSpeedValue "
            f"{apex:.4g} s: took the first"
        )
    stop, apex = exif_number(tags.get("FNumber")), _apex_stop(tags)
    if stop and stop > 0 and apex and 2 * abs(math.log2(stop / apex)) > _ROUNDING_EV:
        notes.append(
            f"f-number: EXIF's FNumber is {stop:.4g}, its ApertureValue f/{apex:.4g}: took the "
            "first"
        )
    return notes


def _turn(tags: Mapping[str, Any]) -> int | None:
    value = exif_number(tags.get("Orientation"))
    return int(value) if value is not None and value in range(1, 9) else None


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
