# SPDX-License-Identifier: GPL-3.0-or-later
"""Command line of a picture: the flags that make its camera and settings."""

import math
import shlex
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from daguerre.camera.camera import Camera
from daguerre.camera.parameters import CAMERA_FLAGS, SHUTTER
from daguerre.camera.rolling_shutter import RollingShutter
from daguerre.errors import DaguerreError, UsageError
from daguerre.parameters.parameter import Parameter
from daguerre.rendering.parameters import TABLE
from daguerre.rendering.settings import RenderSettings
from daguerre.units import edges_text

#: The library's sensor gives the size, so the size must not be given, too.
_BY_SENSOR = "sensor_size"


def command(
    scene: Path,
    name: str,
    camera: Camera,
    settings: RenderSettings,
    held: Camera | None = None,
    *,
    denoises: bool = False,
) -> str:
    """Command line that renders a camera of a scene file into an .exr beside it.

    Args:
        scene: The scene file.
        name: Name of the camera in it.
        camera: The camera.
        settings: Render settings.
        held: Camera that the file holds; default: one without parameters of Daguerre.
        denoises: Whether the picture is denoised.

    Raises:
        UsageError: A value has no text that its flag understands.
    """
    words = [*_camera(camera, Camera() if held is None else held), *_settings(settings)]
    words += ["--denoise"] if denoises else []
    seen = name.replace(",", "\\,")  # as commas stand between names
    output = str(scene.with_suffix(".exr"))
    return shlex.join(["daguerre", "render", str(scene), f"--camera={seen}", *words, "-o", output])


def _settings(settings: RenderSettings) -> Iterator[str]:
    width, height = settings.film.resolution
    yield f"--res={width}x{height}"
    yield from _given(settings.values(), RenderSettings().values(), TABLE.values())


def _camera(camera: Camera, held: Camera) -> Iterator[str]:
    """Words of the values in which a camera is another one than that of the file."""
    new = {name: getattr(camera, name) for name in ("lens", "sensor")}
    new = {name: value for name, value in new.items() if not _same(value, getattr(held, name))}
    values, plain = dict(vars(camera)), dict(vars(held.with_(**new) if new else held))
    plain |= {name: getattr(held, name) for name in new}
    if camera.sensor is not None:
        values.pop(_BY_SENSOR)
    elif camera.sensor_size != plain[_BY_SENSOR]:
        values["sensor"] = values.pop(_BY_SENSOR)
    yield from _given(values, plain, [*CAMERA_FLAGS, *SHUTTER])


def _given(
    values: dict[str, Any], plain: dict[str, Any], rows: Iterable[Parameter]
) -> Iterator[str]:
    """Words of the values that are not the defaults."""
    for row in rows:
        if not row.flags or row.name not in values:
            continue
        value = values[row.name]
        if value is None or _same(value, plain[row.name]):
            continue
        if row.kind == "flag":
            names = row.flags[0].split("/")
            yield names[0] if value else names[-1]
        else:
            yield f"{row.flag}={_text(row, value)}"


def _same(one: Any, other: Any) -> bool:
    return type(one) is type(other) and bool(one == other)


def _text(row: Parameter, value: Any) -> str:
    """First text of a value that its flag reads back to the bit; a name is its own text."""
    if isinstance(value, str):
        return value
    for text in _texts(row, value):
        try:
            if _read(row, text) == value:
                return text
        except (DaguerreError, ValueError):
            continue
    raise UsageError(f"{row.flag}: wanted a value that a flag can hold, got {value!r}")


def _read(row: Parameter, text: str) -> Any:
    """Value of a text, as the command line reads it."""
    if row.parser is None and row.kind in ("whole", "number", "flag", "choice"):
        return row.read(text, row.flag, UsageError)
    return row.from_text(text)


def _texts(row: Parameter, value: Any) -> Iterator[str]:
    """Texts that may mean a value: with the unit, without, and in parts."""
    if isinstance(value, RollingShutter):
        time, line = value.readout_time, value.line_time
        yield (
            f"{value.scan_order},{time!r}s"
            if line is None
            else f"{value.scan_order},{line!r}s/line"
        )
    elif row.name == "crop":
        yield edges_text(value)
    elif isinstance(value, tuple | list):
        yield from (mark.join(map(_number, value)) for mark in ("x", ","))
    else:
        yield from (_number(value) + row.unit, _number(value))


def _number(value: Any) -> str:
    if isinstance(value, float):
        return "inf" if math.isinf(value) else repr(value)
    return str(value)
