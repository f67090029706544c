"""Library of film stocks that ship with Daguerre, by name."""

from __future__ import annotations

from pathlib import Path

from daguerre.argument_checks import guarded
from daguerre.files.library import find, stems

from .reader import read
from .stock import Stock

FOLDER = Path(__file__).parent / "library"


def names() -> list[str]:
    """Returns the names of the library's stocks, sorted."""
    return stems(FOLDER)


@guarded
def load(name_or_path: str | Path | Stock) -> Stock:
    """Loads a film stock of the library or from a file.

    Args:
        name_or_path: A name from ``names()``, or a file of the schema ``daguerre-stock/0.1``; a
            ``Stock`` is returned as it is.

    Raises:
        InputError: The name is unknown (the message suggests the nearest), or the file cannot be
            used.
    """
    if isinstance(name_or_path, Stock):
        return name_or_path
    return read(find("stock", name_or_path, FOLDER, names()))
