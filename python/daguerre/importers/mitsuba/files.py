"""Files that a scene names: searched in its folders, and read only from allowed folders.

Mitsuba looks in the folder of the file that names another, then in the folders of the files that
include it, and in folders of ``<path>`` elements, the last such element first.
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

from daguerre.errors import asked_by
from daguerre.files.reading import MISSING, fault_of, is_folder, is_input, read_bytes
from daguerre.files.text_lines import MAX_BYTES
from daguerre.files.uris import Folder

from .ledger import Entry


class Files:
    """Folders in which names are looked up.

    Args:
        scene: Path of the scene.
        allow_dirs: Further folders from which files may be read.
    """

    def __init__(self, scene: Path, allow_dirs: Iterable[str | os.PathLike[str]] = ()) -> None:
        self._allowed = Folder(scene, allow_dirs).allowed
        self._folders = [self._allowed[0]]

    def within(self, folder: Path) -> Files:
        """Files for a scene file in another folder, which is searched first."""
        made = object.__new__(Files)
        made._allowed, made._folders = self._allowed, [folder, *self._folders]
        return made

    def prepend(self, name: str, entry: Entry) -> None:
        """Adds a folder of a ``<path>``, which is searched first.

        Raises:
            InputError: The folder does not exist, or may not be read.
        """
        for folder in self._folders:
            found = self._real(folder, name, entry)
            if is_folder(found):
                self._check(found, name, entry)
                self._folders.insert(0, found)
                return
        self._check(self._real(self._folders[0], name, entry), name, entry)
        entry.fail(f"{name[:200]!r}: no such folder")

    def need(self, name: str, entry: Entry) -> Path:
        """File of a name.

        Raises:
            InputError: The file does not exist, or may not be read.
        """
        found = self.find(name, entry)
        if found is None:
            entry.fail(f"{name[:200]!r}: {MISSING}")
        return found

    def find(self, name: str, entry: Entry) -> Path | None:
        """File of a name; None: there is no such file.

        Raises:
            InputError: The path may not be read, or is no file.
        """
        for folder in self._folders:
            found = self._real(folder, name, entry)
            if is_input(found):
                self._check(found, name, entry)
                return found
        first = self.first(name, entry)
        fault = fault_of(first)
        if fault != MISSING:
            entry.fail(f"{name[:200]!r}: {fault}")
        return None

    def first(self, name: str, entry: Entry) -> Path:
        """Where a name would be, in the folder that comes first.

        Raises:
            InputError: The file may not be read.
        """
        path = self._real(self._folders[0], name, entry)
        self._check(path, name, entry)
        return path

    def read(self, name: str, entry: Entry, most: int = MAX_BYTES) -> bytes | None:
        """Bytes of the file of a name, at most ``most``; None: there is no such file."""
        found = self.find(name, entry)
        if found is None:
            return None
        with asked_by(entry):
            return read_bytes(found, most)

    def _real(self, folder: Path, name: str, entry: Entry) -> Path:
        plain = name.replace("\\", "/")  # separators, which so cannot hide a way up
        if not plain or "\0" in plain:
            entry.fail(f"wanted the name of a file, got {name[:40]!r}")
        try:
            return Path(os.path.realpath(folder / plain))
        except (OSError, ValueError):
            entry.fail(f"wanted the name of a file, got {name[:40]!r}")

    def _check(self, found: Path, name: str, entry: Entry) -> None:
        if not any(found.is_relative_to(folder) for folder in self._allowed):
            entry.fail(
                f"leaves the scene's folder: wanted a file under {str(self._allowed[0])!r} "
                f"(--allow-dir allows more folders), got {name[:200]!r}"
            )
