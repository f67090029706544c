"""Bytes of a picture, from a file or from memory."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from daguerre.files.reading import opened, read_bytes, reading, size_of

#: Size of the largest file of a picture, bytes.
MAX_FILE = 4 << 30


class PictureBytes:
    """A picture before its kind is known.

    Args:
        path: File that holds it.
        data: Bytes of the picture, if it is within another file.
        name: Name that it has there; its suffix decides between kinds without a mark.

    Raises:
        InputError: The file is missing, too large or not a regular file.
    """

    def __init__(
        self, path: Path | None = None, data: bytes | None = None, name: str | None = None
    ) -> None:
        self._path, self._data = path, data
        self.name = name if name is not None or path is None else path.name
        self.size = (
            len(data) if path is None and data is not None else size_of(self._file, MAX_FILE)
        )

    @property
    def _file(self) -> Path:
        assert self._path is not None
        return self._path

    @property
    def suffix(self) -> str:
        """Suffix of the name, in small letters, without its dot."""
        return Path(self.name or "").suffix.lower().removeprefix(".")

    def at(self, offset: int, count: int) -> bytes:
        """Reads bytes; fewer at the end."""
        if self._data is not None:
            return self._data[offset : offset + count]
        with opened(self._file, MAX_FILE) as stream, reading(self._file):
            stream.seek(offset)
            return stream.read(count)

    def all(self) -> bytes:
        """Reads all bytes."""
        return read_bytes(self._file, MAX_FILE) if self._data is None else self._data

    @contextmanager
    def file(self, suffixes: tuple[str, ...]) -> Iterator[str]:
        """Path of a file with these bytes and an allowed suffix.

        A plug-in of OpenImageIO is chosen by the suffix of a name: a file under another one gets a
        link, or a copy where the system makes no links.
        """
        if self._path is not None and self.suffix in suffixes:
            yield str(self._path)
            return
        with tempfile.TemporaryDirectory(prefix="daguerre-") as folder:
            made = Path(folder, f"picture.{suffixes[0]}")
            if self._path is None:
                made.write_bytes(self.all())
            else:
                try:
                    made.symlink_to(self._path.absolute())
                except (OSError, NotImplementedError):
                    made.write_bytes(self.all())
            yield os.fspath(made)
