"""Kinds of values that annotations name, and the values that each accepts."""

from __future__ import annotations

import collections.abc
import math
import numbers
import operator
import os
import types
import typing
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path, PurePath
from typing import Any

import numpy as np

from .checks import MAX_NUMBERS

#: Result of ``take`` for a value of another kind.
REFUSED: Any = object()
_MOST_PARTS = 100_000
_ROWS = (collections.abc.Sequence, np.ndarray)
_NO_ROWS = (str, bytes, bytearray, collections.abc.Mapping, os.PathLike)
_WHOLE = 1 << 63


@dataclass(frozen=True)
class Kind:
    """A kind of values.

    Attributes:
        words: Description of accepted values, for messages.
        take: Function that returns the value in plain form, or ``REFUSED``.
        arrays: Whether arrays of any shape are accepted.
    """

    words: str
    take: Callable[[Any], Any]
    arrays: bool = False


class Unseen:
    """Base of placeholders for classes that only type checkers import."""

    def __class_getitem__(cls, item: object) -> type[Unseen]:
        return cls


def unseen(name: str) -> type[Unseen]:
    """Makes a placeholder for the class of this name."""
    return type(name, (Unseen,), {})


def of(hint: object, *, none: bool = False) -> Kind | None:
    """Kind that an annotation names; None: anything, or a kind that is not checked."""
    parts = typing.get_args(hint) if _is_union(hint) else (hint,)
    none = none or None in parts or types.NoneType in parts
    found = [_single(part) for part in parts if part not in (None, types.NoneType)]
    if None in found:
        return None
    known = [kind for kind in found if kind is not None]
    if PATH in known:  # then texts are paths, which accept no zero byte
        known = [kind for kind in known if kind is not TEXT]
    if len(known) == 1 and not none:
        return known[0]
    words = " or ".join(dict.fromkeys([k.words for k in known] + ["None"] * none))

    def take(value: object) -> Any:
        if value is None and none:
            return None
        for kind in known:
            taken = kind.take(value)
            if taken is not REFUSED:
                return taken
        return REFUSED

    return Kind(words, take, any(kind.arrays for kind in known))


def _is_union(hint: object) -> bool:
    return isinstance(hint, types.UnionType) or typing.get_origin(hint) is typing.Union


def _single(hint: object) -> Kind | None:
    if hasattr(hint, "__value__"):  # a `type` alias, as NDArray of NumPy 2.5
        return of(hint.__value__)
    origin = typing.get_origin(hint) or hint
    if origin in _PLAIN:
        return _PLAIN[origin]
    if origin is Any or origin is object:
        return None
    if origin is typing.Literal:
        return TEXT if all(isinstance(v, str) for v in typing.get_args(hint)) else None
    if origin in (tuple, list, collections.abc.Sequence, collections.abc.Iterable):
        return _parts(origin, typing.get_args(hint))
    if not isinstance(origin, type):
        return None
    if origin.__name__ in _ARRAYS:
        return ARRAY
    if getattr(origin, "_is_protocol", False):
        return _protocol(origin.__name__, vars(origin))
    if issubclass(origin, Unseen) and origin.__name__ in _PROTOCOLS:
        return _protocol(origin.__name__, _PROTOCOLS[origin.__name__])
    if issubclass(origin, Unseen) and origin.__name__ in _OPEN:
        return None
    return _object(origin)


def _protocol(name: str, members: Iterable[str]) -> Kind:
    """Kind of objects of any class with the members of a protocol."""
    asked = [m for m in members if m == "__call__" or not m.startswith("_")]

    def take(value: object) -> Any:
        fits = not isinstance(value, type) and all(hasattr(value, m) for m in asked)
        return value if fits else REFUSED

    words = {"Dynamic": "a value over time", "__call__": "a function"}
    return Kind(words.get(name, f"a {name}"), take)


def _object(cls: type) -> Kind:
    """Kind of objects of a class; a class that only type checkers import is found by name."""
    name = cls.__name__
    article = "an" if name[0] in "AEIOU" else "a"

    def take(value: object) -> Any:
        if isinstance(value, cls):
            return value
        named = issubclass(cls, Unseen) and any(c.__name__ == name for c in type(value).__mro__)
        return value if named else REFUSED

    return Kind(f"{article} {name}", take)


