"""The stocks that ship with Daguerre, by name."""

from __future__ import annotations

from pathlib import Path

from daguerre.errors import InputError, suggest

from .reader import read
from .stock import Stock

FOLDER = Path(__file__).parent / "library"


def names() -> list[str]:
    """Names of the library's stocks, sorted."""
    return sorted(path.stem for path in FOLDER.glob("*.json"))


def load(name_or_path: str | Path | Stock) -> Stock:
    """A stock of the library or of a file.

    Args:
        name_or_path: A name of ``names()``, or a file of the schema ``daguerre-stock/0.1``; a stock
            is itself.

    Raises:
        InputError: An unknown name (the nearest are suggested), or a file that cannot be used.
    """
    if isinstance(name_or_path, Stock):
        return name_or_path
    text = str(name_or_path)
    path = Path(text)
    if text in names():
        return read(FOLDER / f"{text}.json")
    if path.is_file() or path.suffix.lower() == ".json":
        return read(path)
    raise InputError(
        f"stock {text!r}: no stock of the library and no file has this name{suggest(text, names())}"
    )
