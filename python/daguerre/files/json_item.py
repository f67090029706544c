"""JSON values with their place, so that every error names file and JSON path."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator
from typing import Any, NoReturn

from daguerre.errors import InputError

#: Largest number; values are converted to single precision.
MAX_NUMBER = 3.4e38

#: Characters of a name that messages repeat whole.
MAX_NAME = 200


def short(value: object, limit: int = 60) -> str:
    """``repr`` of something from a file, at most ``limit`` characters long."""
    if isinstance(value, dict):
        return "an object"
    if isinstance(value, list) and len(value) > 16:
        return f"a list of {len(value)}"
    if isinstance(value, (str, bytes)) and len(value) > limit:
        return repr(value[: limit - 20]) + f"... ({len(value)} long)"
    text = repr(value)
    return text if len(text) <= limit + 20 else text[:limit] + "..."


def clean(name: str) -> str:
    """Makes a name printable: valid UTF-8 without control characters."""
    return "".join(c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in name)[:200]


def _named(key: str, limit: int = 60) -> str:
    """Formats a key of an untrusted file for a message."""
    short_key = key if len(key) <= limit else f"{key[: limit - 20]}... ({len(key)} long)"
    return clean(short_key)


class Item:
    """A JSON value with its place; getters check type and range and raise ``InputError``.

    The path is built only for errors, as a scene may have a million nodes.
    """

    __slots__ = ("key", "parent", "value")

    def __init__(self, value: Any, key: str | int, parent: Item | None = None) -> None:
        self.value = value
        self.key = key
        self.parent = parent

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickles the value with its place, but without the rest of its file."""
        place: list[str | int] = []
        item: Item | None = self
        while item is not None:
            place.append(item.key)
            item = item.parent
        return _at_place, (self.value, tuple(reversed(place)))

    def holding(self, value: object) -> Item:
        """Returns another value at the same place."""
        return Item(value, self.key, self.parent)

    @property
    def path(self) -> str:
        """JSON path, such as ``meshes[2].primitives[0].attributes.POSITION``."""
        keys: list[str] = []
        item: Item = self
        while item.parent is not None:
            keys.append(f"[{item.key}]" if isinstance(item.key, int) else f".{_named(item.key)}")
            item = item.parent
        return "".join(reversed(keys)).lstrip(".")

    @property
    def file(self) -> str:
        """File that this value comes from."""
        item: Item = self
        while item.parent is not None:
            item = item.parent
        return str(item.key)

    @property
    def where(self) -> str:
        """File and path, for messages."""
        path = self.path
        return f"{self.file}: {path}" if path else self.file

    def fail(self, message: str) -> NoReturn:
        """Raises ``InputError`` for this value."""
        raise InputError(f"{self.where}: {message}")

    def _type(self, wanted: str) -> NoReturn:
        self.fail(f"wrong type: wanted {wanted}, got {short(self.value)}")

    def get(self, key: str) -> Item | None:
        """Returns the member of this name, or None; the value must be an object."""
        if not isinstance(self.value, dict):
            self._type("an object")
        return Item(self.value[key], key, self) if key in self.value else None

    def need(self, key: str) -> Item:
        """Returns the member of this name, which must exist."""
        member = self.get(key)
        if member is None:
            Item(None, key, self).fail("missing")
        return member

    def members(self) -> list[Item]:
        """Returns all members of an object."""
        if not isinstance(self.value, dict):
            self._type("an object")
        return [Item(value, key, self) for key, value in self.value.items()]

    def __iter__(self) -> Iterator[Item]:
        if not isinstance(self.value, list):
            self._type("a list")
        return (Item(value, i, self) for i, value in enumerate(self.value))

    def list_of(self, key: str) -> list[Item]:
        """Returns the elements of a member that is a list; empty if it is absent."""
        member = self.get(key)
        return [] if member is None else list(member)

    def number(
        self, low: float = -math.inf, high: float = math.inf, *, above: float | None = None
    ) -> float:
        """Returns a finite number in [low, high] and, if given, greater than ``above``."""
        if isinstance(self.value, bool) or not isinstance(self.value, (int, float)):
            self._type("a number")
        try:
            number = float(self.value)
        except OverflowError:
            number = math.inf
        if not abs(number) <= MAX_NUMBER:  # nor is NaN
            wanted = f"a finite number below {MAX_NUMBER:.3g}"
            self.fail(f"not finite: wanted {wanted}, got {short(self.value)}")
        if above is not None and number <= above:
            self.fail(f"out of range: wanted a number above {above:g}, got {number:g}")
        if not low <= number <= high:
            bounds = f"{low:g} .. {high:g}" if math.isfinite(high) else f"at least {low:g}"
            self.fail(f"out of range: wanted {bounds}, got {number:g}")
        return number

    def integer(self, low: int = 0, high: int | None = None) -> int:
        """Returns an integer in [low, high]; 3.0 is valid, as JSON has one type of number."""
        if isinstance(self.value, bool) or not isinstance(self.value, (int, float)):
            self._type("an integer")
        if isinstance(self.value, float) and not self.value.is_integer():
            self._type("an integer")
        number = int(self.value)
        if number < low or (high is not None and number > high):
            bounds = f"at least {low}" if high is None else f"{low} .. {high}"
            self.fail(f"out of range: wanted {bounds}, got {short(number)}")
        return number

    def index(self, count: int, of: str) -> int:
        """Returns an index into a list of the file with ``count`` elements."""
        if count == 0 and isinstance(self.value, int) and not isinstance(self.value, bool):
            self.fail(f"index out of range: there are no {of}, got {self.value}")
        number = self.integer(-(2**63))
        if not 0 <= number < count:
            self.fail(f"index out of range: wanted 0 .. {count - 1} ({of}), got {short(number)}")
        return number

    def numbers(
        self, count: int, low: float = -math.inf, high: float = math.inf
    ) -> tuple[float, ...]:
        """Returns a list of exactly ``count`` finite numbers in [low, high]."""
        if not isinstance(self.value, list):
            self._type(f"a list of {count} numbers")
        if len(self.value) != count:
            self.fail(f"wrong length: wanted {count} numbers, got {len(self.value)}")
        return tuple(element.number(low, high) for element in self)

    def text(self, most: int | None = None) -> str:
        """Returns a string, of at most ``most`` characters."""
        if not isinstance(self.value, str):
            self._type("a string")
        if most is not None and len(self.value) > most:
            self.fail(f"too long: wanted at most {most} characters, got {len(self.value)}")
        return str(self.value)

    def flag(self) -> bool:
        """Returns true or false."""
        if not isinstance(self.value, bool):
            self._type("true or false")
        return bool(self.value)

    def choice(self, options: Collection[Any]) -> Any:
        """Returns one of the given values."""
        if isinstance(self.value, bool) or not isinstance(self.value, (str, int)):
            self._type("one of " + ", ".join(map(repr, options)))
        if self.value not in options:
            wanted = ", ".join(map(repr, options))
            self.fail(f"unknown value: wanted one of {wanted}, got {short(self.value)}")
        return self.value

    # Optional members with a default ------------------------------------------------------------

    def number_of(
        self,
        key: str,
        default: float,
        low: float = -math.inf,
        high: float = math.inf,
        *,
        above: float | None = None,
    ) -> float:
        """Returns a member that is a number, or the default."""
        member = self.get(key)
        return default if member is None else member.number(low, high, above=above)

    def numbers_of(
        self,
        key: str,
        default: tuple[float, ...],
        low: float = -math.inf,
        high: float = math.inf,
    ) -> tuple[float, ...]:
        """Returns a member that is a list of the default's length, or the default."""
        member = self.get(key)
        return default if member is None else member.numbers(len(default), low, high)

    def name(self) -> str:
        """Returns the member ``name``, cleaned for printing; empty if absent."""
        member = self.get("name")
        return "" if member is None else clean(member.text())

    def extension(self, name: str) -> Item | None:
        """Returns the object of an extension, or None."""
        extensions = self.get("extensions")
        return None if extensions is None else extensions.get(name)


def _at_place(value: object, place: tuple[str | int, ...]) -> Item:
    """Restores a pickled value; only the keys of its parents are known."""
    parent: Item | None = None
    for key in place[:-1]:
        parent = Item(None, key, parent)
    return Item(value, place[-1], parent)