def _parts(origin: object, args: tuple[Any, ...]) -> Kind:
    """Kind of tuples, or other sequences of values of one kind."""
    fixed = origin is tuple and bool(args) and args[-1] is not Ellipsis
    inner = [of(arg) for arg in args if arg is not Ellipsis]
    words = _words_of_parts(inner, fixed)
    lazy = origin is collections.abc.Iterable

    def take(value: object) -> Any:
        if type(value) is not tuple and type(value) is not list:  # these are the usual ones
            if isinstance(value, _NO_ROWS):
                return REFUSED
            if lazy and not isinstance(value, _ROWS):
                return value if isinstance(value, collections.abc.Iterable) else REFUSED
            if not isinstance(value, _ROWS):
                return REFUSED
            if isinstance(value, np.ndarray) and not (value.ndim and value.size <= _MOST_PARTS * 8):
                return REFUSED
        if (fixed and len(value) != len(inner)) or len(value) > _MOST_PARTS:
            return REFUSED
        if not inner:
            return value
        if fixed:
            taken = [p if k is None else k.take(p) for k, p in zip(inner, value, strict=True)]
        else:
            one = inner[0]
            taken = list(value) if one is None else [one.take(part) for part in value]
        for part in taken:
            if part is REFUSED:
                return REFUSED
        return tuple(taken) if origin is tuple else (value if lazy else list(taken))

    return Kind(words, take)


def _words_of_parts(inner: list[Kind | None], fixed: bool) -> str:
    words = list(dict.fromkeys("values" if kind is None else kind.words for kind in inner))
    if len(words) != 1:
        return f"{len(inner)} values" if fixed else "values"
    plural = {"a number": "numbers", "a whole number": "whole numbers", "a string": "strings"}
    one = plural.get(words[0], f"values, each {words[0]}")
    return f"{len(inner)} {one}" if fixed else f"a list of {one}"


def _number(value: Any) -> Any:
    """Accepts a real number that a double can hold, but not NaN or a flag."""
    if type(value) is float:
        return REFUSED if value != value else value
    if type(value) is int and -_WHOLE < value < _WHOLE:
        return value
    if isinstance(value, np.ndarray):
        if value.ndim or value.dtype.kind not in "iuf":
            return REFUSED
    elif isinstance(value, bool | np.bool_) or not isinstance(value, numbers.Real):
        return REFUSED
    try:
        plain = float(value)
    except (OverflowError, ValueError, TypeError):
        return REFUSED
    if math.isnan(plain):
        return REFUSED
    return value if isinstance(value, int) and abs(value) < _WHOLE else plain


def _whole(value: Any) -> Any:
    if isinstance(value, np.ndarray) and value.ndim:
        return REFUSED
    try:
        plain = operator.index(value)
    except TypeError:
        return REFUSED
    return plain if -_WHOLE <= plain < _WHOLE else REFUSED


def _flag(value: object) -> Any:
    if isinstance(value, bool | np.bool_):
        return bool(value)
    return bool(value) if type(value) is int and value in (0, 1) else REFUSED


def _text(value: object) -> Any:
    return value if isinstance(value, str) else REFUSED


def _path(value: object) -> Any:
    """Accepts a path that the system can have: text without a zero byte or half a character."""
    if isinstance(value, os.PathLike) and not isinstance(value, PurePath):
        value = os.fspath(value)
    if not isinstance(value, str | PurePath):
        return REFUSED
    try:
        return REFUSED if b"\0" in os.fsencode(value) else value
    except UnicodeEncodeError:  # a lone surrogate, as JSON can hold
        return REFUSED


def is_path(text: str) -> bool:
    """Whether the system can have a path of this text."""
    return _path(text) is not REFUSED


def _array(value: object) -> Any:
    """Accepts numbers of any shape."""
    if not isinstance(value, np.ndarray):
        if isinstance(value, str | bytes | bytearray | np.bool_ | bool):
            return REFUSED
        try:
            value = np.asarray(value)
        except (ValueError, TypeError, RecursionError, OverflowError):
            return REFUSED
    if value.dtype.kind not in "iufb" or value.size > MAX_NUMBERS:
        return REFUSED
    return np.asarray(value)


NUMBER = Kind("a number", _number)
TEXT = Kind("a string", _text)
PATH = Kind("a path", _path)
ARRAY = Kind("numbers", _array, arrays=True)
_PLAIN: dict[Any, Kind] = {
    float: NUMBER,
    int: Kind("a whole number", _whole),
    bool: Kind("True or False", _flag),
    str: TEXT,
    bytes: Kind("bytes", lambda v: v if isinstance(v, bytes) else REFUSED),
    os.PathLike: PATH,
    Path: PATH,
    np.ndarray: ARRAY,
    dict: Kind("a dict", lambda v: v if isinstance(v, dict) else REFUSED),
    collections.abc.Mapping: Kind(
        "a dict", lambda v: v if isinstance(v, collections.abc.Mapping) else REFUSED
    ),
    collections.abc.Callable: Kind("a function", lambda v: v if callable(v) else REFUSED),
}
#: Names of annotations: aliases of arrays, and kinds that are checked where they are used.
_ARRAYS = frozenset({"_Numbers", "FloatArray", "Floats", "Image", "Real"})
_OPEN = frozenset({"Progress", "Source", "Samples", "OverscanLike", "Self", "Light"})
#: Protocols that a module may import for type checkers only, and their members.
_PROTOCOLS = {"Dynamic": ("at", "breaks")}
