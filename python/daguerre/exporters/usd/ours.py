"""Writes settings that UsdGeomCamera lacks as ``daguerre:*``."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np

from daguerre import sensors
from daguerre.camera.ideal import IDEAL
from daguerre.camera.lens_scatter import LensScatter
from daguerre.camera.parameters import CAMERA
from daguerre.checks import short
from daguerre.errors import UsageError
from daguerre.importers.usd.daguerre_attributes import (
    ARRAYS,
    DECENTER,
    LENS,
    PICTURES,
    PLAIN,
    PREFIX,
    SCATTER,
    SENSOR,
    WHITE,
    Plain,
    camel,
)
from daguerre.importers.usd.exposure import SCALE
from daguerre.lenses import Lens
from daguerre.lenses import library as lenses

from .stage import Output

_SCALED = {field for field, _ in SCALE.values()}


def write_ours(output: Output) -> None:
    """Writes parameters that differ from their defaults.

    Raises:
        UsageError: Lens or sensor are neither of the library nor a file beside the stage.
    """
    camera = output.camera
    for row in PLAIN:
        if _is_told(output, row):
            output.follow(PREFIX + row.name, row.type, _value(row), row.field)
    known = (*IDEAL, *lenses.names())
    _write_named(output, LENS, camera.lens, known, lenses.load)
    _write_named(output, SENSOR, camera.sensor, sensors.names(), sensors.load)
    for field, (name, _) in ARRAYS.items():
        output.set(PREFIX + name, "double[]", getattr(camera, field))
    for field, name in PICTURES.items():
        _write_picture(output, PREFIX + name, getattr(camera, field))
    groups = [float(n) for group in camera.decenter for part in group for n in part]
    output.set(PREFIX + DECENTER, "double[]", groups or None)
    if camera.scatter is not None:
        _write_scatter(output, camera.scatter)
    white = camera.white_balance
    output.set(PREFIX + WHITE, "double2" if isinstance(white, tuple) else "double", white)


def _value(row: Plain) -> Any:
    return lambda camera: getattr(camera, row.field)


def _is_told(output: Output, row: Plain) -> bool:
    """Whether an attribute of ours is needed: standard attributes do not give its value."""
    camera = output.camera
    value, default = getattr(camera, row.field), CAMERA[row.field].default
    if row.field == "focus_distance":
        return value is not None and math.isinf(value)
    if row.field == "shutter_time":
        return False
    if row.field == "near_clip":  # other programs need a plane even where nothing is clipped
        return bool(value == 0)
    if row.field == "fps":
        return bool(camera.fps != output.rate)
    if row.field in _SCALED and camera.exposure == "manual":  # as exposure:* has them
        return False
    return row.field in camera.motion or (value is not None and value != default)


def _write_named(
    output: Output, name: str, value: Any, known: Collection[str], load: Callable[[str], Any]
) -> None:
    """Writes a lens or a sensor: a name of the library, or a file in the stage's folder."""
    if value is None:
        output.set(f"{PREFIX}{name}:name", "string", None)
        return
    if not isinstance(value, str | Path):
        value = _found(value, name, load)
    if str(value) in known:
        output.set(f"{PREFIX}{name}:name", "string", str(value))
        return
    path = Path(value).resolve()
    if not path.is_relative_to(output.folder):
        raise UsageError(
            f"camera: {name}: must be in the folder of the stage, {output.folder}, got {path}"
        )
    relative = path.relative_to(output.folder).as_posix()
    output.set(f"{PREFIX}{name}:file", "asset", f"./{relative}")


def _found(value: Lens | sensors.Sensor, name: str, load: Callable[[str], Any]) -> str:
    """Name in the library of a lens or a sensor that is in memory."""
    if isinstance(value, Lens):
        near = [entry.name for entry in lenses.entries() if entry.title == value.name]
    else:
        near = sensors.names()
    found = next((name for name in near if load(name) == value), None)
    if found is None:
        raise UsageError(
            f"camera: {name}: wanted a name of the library or a file, got {short(value.name)} in "
            "memory"
        )
    return found


def _write_picture(output: Output, name: str, pixels: object) -> None:
    if pixels is None:
        return
    grey = np.asarray(pixels, np.float32)
    output.set(name, "float[]", grey.ravel().tolist())
    output.set(name + "Size", "int2", (grey.shape[1], grey.shape[0]))


def _write_scatter(output: Output, scatter: LensScatter) -> None:
    for part in fields(LensScatter):
        kind = "double2" if isinstance(part.default, tuple) else "double"
        output.set(PREFIX + SCATTER + camel(part.name), kind, getattr(scatter, part.name))
