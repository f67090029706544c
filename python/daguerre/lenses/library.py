"""The lenses that ship with Daguerre, by name."""

from __future__ import annotations

from pathlib import Path

from daguerre.errors import InputError, suggest

from .lens import Lens
from .reader import read

FOLDER = Path(__file__).parent


def names() -> list[str]:
    """Names of the library's lenses, sorted."""
    return sorted(path.stem for path in FOLDER.glob("*.json"))


def load(name_or_path: str | Path, configuration: str | None = None) -> Lens:
    """Loads a lens of the library or from a file.

    Args:
        name_or_path: A name of ``names()``, or a file of the schema ``daguerre-lens/0.1``.
        configuration: Zoom or focus position by name; the first of the file if None.

    Raises:
        InputError: An unknown name (the nearest are suggested), or a file that cannot be used.
    """
    text = str(name_or_path)
    path = Path(text)
    looks_like_file = isinstance(name_or_path, Path) or path.suffix != "" or len(path.parts) > 1
    if text in names():
        return read(FOLDER / f"{text}.json", configuration)
    if path.is_file() or (looks_like_file and path.suffix.lower() in (".json", ".zmx", ".seq")):
        return read(path, configuration)
    raise InputError(
        f"lens {text!r}: no lens of the library and no file has this name{suggest(text, names())}"
    )
