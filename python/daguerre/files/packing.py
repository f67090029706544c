"""Packing: scenes, cameras and settings as JSON and plain arrays, for another machine or a file.

Unlike a pickle, a packed value can name no code: a reader makes values of Daguerre's own classes
and nothing else. Parts that are shared stay shared, so that a scene is as small as in memory.
Attributes of values are not checked; a reader of bytes from strangers passes a function (``make``)
that makes values and checks them.

Large arrays travel apart from it, under their hash: scenes of a sequence share most of them. A
packed value is two lines of JSON, and the bytes of its small arrays, each filled up to a multiple
of 8::

    {"version": ..., "large": [hash, ...]}
    {"root": ..., "parts": [...], "arrays": [[dtype, shape, hash or null], ...]}

``parts`` are lists, dictionaries and objects, which refer to each other by number.
"""

from __future__ import annotations

import dataclasses
import hashlib
import importlib
import json
import math
import re
from collections import OrderedDict
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path, PurePath
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre._core import __version__
from daguerre.errors import DaguerreError, InputError, MismatchError, UsageError
from daguerre.files.json_item import Item, short
from daguerre.files.value import Value

_OURS = "daguerre."
#: A type of numbers, as ``numpy.dtype.str`` writes it. NumPy also evaluates other texts.
_TYPE = re.compile(r"[<>|][biufc]\d{1,2}")
#: Size from which an array travels apart, bytes.
LARGE = 1 << 16
#: Arrays begin at multiples of this, bytes.
_ALIGNED = 8
#: Makes a value from the name of its class and its attributes.
Make = Callable[[str, dict[str, Any]], Any]


@dataclass(frozen=True)
class Packed:
    """A packed value.

    Attributes:
        data: Text of the value, and small arrays.
        large: Large arrays by hash.
    """

    data: bytes
    large: dict[str, NDArray[Any]]


def hash_of(data: Any) -> str:
    """Name under which bytes or an array are kept: SHA-256."""
    return hashlib.sha256(data).hexdigest()


def pack(
    value: object, name: Callable[[NDArray[Any]], str] = hash_of, *, large: float = LARGE
) -> Packed:
    """Packs a value.

    Args:
        value: The value.
        name: Hash of an array in C order; :func:`hash_of`, possibly cached.
        large: Size from which an array travels apart, bytes; ``math.inf``: no array does.

    Raises:
        UsageError: The value has a part that is neither plain nor of Daguerre, such as a function.
    """
    writer = _Writer(name, large)
    root = writer.of(value)
    head = {"version": __version__, "large": sorted(writer.large)}
    body = {"root": root, "parts": writer.parts, "arrays": writer.facts}
    lines = [
        json.dumps(part, separators=(",", ":"), allow_nan=False).encode() for part in (head, body)
    ]
    return Packed(b"\n".join([*lines, b"".join(writer.small)]), writer.large)


def large_of(data: bytes) -> list[str]:
    """Hashes of the large arrays of a packed value.

    Raises:
        MismatchError: Another version of Daguerre packed it.
        InputError: The bytes are damaged.
    """
    with damage():
        head = json.loads(data[: data.index(b"\n")])
        if head["version"] != __version__:
            raise MismatchError(
                f"packed value: made by daguerre {short(head['version'])}, but this is daguerre "
                f"{__version__}"
            )
        return [str(name) for name in head["large"]]


def unpack(data: bytes, large: Callable[[str], bytes], make: Make | None = None) -> Any:
    """Unpacks a value of :func:`pack`.

    Args:
        data: ``Packed.data``.
        large: Returns the bytes of a large array by its hash.
        make: Makes values of classes from parts made before, so that no value can hold itself;
            default: any class of Daguerre, with its attributes as they were packed.

    Raises:
        MismatchError: Another version of Daguerre packed the value.
        InputError: The bytes are damaged.
    """
    large_of(data)
    with damage():
        _, line, rest = data.split(b"\n", 2)
        body = json.loads(line)
        arrays = _arrays(body["arrays"], rest, large)
        return _PackedReader(body["parts"], arrays, make).of(body["root"])


