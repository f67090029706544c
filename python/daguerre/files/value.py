"""Value classes: pickle, copy and compare by content.

Cached results of a value (``cached_property``, such as its form in the core) are not pickled, but
computed again where needed. A pickle can only be read by the version that made it, as its parts may
have other names or meanings in another.
"""

from __future__ import annotations

import types
from dataclasses import MISSING, Field, fields
from itertools import zip_longest
from typing import Any

import numpy as np

from daguerre._core import __version__
from daguerre.cached import cached_property
from daguerre.checks import freeze_in_place, short
from daguerre.errors import InputError

_Seen = dict[tuple[int, int], tuple[Any, Any]]
_PLAIN = str | int | bool | None
#: Most elements of arrays and lists, and characters of a record within another, that print.
_FEW, _LONG = 4, 160
#: Key under which a pickle keeps the version that made it; no attribute has this name.
MADE_BY = "made by daguerre"


class Value:
    """Base of values that may hold arrays; dataclasses need ``eq=False``."""

    def __getstate__(self) -> dict[str, Any]:
        kind = type(self)
        parts = {
            name: part
            for name, part in vars(self).items()
            if not isinstance(getattr(kind, name, None), cached_property)
        }
        return parts | {MADE_BY: __version__}

    def __setstate__(self, state: dict[str, Any]) -> None:
        if state.get(MADE_BY) != __version__:
            raise InputError(
                f"pickle of a {type(self).__name__}: made by daguerre "
                f"{state.get(MADE_BY, 'of an older version')}, but this is daguerre {__version__}"
            )
        vars(self).update((name, part) for name, part in state.items() if name != MADE_BY)

    def __eq__(self, other: object) -> bool:
        return same(self, other) if isinstance(other, Value) else NotImplemented

    def __hash__(self) -> int:
        state = self.__getstate__()
        return hash((type(self), *(part for part in state.values() if isinstance(part, _PLAIN))))


class FixedArrays(Value):
    """Base of values with read-only arrays, also after unpickling, as the core reads them."""

    def __setstate__(self, state: dict[str, Any]) -> None:
        super().__setstate__(state)
        for part in state.values():
            if isinstance(part, np.ndarray):
                freeze_in_place(part)


class BriefRecord:
    """Base of dataclasses (``repr=False``) that print the fields not at their defaults."""

    def __repr__(self) -> str:
        told = ", ".join(f"{name}={text}" for name, text in changed(self).items())
        return f"{type(self).__name__}({told})"


def same(a: object, b: object) -> bool:
    """Whether two values are equal: numbers by value, NaN equals NaN, arrays by elements.

    Types that define no comparison are compared by their pickled state.
    """
    return _same(a, b, {})


def _same(a: Any, b: Any, seen: _Seen) -> bool:
    if a is b:
        return True
    if isinstance(a, int | float | np.generic) and isinstance(b, int | float | np.generic):
        return bool(a == b or (a != a and b != b))
    if type(a) is not type(b):
        return False
    if (id(a), id(b)) in seen:  # shared parts are looked at once
        return True
    seen[id(a), id(b)] = a, b  # also keeps them alive, and so their ids
    if isinstance(a, np.ndarray):
        return a.dtype == b.dtype and np.array_equal(a, b, equal_nan=a.dtype.kind in "fc")
    if isinstance(a, dict):
        return a.keys() == b.keys() and all(_same(a[key], b[key], seen) for key in a)
    if isinstance(a, tuple | list):
        return len(a) == len(b) and all(_same(x, y, seen) for x, y in zip(a, b, strict=True))
    if isinstance(a, Value) or not _compares(type(a)):
        return _pickled_alike(a, b, seen)
    return bool(a == b)


def _compares(kind: type[Any]) -> bool:
    """Whether a type defines its own comparison."""
    return any("__eq__" in vars(base) for base in kind.__mro__[:-1])


def _pickled_alike(a: object, b: object, seen: _Seen) -> bool:
    if isinstance(a, type | types.FunctionType):
        return False
    try:
        parts = zip_longest(a.__reduce_ex__(4), b.__reduce_ex__(4))
    except TypeError:  # it stays where it is
        return False
    return all(_same(x, y, seen) for x, y in parts)


def changed(record: Any) -> dict[str, str]:
    """Fields of a dataclass that differ from their defaults, as texts for printing."""
    return {
        field.name: _brief(value)
        for field in fields(record)
        if not same(value := getattr(record, field.name), _default(field))
    }


def _default(field: Field[Any]) -> Any:
    made = field.default_factory
    return field.default if made is MISSING else made()


def _brief(value: object) -> str:
    if isinstance(value, np.ndarray):
        if value.ndim != 1 or value.size > _FEW or value.dtype.kind not in "iuf":
            return f"<array {value.shape}>"
        return f"[{', '.join(f'{number:.4g}' for number in value)}]"
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, tuple | list | dict) and len(value) > _FEW:
        return f"<{type(value).__name__} of {len(value)}>"
    if type(value) is tuple and len(value) > 1:
        return f"({', '.join(map(_brief, value))})"
    text = repr(value) if isinstance(value, BriefRecord) else short(value)
    if isinstance(value, Value) and (head := repr(value)).count("\n"):
        return f"<{head.partition(chr(10))[0]}>"
    return text if len(text) <= _LONG else f"<{type(value).__name__}>"
