"""Lenses and sensors of cameras that are files, or were read from files.

A packed scene names no file, so it holds their contents, which are read like a stranger's file.
"""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from daguerre.camera.camera import Camera
from daguerre.camera.ideal import IDEAL
from daguerre.checks import short
from daguerre.errors import InputError, UsageError
from daguerre.files.value import same
from daguerre.lenses import Lens, library
from daguerre.lenses import reader as lens_reader
from daguerre.sensors import Sensor, names
from daguerre.sensors import load as load_sensor
from daguerre.sensors import reader as sensor_reader
from daguerre.sensors.writer import members

from .values import printable

#: Most notes of a lens, and most characters of a text.
_MOST_NOTES, _LONGEST = 100, 1000

_Contents = dict[str, Any]


def parted(camera: Camera, where: str) -> tuple[Camera, _Contents | None, _Contents | None]:
    """Parts a camera from a lens and a sensor that the library does not have.

    Returns:
        The camera without them; contents of the lens, and of the sensor, or None.

    Raises:
        InputError: A file cannot be read.
        UsageError: The lens differs from its file.
    """
    lens = sensor = None
    if camera.lens is not None and not _is_one_of(camera.lens, (*IDEAL, *library.names())):
        lens, camera = _of_lens(library.load(camera.lens), where), replace(camera, lens=None)
    if camera.sensor is not None and not _is_one_of(camera.sensor, names()):
        sensor, camera = _of_sensor(load_sensor(camera.sensor)), replace(camera, sensor=None)
    return camera, lens, sensor


def joined(
    camera: Camera, lens: Mapping[str, Any] | None, sensor: Mapping[str, Any] | None, where: str
) -> Camera:
    """Gives a camera the lens and the sensor that :func:`parted` took.

    Raises:
        InputError: Contents of a lens or a sensor cannot be used.
    """
    if lens is not None:
        camera = replace(camera, lens=_lens(lens, where))
    if sensor is not None:
        camera = replace(camera, sensor=_sensor(sensor, where))
    return camera


def _is_one_of(value: object, known: Collection[str]) -> bool:
    return isinstance(value, str) and value in known


def _of_lens(lens: Lens, where: str) -> _Contents:
    """Contents of a lens: its file as JSON, the file's name, and notes on how it was read."""
    text, name = json.dumps(lens.data), Path(lens.source).name
    for configuration in (None, *(one.name for one in lens.configurations)):
        made = lens_reader.read_text(text, name, configuration)
        if same(replace(made, source=lens.source, notes=lens.notes), lens):
            return {
                "text": text,
                "name": name,
                "configuration": configuration,
                "notes": list(lens.notes[:_MOST_NOTES]),
            }
    raise UsageError(
        f"packed scene: {where}: lens: wanted a lens as its file describes it, got {lens.name}, "
        "which was changed afterwards"
    )


def _lens(given: Mapping[str, Any], where: str) -> Lens:
    name, notes, configuration = (given[key] for key in ("name", "notes", "configuration"))
    name = _text(name, f"{where}: lens: name")
    if configuration is not None:
        configuration = _text(configuration, f"{where}: lens: configuration")
    if not isinstance(notes, list) or len(notes) > _MOST_NOTES:
        raise InputError(f"{where}: lens: notes: wanted at most {_MOST_NOTES} texts")
    text = _text(given["text"], f"{where}: lens", lens_reader.MAX_BYTES)
    made = lens_reader.read_text(text, f"{where}: lens {printable(name)}", configuration)
    told = tuple(printable(_text(one, f"{where}: lens: notes")) for one in notes)
    return replace(made, source=printable(name), notes=told)


def _of_sensor(sensor: Sensor) -> _Contents:
    """Contents of a sensor: its file, and the serial number, which files do not have."""
    return {"text": json.dumps(members(sensor)), "serial": sensor.serial}


def _sensor(given: Mapping[str, Any], where: str) -> Sensor:
    text = _text(given["text"], f"{where}: sensor", lens_reader.MAX_BYTES)
    return sensor_reader.read_text(text, f"{where}: sensor").with_(serial=given["serial"])


def _text(value: object, where: str, most: int = _LONGEST) -> str:
    if not isinstance(value, str) or len(value) > most:
        raise InputError(
            f"{where}: wanted a string of at most {most} characters, got {short(value)}"
        )
    return value
