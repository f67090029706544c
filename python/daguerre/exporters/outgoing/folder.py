"""Folder of the files that a written scene refers to.

Files are named by a hash of their content, and the scene file is written after all of them. So an
earlier scene file stays whole at any moment, with its files. Files that the new scene file does not
use are removed after it is written.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from daguerre.errors import OutputError
from daguerre.files.atomic import atomic_path, remove, write_bytes
from daguerre.files.in_use import is_read

_OURS = re.compile(r"[a-z]+-[0-9a-f]{16}\.[a-z]{3}")
_ODD = re.compile(r"[^\w.\- ]")


def plain_name(name: str) -> str:
    """Returns a name without signs that end or escape texts of scene files."""
    return _ODD.sub("_", name)


class OutgoingFolder:
    """Files beside a scene file, in a folder of its name."""

    def __init__(self, scene_path: Path) -> None:
        """Makes the folder, if it is not there.

        Raises:
            OutputError: The folder cannot be made.
        """
        self._scene = scene_path
        suffix = scene_path.suffix.lower().removeprefix(".")
        self.path = scene_path.with_name(f"{plain_name(scene_path.stem)}-{suffix}-files")
        self._names: set[str] = set()
        self._made = False

    def add(self, kind: str, suffix: str, data: bytes) -> str:
        """Writes bytes, equal bytes once; returns the path relative to the scene file."""

        def write(path: Path) -> None:
            path.write_bytes(data)

        return self.write(kind, suffix, hashlib.sha256(data), write)

    def write(
        self, kind: str, suffix: str, content: hashlib._Hash, write: Callable[[Path], None]
    ) -> str:
        """Writes a file, unless a file with this content exists.

        Args:
            kind: First word of its name, such as ``mesh``.
            suffix: Suffix with its dot.
            content: Hash of the content.
            write: Function that writes a temporary file.

        Returns:
            Path relative to the scene file, with slashes.

        Raises:
            OutputError: The file cannot be written.
        """
        self._make()
        name = f"{kind}-{content.hexdigest()[:16]}{suffix}"
        target = self.path / name
        if name not in self._names and not target.is_file():
            with atomic_path(target) as temp:
                write(temp)
        self._names.add(name)
        return f"{self.path.name}/{name}"

    def finish(self, text: str) -> None:
        """Writes the scene file, then removes files of earlier scenes that it does not use."""
        write_bytes(self._scene, text.encode())
        if not self.path.is_dir():
            return
        for found in self.path.iterdir():
            ours = found.name not in self._names and _OURS.fullmatch(found.name)
            if ours and not is_read(found):  # a scene that the command reads may be beside this
                remove(found)
        if not self._names:
            with suppress(OSError):  # it holds something else
                self.path.rmdir()

    def _make(self) -> None:
        if self._made:
            return
        try:
            self.path.mkdir(exist_ok=True)
        except OSError as error:
            raise OutputError(f"{self.path}: cannot write: {error.strerror or error}") from error
        self._made = True
