"""Files of a scene: the texts that it includes, and the meshes, pictures and lenses that it names.

All names are relative to the folder of the first file, and none leaves it.
"""

from __future__ import annotations

import codecs
import os
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from daguerre.errors import InputError, asked_by
from daguerre.files.in_use import note_read
from daguerre.files.includes import Includes
from daguerre.files.json_item import Item
from daguerre.files.uris import Folder
from daguerre.importers.file_bytes import read_bytes

from .lexer import Lexer
from .place import FilePlace, SceneFile

#: Limits of the bytes of all texts, and of nested files; ``Includes`` limits their number.
MAX_BYTES = 4 << 30
MAX_DEPTH = 32
_UTF_16 = (b"\xff\xfe", b"\xfe\xff")


class Files:
    """Opens the files of a scene.

    Args:
        path: First file.
        included: Called with the place of every directive that includes a file.
        allow_dirs: Further folders from which files may be read.
    """

    def __init__(
        self,
        path: Path,
        included: Callable[[FilePlace], None],
        allow_dirs: Iterable[str | os.PathLike[str]] = (),
    ) -> None:
        self._included = included
        self._folder = Folder(path, allow_dirs)
        self._open: list[Path] = []
        self._bytes = MAX_BYTES
        self._includes = Includes()

    def first(self, path: Path) -> Lexer:
        """Opens the first file.

        Raises:
            InputError: The file cannot be read.
        """
        self._open.append(Path(os.path.realpath(path)))
        return Lexer(self._source(path), self)

    @contextmanager
    def imported(self, name: str, place: FilePlace) -> Iterator[Lexer]:
        """Opens a file in a new lexer, for ``Import``.

        Raises:
            InputError: See ``enter``.
        """
        yield Lexer(self.enter(name, place), self)
        self.leave()

    def enter(self, name: str, place: FilePlace) -> SceneFile:
        """Opens a file within the files that are open.

        Raises:
            InputError: The file is outside of the scene's folder, is missing, includes itself, or
                there are too many files.
        """
        path = self._folder.resolve(place.item("name", name))
        if path in self._open:
            place.fail(f"includes form a cycle: {path.name} includes itself")
        if len(self._open) >= MAX_DEPTH:
            place.fail(f"too many nested files: the limit is {MAX_DEPTH}")
        self._open.append(path)
        self._included(place)
        with asked_by(place):
            source = self._source(path)
        self._includes.count(path, len(source.data), place)
        return source

    def leave(self) -> None:
        """Closes the innermost open file."""
        self._open.pop()

    def find(self, name: str, place: FilePlace, what: str) -> Path | None:
        """Returns the file of a name; None: no such file.

        Args:
            name: Name in the scene.
            place: Directive that names it.
            what: Parameter with the name.

        Raises:
            InputError: The name leaves the scene's folder, or is no name of a file.
        """
        item = place.item(what, name)
        return None if self._path(item) is None else self._folder.resolve(item)

    def picture(self, place: str, name: str) -> Path:
        """Returns the file of a picture's name, which need not exist.

        Raises:
            InputError: The name leaves the scene's folder, or is no name of a file.
        """
        item = Item(name, "filename", Item(None, place))
        missing = self._path(item) is None
        return self._folder.base / name if missing else self._folder.resolve(item)

    def _path(self, item: Item) -> Path | None:
        """Path of a name; None: no file within the folders."""
        name = item.text().replace("\\", "/")
        try:
            path = Path(os.path.realpath(self._folder.base / name))
            inside = any(path.is_relative_to(folder) for folder in self._folder.allowed)
            if not (name and inside) or path.exists():
                return path
            note_read([path])  # it may come
            return None
        except (OSError, ValueError):  # no name of a file
            return self._folder.base

    def _source(self, path: Path) -> SceneFile:
        data = read_bytes(path, max(self._bytes, 0)).tobytes()
        self._bytes -= len(data)
        if data[:2] in _UTF_16:
            raise InputError(f"{path}: wanted text in UTF-8, got UTF-16")
        return SceneFile(str(path), data.removeprefix(codecs.BOM_UTF8))
