"""Places in the text of a scene: file, line, column and directive, for messages."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NoReturn

from daguerre.errors import InputError
from daguerre.files.json_item import Item, clean


@dataclass(frozen=True, eq=False)
class Source:
    """A file of a scene.

    Attributes:
        name: Path, for messages.
        data: Its bytes.
    """

    name: str
    data: bytes

    def __repr__(self) -> str:
        return f"<Source {self.name}: {len(self.data)} bytes>"


class Place:
    """A place in a file. Line and column are counted only when a message needs them.

    Args:
        source: The file.
        offset: Offset in bytes.
        directive: Directive to which the place belongs; may be empty.
    """

    __slots__ = ("directive", "offset", "source")

    def __init__(self, source: Source, offset: int, directive: str = "") -> None:
        self.source, self.offset, self.directive = source, offset, directive

    def at(self, offset: int) -> Place:
        """Returns another place of the same file and directive."""
        return Place(self.source, offset, self.directive)

    def __str__(self) -> str:
        before = self.source.data
        line = before.count(b"\n", 0, self.offset) + 1
        column = self.offset - before.rfind(b"\n", 0, self.offset)
        directive = f": {clean(self.directive)[:40]}" if self.directive else ""
        return f"{self.source.name}: line {line}, column {column}{directive}"

    def fail(self, message: str) -> NoReturn:
        """Raises ``InputError`` for this place."""
        raise InputError(f"{self}: {message}")

    def item(self, name: str, value: object) -> Item:
        """Returns a value at this place, for checks that name it."""
        return Item(value, name, Item(None, str(self)))
