"""Settings of a photograph's camera, from its file, the user's parameters and the library."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from daguerre import lenses, sensors
from daguerre.camera.camera import Camera
from daguerre.camera.ideal import IDEAL
from daguerre.checks import shown
from daguerre.errors import InputError, UsageError
from daguerre.lenses import Lens
from daguerre.plates.photograph import Photograph
from daguerre.sensors import Sensor

from .body import library_sensor
from .lens_name import library_lens
from .parameters import MATCH

#: Required facts by parameter: the name in the metadata, and in words.
_NEEDED = {
    "f_stop": ("aperture", "an f-number"),
    "shutter_time": ("expTime", "an exposure time"),
    "iso": ("isoSpeed", "an ISO"),
}
#: Relative error of sizes from equivalent focal lengths, which are whole numbers of mm.
_ROUNDED = 0.03


@dataclass(frozen=True)
class Settings:
    """A camera, its sensor, and notes on how they were found.

    Attributes:
        camera: Camera of the photograph.
        body: Sensor of the library for the camera, or the given sensor.
        focal_length: Focal length, given or from the metadata, mm.
        notes: Assumptions, a sentence each.
    """

    camera: Camera
    body: Sensor | None
    focal_length: float | None
    notes: tuple[str, ...]


def settings_of(photograph: Photograph, given: Mapping[str, Any]) -> Settings:
    """Finds lens, settings and sensor of a photograph.

    Args:
        photograph: Photograph to match.
        given: Parameters of ``MATCH`` that replace the metadata; None: not given.

    Raises:
        InputError: A value is unknown; the message lists all missing values and their flags.
    """
    facts, where = photograph.facts, str(photograph.path)
    wanted = {name: value for name, value in given.items() if value is not None}
    sensor, size = _sensor(wanted.get("sensor"), facts, photograph)
    lens, notes = _lens(wanted, facts, where)
    values = {name: wanted.get(name, facts.get(own)) for name, (own, _) in _NEEDED.items()}
    focal = wanted.get("focal_length", facts.get("nominalFocalLength"))
    missing = [(name, words) for name, (_, words) in _NEEDED.items() if values[name] is None]
    if focal is None and lens is None:
        missing.insert(0, ("focal_length", "a focal length"))
    if size is None:
        missing.append(("sensor", "the size of the sensor"))
    if missing:
        words = ", ".join(words for _, words in missing)
        flags = ", ".join(MATCH[name].flag for name, _ in missing)
        raise InputError(f"{where}: EXIF: wanted {words}, got none; give {flags}")
    camera = Camera().with_(
        **values,
        focus_distance=wanted.get("focus_distance", facts.get("focus")),
        sensor_size=size,
        white_balance=wanted.get("white_balance"),
    )
    camera, more = _with_lens(camera, lens, focal)
    return Settings(camera, sensor, focal, (*notes, *more))


def _sensor(
    given: Any, facts: Mapping[str, Any], photograph: Photograph
) -> tuple[Sensor | None, tuple[float, float] | None]:
    """Returns the sensor, and the size of the part that the photograph spans, upright, mm."""
    columns, rows = photograph.size
    if isinstance(given, tuple | list):
        width, height = (float(side) for side in given)
        turned = (width > height) != (columns > rows) and columns != rows and width != height
        return library_sensor(facts), (height, width) if turned else (width, height)
    sensor = library_sensor(facts) if given is None else sensors.load(given)
    if sensor is None:
        return None, facts.get("sensorOverallDimensions")
    told = facts.get("sensorOverallDimensions")
    if given is None and photograph.kind == "linear" and told is not None:
        return sensor, told
    long, short = max(sensor.size), min(sensor.size)
    whole = (long, short) if columns >= rows else (short, long)
    near = told is None or abs(told[0] / whole[0] - 1) < _ROUNDED
    if given is not None or near:
        return sensor, whole
    return sensor, told  # a crop of the sensor


def _lens(
    wanted: Mapping[str, Any], facts: Mapping[str, Any], where: str
) -> tuple[str | Lens | None, list[str]]:
    """Returns the given lens, else the one named in the metadata; None: an ideal lens."""
    given = wanted.get("lens")
    if not isinstance(given, str | Path | Lens | None):
        raise UsageError(f"{where}: lens: wanted a name, a file or a Lens, got {shown(given)}")
    if given == "pinhole":
        raise UsageError("--lens: wanted a lens with an aperture, as photos have one, got pinhole")
    if isinstance(given, Path):
        given = str(given)
    if given is not None:
        return (None, []) if isinstance(given, str) and given in IDEAL else (given, [])
    if facts.get("lensModel") in IDEAL:  # a picture made by Daguerre
        return None, []
    if facts.get("lensModel") is None:
        return None, ["lens: the file names none; an ideal thin lens is used"]
    name, notes = library_lens(facts, where)
    if name is None:
        notes.append("lens: an ideal thin lens is used")
    return name, notes


def _with_lens(
    camera: Camera, lens: str | Lens | None, focal: float | None
) -> tuple[Camera, list[str]]:
    """Returns the camera with its lens; zoom and f-stop are limited to the lens's range."""
    if lens is None:
        return camera.with_(focal_length=focal), []
    notes = []
    loaded = lenses.load(lens)
    camera = camera.with_(lens=lens)
    span = loaded.zoom_range_mm
    if span is not None and focal is not None:
        zoom = min(max(focal, span[0]), span[1])
        if abs(zoom - focal) > 0.005 * focal:
            notes.append(
                f"zoom: the lens's range is {span[0]:.4g} mm to {span[1]:.4g} mm, so "
                f"{zoom:.4g} mm is used"
            )
        camera = camera.with_(zoom=zoom)
    at = loaded if camera.zoom is None else loaded.at_zoom(camera.zoom)
    widest = at.first_order().f_number
    stop = camera.f_stop or widest
    if stop < widest:
        if math.log2(widest / stop) > 0.5:
            raise InputError(
                f"{loaded.name}: f-stop: wanted f/{widest:.3g} or narrower (the widest of this "
                f"lens), got f/{stop:g}; set another lens with --lens"
            )
        notes.append(
            f"f-stop: the library's lens opens to f/{widest:.3g}, which is used for f/{stop:g}"
        )
        camera = camera.with_(f_stop=widest, exposure_f_stop=stop)
    return camera, notes