_WRONG = (
    *(ImportError, LookupError, ValueError, TypeError, AttributeError, RecursionError),
    *(ArithmeticError, MemoryError),
)


@contextmanager
def damage() -> Iterator[None]:
    """Makes an ``InputError`` of errors that damaged bytes cause; Daguerre's errors pass."""
    try:
        yield
    except DaguerreError:
        raise
    except _WRONG as error:
        what = " ".join(str(error).split())[:200]
        raise InputError(f"packed value: damaged: {type(error).__name__}: {what}") from None


def _arrays(
    facts: Iterable[Sequence[Any]],
    data: bytes,
    large: Callable[[str], bytes],
) -> list[NDArray[Any]]:
    """Arrays over packed bytes, not copied, and so read-only.

    Args:
        facts: Type, shape, and name of each array; the name is None within ``data``.
        data: Bytes of the small arrays.
        large: Function that returns the bytes of a large array by its name.
    """
    found, begin = [], 0
    for text, shape, name in facts:
        if not _TYPE.fullmatch(text):
            raise ValueError(f"an array of {short(text)}")
        kind = np.dtype(text)
        if min(shape, default=0) < 0:
            raise ValueError("an array of negative size")
        count = math.prod(shape)
        source = data if name is None else large(name)
        at = begin if name is None else 0
        found.append(
            np.frombuffer(source, kind, count, at).reshape(shape)
            if count
            else np.zeros(shape, kind)
        )
        begin += padded(count * kind.itemsize) if name is None else 0
    if begin != len(data):
        raise ValueError("bytes are left over")
    return found


def padded(size: int) -> int:
    """Size of an array with padding, so that the next array is aligned, bytes."""
    return size + -size % _ALIGNED


class _Writer:
    """Parts of a value, each once."""

    def __init__(self, name: Callable[[NDArray[Any]], str], least: float) -> None:
        self.parts: list[Any] = []
        self.facts: list[Any] = []  # of arrays
        self.small: list[bytes] = []
        self.large: dict[str, NDArray[Any]] = {}
        self._name, self._least = name, least
        self._numbers: dict[int, Any] = {}
        self._alive: list[Any] = []  # so that no id is used twice

    def of(self, value: object) -> Any:
        """JSON of a value: itself, or its parts with the key of their kind."""
        if value is None or isinstance(value, bool | str) or type(value) is int:
            return value
        if type(value) is float:
            return value if math.isfinite(value) else {"float": str(value)}
        if type(value) is tuple:
            return {"tuple": [self.of(part) for part in value]}
        if isinstance(value, PurePath):
            return {"path": str(value)}
        if isinstance(value, np.generic):
            return {"scalar": self._array(np.asarray(value))}
        if id(value) not in self._numbers:
            self._alive.append(value)
            if isinstance(value, np.ndarray):
                self._numbers[id(value)] = {"array": self._array(value)}
            else:
                self._part(value)
        return self._numbers[id(value)]

    def _array(self, array: NDArray[Any]) -> int:
        if not _TYPE.fullmatch(array.dtype.str):
            raise UsageError(f"packing: wanted an array of numbers, got an array of {array.dtype}")
        plain, name = np.ascontiguousarray(array).reshape(array.shape), None
        if plain.nbytes < self._least:
            self.small += [plain.tobytes(), bytes(-plain.nbytes % _ALIGNED)]
        else:
            name = self._name(plain)
            self.large[name] = plain
        self.facts.append([plain.dtype.str, plain.shape, name])
        return len(self.facts) - 1

    def _part(self, value: object) -> None:
        number = len(self.parts)
        self._numbers[id(value)] = {"part": number}
        self.parts.append(None)  # parts of the value may refer to it
        self.parts[number] = self._contents(value)

    def _contents(self, value: Any) -> Any:
        if type(value) in _SEQUENCES:
            return {type(value).__name__: [self.of(part) for part in value]}
        if type(value) in _MAPPINGS:
            pairs = [[self.of(key), self.of(part)] for key, part in value.items()]
            return {type(value).__name__: pairs}
        if isinstance(value, Item):
            _, (held, place) = value.__reduce__()
            return {"item": [self.of(held), self.of(place)]}
        kind = type(value)
        if _class_of(name_of(kind)) is not kind:
            raise UsageError(
                f"packing: wanted a value of daguerre, numbers or text, got {short(value)}; "
                "values of your own classes cannot go to another machine"
            )
        return {"class": name_of(kind), "state": self.of(_state_of(value))}


