"""The camera of a photograph: what its file says, what was given, and what the library knows."""

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

#: Facts that no photograph can do without: ours, by parameter, and in words.
_NEEDED = {
    "f_stop": ("aperture", "an f-number"),
    "shutter_time": ("expTime", "an exposure time"),
    "iso": ("isoSpeed", "an ISO"),
}
#: Equivalent focal lengths are whole numbers of mm, so sizes by them are off by as much.
_ROUNDED = 0.03


@dataclass(frozen=True)
class Settings:
    """A camera, its sensor, and how they were found.

    Attributes:
        camera: The camera.
        body: The library's sensor of the camera, or the one that was given.
        focal_length: Focal length that the photograph tells, or that was given, mm.
        notes: Decisions, a sentence each.
    """

    camera: Camera
    body: Sensor | None
    focal_length: float | None
    notes: tuple[str, ...]


def settings_of(photograph: Photograph, given: Mapping[str, Any]) -> Settings:
    """Finds lens, settings and sensor of a photograph.

    Args:
        photograph: The photograph.
        given: Parameters of ``MATCH`` that replace its own; None: not given.

    Raises:
        InputError: Something is not known; the message names all that is missing, with its flags.
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
        raise InputError(f"{where}: EXIF: wanted {words}; got none; {flags} say it")
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
    """The sensor, and the size of the part of it that the photograph spans, upright, mm."""
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
    return sensor, told  # a part of it


def _lens(
    wanted: Mapping[str, Any], facts: Mapping[str, Any], where: str
) -> tuple[str | Lens | None, list[str]]:
    """The lens: as given, else by its name; None: an ideal one."""
    given = wanted.get("lens")
    if not isinstance(given, str | Path | Lens | None):
        raise UsageError(f"{where}: lens: wanted a name, a file or a Lens, got {shown(given)}")
    if given == "pinhole":
        raise UsageError("--lens pinhole: wanted a lens with an opening, as the photo has one")
    if isinstance(given, Path):
        given = str(given)
    if given is not None:
        return (None, []) if isinstance(given, str) and given in IDEAL else (given, [])
    if facts.get("lensModel") in IDEAL:  # a picture of ours
        return None, []
    if facts.get("lensModel") is None:
        return None, ["the file names no lens: taken for an ideal thin lens"]
    name, notes = library_lens(facts, where)
    if name is None:
        notes.append("taken for an ideal thin lens")
    return name, notes


def _with_lens(
    camera: Camera, lens: str | Lens | None, focal: float | None
) -> tuple[Camera, list[str]]:
    """The camera with its lens, whose zoom and stop are those that it can have."""
    if lens is None:
        return camera.with_(focal_length=focal), []
    notes = []
    loaded = lenses.load(lens)
    camera = camera.with_(lens=lens)
    span = loaded.zoom_range_mm
    if span is not None and focal is not None:
        zoom = min(max(focal, span[0]), span[1])
        if abs(zoom - focal) > 0.005 * focal:
            notes.append(f"the lens zooms from {span[0]:.4g} mm to {span[1]:.4g} mm: {zoom:.4g} mm")
        camera = camera.with_(zoom=zoom)
    at = loaded if camera.zoom is None else loaded.at_zoom(camera.zoom)
    widest = at.first_order().f_number
    stop = camera.f_stop or widest
    if stop < widest:
        if math.log2(widest / stop) > 0.5:
            raise InputError(
                f"{loaded.name}: f-stop: wanted f/{widest:.3g} or narrower (the widest of this "
                f"lens), got f/{stop:g}; --lens names another"
            )
        notes.append(f"the lens opens to f/{widest:.3g}, so f/{stop:g} was taken for that")
        camera = camera.with_(f_stop=widest, exposure_f_stop=stop)
    return camera, notes
