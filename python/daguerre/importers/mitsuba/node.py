"""Objects of a scene file, such as a shape or a material, and their properties.

A property counts as used once it is read; unused properties become notes (``unread``).
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator
from dataclasses import dataclass, field
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from daguerre.files.json_item import short
from daguerre.files.notes import Notes

from .ledger import Entry

Matrix = NDArray[np.float64]
#: Largest number of a file; sizes beyond it would overflow in single precision.
_MOST = 1e30


@dataclass(eq=False)
class Property:
    """A property of an object.

    Attributes:
        name: Name of the property; ``""`` for unnamed nested objects.
        tag: Kind of element: ``float``, ``rgb``, ``transform``, ...; ``object`` for nested objects.
        value: Number, flag, text, tuple of numbers, matrix (4, 4), or ``Node``.
        entry: The element, for messages and accounts.
        parts: Elements inside it, such as the steps of a transform.
    """

    name: str
    tag: str
    value: Any
    entry: Entry
    parts: list[Entry] = field(default_factory=list)

    def take(self) -> Any:
        """Value, which then counts as used; for an object, ``Node.use`` counts."""
        if not (isinstance(self.value, Node) and self.value.entry is self.entry):
            for entry in (self.entry, *self.parts):
                entry.used = True
        return self.value

    def wrong(self, wanted: str) -> NoReturn:
        """Raises ``InputError``: the value is not as wanted."""
        got = short(self.value) if self.tag in _PLAIN else f"<{self.tag}>"
        self.entry.fail(f"wanted {wanted}, got {got}")


_PLAIN = ("float", "integer", "boolean", "string", "point", "vector", "rgb")


@dataclass(eq=False)
class Node:
    """An object: a plugin of a kind, with properties.

    Attributes:
        kind: ``shape``, ``bsdf``, ``emitter``, ...
        plugin: Type of the object, such as ``sphere``.
        entry: The element.
        id: Name for references.
        properties: By name; nested objects without a name have ``""``.
    """

    kind: str
    plugin: str
    entry: Entry
    id: str = ""
    properties: list[Property] = field(default_factory=list)

    def use(self) -> None:
        """Counts the object itself as used."""
        self.entry.used = True

    def fail(self, message: str) -> NoReturn:
        """Raises ``InputError`` at this object."""
        self.entry.fail(message)

    def find(self, name: str) -> Property | None:
        """Property of a name, without using it."""
        return next((item for item in self.properties if item.name == name), None)

    def has(self, name: str) -> bool:
        """Whether there is a property of this name."""
        return self.find(name) is not None

    def skip(self, *names: str) -> None:
        """Counts properties as used that have no effect on a picture here."""
        for item in self.properties:
            if item.name in names and not isinstance(item.value, Node):
                item.take()

    # Values ---------------------------------------------------------------------------------------

    def number(
        self, name: str, default: float, low: float = -math.inf, *, above: float | None = None
    ) -> float:
        """Number of a property.

        Raises:
            InputError: The property is no number, below ``low``, or not ``above`` a bound.
        """
        found = self.find(name)
        if found is None:
            return default
        value = found.take()
        if found.tag not in ("float", "integer"):
            found.wrong("a number")
        if not abs(value) <= _MOST:
            found.wrong("a finite number")
        if above is not None and value <= above:
            found.wrong(f"a number above {above:g}")
        if value < low:
            found.wrong(f"a number of at least {low:g}")
        return float(value)

    def whole(self, name: str, default: int, low: int, high: int) -> int:
        """Whole number of a property, within bounds."""
        value = self.number(name, default)
        found = self.find(name)
        if found is not None and not (value == int(value) and low <= value <= high):
            found.wrong(f"a whole number, {low} .. {high}")
        return int(value)

    def flag(self, name: str, default: bool) -> bool:
        """True or false."""
        found = self.find(name)
        if found is None:
            return default
        if found.tag != "boolean":
            found.wrong("true or false")
        return bool(found.take())

    def text(self, name: str, default: str | None = None) -> str:
        """Text of a property; without a default it is needed."""
        found = self.find(name)
        if found is None:
            if default is None:
                self.fail(f"the property {name!r} is missing")
            return default
        if found.tag != "string":
            found.wrong("a text")
        return str(found.take())

    def choice(self, name: str, default: str, known: Collection[str]) -> str:
        """One of some texts, in lower case."""
        value = self.text(name, default).strip().lower()
        found = self.find(name)
        if found is not None and value not in known:
            found.wrong(f"one of {', '.join(known)}")
        return value

    def vector(self, name: str, default: tuple[float, float, float]) -> NDArray[np.float64]:
        """Point or direction, shape (3,)."""
        found = self.find(name)
        if found is None:
            return np.array(default, np.float64)
        if found.tag not in ("point", "vector"):
            found.wrong("a point or vector")
        return np.array(found.take(), np.float64)

    def transform(self, name: str = "to_world") -> Matrix:
        """Matrix of a property, shape (4, 4); default: the identity."""
        found = self.find(name)
        if found is None:
            return np.eye(4)
        if found.tag != "transform":
            found.wrong("a transform")
        return np.array(found.take(), np.float64)

    # Nested objects -------------------------------------------------------------------------------

    def objects(self, *kinds: str) -> Iterator[tuple[Property, Node]]:
        """Nested objects of some kinds, with the properties that hold them; not yet used."""
        for item in self.properties:
            if isinstance(item.value, Node) and item.value.kind in kinds:
                yield item, item.value

    def nested(self, *kinds: str) -> list[Node]:
        """Nested objects of some kinds, which count as used."""
        found = []
        for item, node in self.objects(*kinds):
            item.take()
            if not node.entry.noted:  # else it was left out
                node.use()
            found.append(node)
        return found

    def nested_one(self, *kinds: str) -> Node | None:
        """The only nested object of some kinds; None: no nested object.

        Raises:
            InputError: There is more than one.
        """
        found = self.nested(*kinds)
        if len(found) > 1:
            found[1].fail(f"wanted one {kinds[0]} in {self.entry.label}, got {len(found)}")
        return found[0] if found else None


def leave_out(node: Node, notes: Notes, sentence: str) -> None:
    """Notes that an object is left out; all that is in it counts as noted."""
    notes.add(sentence)
    _mark(node)
    node.entry.used = False


def _mark(top: Node) -> None:
    waiting, visited = [top], set[int]()
    while waiting:
        node = waiting.pop()
        if id(node) in visited:
            continue
        visited.add(id(node))
        node.entry.noted = True
        for item in node.properties:
            for entry in (item.entry, *item.parts):
                entry.noted, entry.used = True, False
            if isinstance(item.value, Node) and item.entry is item.value.entry:  # no reference
                waiting.append(item.value)


def unread(root: Node, notes: Notes) -> None:
    """Notes unused properties and objects below an object."""
    visited: set[int] = set()
    waiting = [root]
    while waiting:
        node = waiting.pop()
        if id(node) in visited or (node.entry.noted and not node.entry.used):
            continue
        visited.add(id(node))
        for item in reversed(node.properties):
            value = item.value
            if isinstance(value, Node) and value.entry.used:
                if not (item.entry.used or item.entry.noted):
                    notes.add(
                        f"{node.kind} {short(node.plugin)}: a reference to "
                        f"{_named(value)} is not supported"
                    )
                _mark_noted(item)
                waiting.append(value)
            elif isinstance(value, Node) and not value.entry.noted:
                leave_out(value, notes, f"{_named(value)} is unused and left out")
                _mark_noted(item)
            elif isinstance(value, Node):
                _mark_noted(item)
            elif not (item.entry.used or item.entry.noted):
                name = short(item.name)
                notes.add(f"{node.kind} {short(node.plugin)}: {name} is not supported")
                for entry in (item.entry, *item.parts):
                    entry.noted = True


def _mark_noted(item: Property) -> None:
    """Marks an unused reference as noted, so that it is not noted again."""
    item.entry.noted = item.entry.noted or not item.entry.used


def _named(node: Node) -> str:
    article = "an" if node.kind[0] in "aeiou" else "a"
    return f"{article} {node.kind} of type {short(node.plugin)}"
