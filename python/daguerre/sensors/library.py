"""The sensors that ship with Daguerre, by name."""

from __future__ import annotations

from pathlib import Path

from daguerre.errors import InputError, suggest

from .ideal import NAMES, ideal
from .reader import read
from .sensor import Sensor

FOLDER = Path(__file__).parent / "library"


def names() -> list[str]:
    """Names of the library's sensors, sorted."""
    return sorted([*NAMES, *(path.stem for path in FOLDER.glob("*.json"))])


def load(name_or_path: str | Path | Sensor) -> Sensor:
    """A sensor of the library or of a file.

    Args:
        name_or_path: A name of ``names()``, or a file of the schema ``daguerre-sensor/0.1``; a
            sensor is itself.

    Raises:
        InputError: An unknown name (the nearest are suggested), or a file that cannot be used.
    """
    if isinstance(name_or_path, Sensor):
        return name_or_path
    text = str(name_or_path)
    path = Path(text)
    if text in NAMES:
        return ideal(text)
    if text in names():
        return read(FOLDER / f"{text}.json")
    if path.is_file() or path.suffix.lower() == ".json":
        return read(path)
    raise InputError(
        f"sensor {text!r}: no sensor of the library and no file has this name"
        f"{suggest(text, names())}"
    )