_SEQUENCES = {kind: kind.__name__ for kind in (list, set, frozenset)}
_MAPPINGS = {kind: kind.__name__ for kind in (dict, OrderedDict)}


def _state_of(value: object) -> dict[str, Any]:
    """Attributes that a pickle would keep."""
    if isinstance(value, Value):
        return value.__getstate__()
    return dict(vars(value))


def name_of(kind: type[Any]) -> str:
    """Name of a class in a packed value."""
    return f"{kind.__module__}:{kind.__qualname__}"


def _class_of(name: str) -> type[Any] | None:
    """A class of values of Daguerre by its name; None: no such class."""
    module, _, rest = name.partition(":")
    if not module.startswith(_OURS):
        return None
    found: Any = importlib.import_module(module)
    for part in rest.split("."):
        found = vars(found).get(part)
    if not isinstance(found, type) or name_of(found) != name:
        return None
    return found if issubclass(found, Value) or dataclasses.is_dataclass(found) else None


class _PackedReader:
    """Values of packed parts."""

    def __init__(
        self, parts: list[Any], arrays: list[NDArray[Any]], make: Make | None = None
    ) -> None:
        self._parts, self._arrays, self._make_value = parts, arrays, make
        self._made: dict[int, Any] = {}

    def of(self, given: object) -> Any:
        """Value of its JSON."""
        if not isinstance(given, dict):
            return given
        ((key, content),) = given.items()
        match key:
            case "part":
                return self._part(content)
            case "array":
                return self._arrays[content]
            case "tuple":
                return tuple(self.of(part) for part in content)
            case "float":
                return float(content)
            case "path":
                return Path(content)
            case "scalar":
                return self._arrays[content][()]
        raise ValueError(f"no kind of value {short(key)}")

    def _part(self, number: int) -> Any:
        if number not in self._made:
            self._make(number, self._parts[number])
        return self._made[number]

    def _make(self, number: int, given: dict[str, Any]) -> None:
        if "class" in given:
            self._make_object(number, given)
            return
        ((key, content),) = given.items()
        match key:
            case "list":
                found = self._made[number] = []
                found.extend(self.of(part) for part in content)
            case "dict" | "OrderedDict":
                pairs = self._made[number] = {} if key == "dict" else OrderedDict()
                pairs.update((self.of(k), self.of(v)) for k, v in content)
            case "set" | "frozenset":
                kind = set if key == "set" else frozenset
                self._made[number] = kind(self.of(part) for part in content)
            case "item":
                self._made[number] = _item(*map(self.of, content))
            case _:
                raise ValueError(f"no kind of part {short(key)}")

    def _make_object(self, number: int, given: dict[str, Any]) -> None:
        if self._make_value is not None:
            self._made[number] = self._make_value(given["class"], self.of(given["state"]))
            return
        kind = _class_of(given["class"])
        if kind is None:
            raise ValueError(f"no class of values {short(given['class'])}")
        made: Any = object.__new__(kind)
        self._made[number] = made
        state = self.of(given["state"])
        if isinstance(made, Value):
            made.__setstate__(state)
        else:
            vars(made).update(state)


def _item(value: object, place: tuple[str | int, ...]) -> Item:
    """An item at its place."""
    item = Item(None, place[0])
    for key in place[1:]:
        item = Item(None, key, item)
    item.value = value
    return item
