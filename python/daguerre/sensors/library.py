"""Library of sensors that ship with Daguerre, by name."""

from __future__ import annotations

from pathlib import Path

from daguerre.argument_checks import guarded
from daguerre.files.library import find, stems

from .ideal_sensor import NAMES, ideal
from .reader import read
from .sensor import Sensor

FOLDER = Path(__file__).parent / "library"


def names() -> list[str]:
    """Returns the names of the library's sensors, sorted."""
    return sorted([*NAMES, *stems(FOLDER)])


@guarded
def load(name_or_path: str | Path | Sensor) -> Sensor:
    """Loads a sensor of the library or from a file.

    Args:
        name_or_path: A name from ``names()``, or a file of the schema ``daguerre-sensor/0.1``; a
            ``Sensor`` is returned as it is.

    Raises:
        InputError: The name is unknown (the message suggests the nearest), or the file cannot be
            used.
    """
    if isinstance(name_or_path, Sensor):
        return name_or_path
    if str(name_or_path) in NAMES:
        return ideal(str(name_or_path))
    return read(find("sensor", name_or_path, FOLDER, names()))
