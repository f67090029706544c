"""Accounts of the elements of a file: each is used, or a note names it.

Mitsuba refuses properties that no plugin asks for. Here they are noted, so that the elements that
are used and those that are noted are all elements of a file.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NoReturn

from daguerre.errors import InputError


@dataclass(eq=False)
class Entry:
    """An element of a file.

    Attributes:
        file: Path of the file, for messages.
        line: Line on which it begins.
        column: Column in which it begins.
        label: The element for messages, such as ``<float name="fov">``.
        used: Whether the element had an effect on the scene.
        noted: Whether a note names it, or something around it.
    """

    file: str
    line: int
    column: int
    label: str
    used: bool = False
    noted: bool = False

    def __str__(self) -> str:
        return f"{self.file}: line {self.line}, column {self.column}: {self.label}"

    def fail(self, message: str) -> NoReturn:
        """Raises ``InputError`` at this element."""
        raise InputError(f"{self}: {message}")

    def about(self, file: str) -> Entry:
        """The same element in messages about a file that it asks for."""
        return Entry(self.file, self.line, self.column, f"{self.label}: {file[:200]}")


@dataclass
class Ledger:
    """All elements of a scene, including elements of included files."""

    entries: list[Entry] = field(default_factory=list)

    def add(self, file: str, place: tuple[int, int], label: str) -> Entry:
        """Adds an element that begins on a line, in a column."""
        entry = Entry(file, *place, label)
        self.entries.append(entry)
        return entry

    def counts(self) -> tuple[int, int, int]:
        """Numbers of elements that are used, noted, and neither."""
        used = sum(entry.used for entry in self.entries)
        noted = sum(entry.noted and not entry.used for entry in self.entries)
        return used, noted, len(self.entries) - used - noted
