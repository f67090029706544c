"""Libraries that ship with Daguerre: folders of files, loaded by name."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection
from pathlib import Path

from daguerre.checks import short
from daguerre.errors import InputError, suggest


def stems(folder: Path) -> list[str]:
    """Names of the JSON files of a folder, sorted."""
    return sorted(path.stem for path in folder.glob("*.json"))


def find(
    kind: str,
    name_or_path: str | Path,
    folder: Path,
    names: Collection[str],
    suffixes: Collection[str] = (".json",),
    near: Callable[[str], str] | None = None,
) -> Path:
    """Returns the file of a library name, or the given file itself.

    Args:
        kind: Kind of object in the library, for messages: sensor, stock, lens.
        name_or_path: One of ``names``, or a file.
        folder: Folder of the library.
        names: Names of the library.
        suffixes: Suffixes, in lower case, that mark a file even if no such file exists.
        near: Makes the suggestion of a message; default: the names with the nearest spelling.

    Raises:
        InputError: Unknown name; the message suggests the nearest.
    """
    text, path = str(name_or_path), Path(name_or_path)
    if text in names:
        return folder / f"{text}.json"
    if os.path.isfile(path) or path.suffix.lower() in suffixes:  # noqa: PTH113 - no error
        return path
    hint = near(text) if near else suggest(text, names, few=True)
    raise InputError(
        f"{kind} {short(text)}: no {kind} of the library and no file has this name{hint}"
    )
