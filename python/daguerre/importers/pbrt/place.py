"""Places in the text of a scene: file, line, column and directive, for messages."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NoReturn

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import InputError
from daguerre.files.json_item import Item, clean


@dataclass(frozen=True, eq=False)
class SceneFile:
    """A file of a scene.

    Attributes:
        name: Path, for messages.
        data: Bytes of the file.
    """

    name: str
    data: bytes

    @cached_property
    def line_ends(self) -> NDArray[np.int64]:
        """Offsets of the ends of lines, shape (L,), found once: many messages may ask for them."""
        return np.flatnonzero(np.frombuffer(self.data, np.uint8) == ord("\n"))

    def __repr__(self) -> str:
        return f"<Source {self.name}: {len(self.data)} bytes>"


class FilePlace:
    """A place in a file. Line and column are counted only when a message needs them.

    Args:
        source: The file.
        offset: Offset in bytes.
        directive: Directive to which the place belongs; may be empty.
    """

    __slots__ = ("directive", "offset", "source")

    def __init__(self, source: SceneFile, offset: int, directive: str = "") -> None:
        self.source, self.offset, self.directive = source, offset, directive

    def at(self, offset: int) -> FilePlace:
        """Returns another place of the same file and directive."""
        return FilePlace(self.source, offset, self.directive)

    def __str__(self) -> str:
        ends = self.source.line_ends
        line = int(np.searchsorted(ends, self.offset)) + 1
        column = self.offset - (int(ends[line - 2]) if line > 1 else -1)
        directive = f": {clean(self.directive)[:40]}" if self.directive else ""
        return f"{self.source.name}: line {line}, column {column}{directive}"

    def fail(self, message: str) -> NoReturn:
        """Raises ``InputError`` for this place."""
        raise InputError(f"{self}: {message}")

    def item(self, name: str, value: object) -> Item:
        """Returns a value at this place, for checks that name it."""
        return Item(value, name, Item(None, str(self)))
