"""Library of lenses that ship with Daguerre, by name."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from daguerre.argument_checks import guarded
from daguerre.checks import short
from daguerre.errors import UsageError
from daguerre.files.library import find as file_of

from .formats import SUFFIXES
from .index import FOLDER, PHOTOGRAPHS, Entry, entries, names
from .lens import Lens
from .reader import read
from .search import suggest

__all__ = ["FOLDER", "PHOTOGRAPHS", "Entry", "entries", "load", "names"]


@guarded
def load(name_or_path: str | Path | Lens, configuration: str | None = None) -> Lens:
    """Loads a lens of the library or from a file.

    Args:
        name_or_path: A name from ``names()``, or a lens file (``daguerre-lens/0.1``, Zemax, CODE V,
            Optical Bench or pbrt); a ``Lens`` is returned as it is.
        configuration: Zoom or focus position by name; default: the first in the file.

    Raises:
        InputError: The name is unknown (the message suggests the nearest), or the file cannot be
            used.
        UsageError: A configuration was given with a lens that is already loaded.
    """
    if isinstance(name_or_path, Lens):
        if configuration is not None:
            raise UsageError(
                f"{name_or_path.name}: configuration: wanted None for a loaded lens, "
                f"got {short(configuration)}"
            )
        return name_or_path
    return read(path_of(name_or_path), configuration)


def path_of(name_or_path: str | Path, others: Iterable[str] = ()) -> Path:
    """File of a lens of the library, or the given file.

    Args:
        name_or_path: The same as for ``load``.
        others: Other names that would do, for suggestions.

    Raises:
        InputError: The name is unknown; the message suggests the nearest.
    """

    def near(name: str) -> str:
        return suggest(name, others)

    return file_of("lens", name_or_path, FOLDER, names(), (".json", *SUFFIXES), near)
