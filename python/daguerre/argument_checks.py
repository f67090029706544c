"""Type checks of the arguments of public functions, by their annotations.

``@guarded`` reads the kinds of a function's parameters from its annotations, once, on its first
call: a scene, a path, a number, numbers, a text. A value of another kind raises an error that names
function, parameter, wanted and got. The function itself checks limits. For a ``@guarded`` class all
public methods are checked, and with ``init=True`` its constructor.
"""

from __future__ import annotations

import builtins
import functools
import inspect
import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, TypeVar, overload

import numpy as np

from . import annotation_kinds as kinds
from .annotation_kinds import Kind
from .checks import shown
from .errors import UsageError

Anything = TypeVar("Anything", bound=Callable[..., Any])


class _Numbers:
    """Placeholder for ``ArrayLike`` and ``NDArray[...]`` while an annotation is read."""

    def __class_getitem__(cls, item: object) -> type[_Numbers]:
        return cls


#: Names of annotations that a module may import for type checkers alone.
_KNOWN: dict[str, Any] = {
    "Any": Any, "ArrayLike": _Numbers, "Callable": Callable, "Iterable": Iterable,
    "Iterator": Iterator, "Literal": Literal, "Mapping": Mapping, "NDArray": _Numbers,
    "Path": Path, "Sequence": Sequence, "np": np, "os": os,
}  # fmt: skip


class _Names(dict[str, Any]):
    """Names of a module; a name that only type checkers import becomes an empty class."""

    def __missing__(self, name: str) -> Any:
        return kinds.unseen(name)


@dataclass(frozen=True)
class _Plan:
    """Parameters of a function to check.

    Attributes:
        by_place: Position, name and kind of positional parameters.
        by_name: Kinds of all parameters by name.
    """

    by_place: tuple[tuple[int, str, Kind], ...]
    by_name: Mapping[str, Kind]


@overload
def guarded(function: Anything) -> Anything: ...


@overload
def guarded(
    *, init: bool = ..., arrays: bool = ..., but: tuple[str, ...] = ...
) -> Callable[[Anything], Anything]: ...


def guarded(
    function: Any = None, *, init: bool = False, arrays: bool = True, but: tuple[str, ...] = ()
) -> Any:
    """Checks the kinds of the arguments of a function, or of each public method of a class.

    Args:
        function: The function or class.
        init: Whether to check the constructor of a class, too.
        arrays: Whether to check arrays; if not, the function does, and names the shape it wants.
        but: Names of parameters that the function checks itself, with better messages.
    """
    if function is None:
        return functools.partial(guarded, init=init, arrays=arrays, but=but)
    if not inspect.isclass(function):
        return _with_checks(function, function.__name__, arrays, but)
    ours = [base for base in function.__mro__ if base.__module__.startswith("daguerre.")]
    members = {name: member for base in reversed(ours) for name, member in vars(base).items()}
    for name, member in members.items():
        if not name.startswith("_") or (init and name == "__init__"):
            _add_checks(function, name, member, arrays, but)
    return function


def _add_checks(cls: type, name: str, member: object, arrays: bool, but: tuple[str, ...]) -> None:
    """Adds checks to a method of a class, own or inherited, that has none yet."""
    if hasattr(getattr(member, "__func__", member), "has_checks"):
        return
    shown_as = cls.__name__ if name == "__init__" else name
    if isinstance(member, classmethod | staticmethod):
        setattr(cls, name, type(member)(_with_checks(member.__func__, shown_as, arrays, but)))
    elif inspect.isfunction(member):
        setattr(cls, name, _with_checks(member, shown_as, arrays, but))


def _with_checks(function: Any, name: str, arrays: bool, but: tuple[str, ...]) -> Any:
    """Returns the function with checks, or itself if it has no parameters to check."""
    if not function.__annotations__.keys() - {"return"}:
        return function
    plan: _Plan | None = None

    @functools.wraps(function)
    def checked(*args: Any, **keywords: Any) -> Any:
        nonlocal plan
        if plan is None:  # two threads may both make a plan; each sees a complete plan
            plan = _plan(function, arrays, but)
        given, count = list(args), len(args)
        for place, key, kind in plan.by_place:
            if place < count:
                given[place] = taken = kind.take(args[place])
                if taken is kinds.REFUSED:
                    raise _refusal(kind, args[place], name, key)
        for key, value in keywords.items():
            if key in plan.by_name:
                kind = plan.by_name[key]
                keywords[key] = taken = kind.take(value)
                if taken is kinds.REFUSED:
                    raise _refusal(kind, value, name, key)
        return function(*given, **keywords)

    checked.has_checks = True  # type: ignore[attr-defined]
    return checked


def _refusal(kind: Kind, value: object, function: str, parameter: str) -> UsageError:
    return UsageError(f"{function}: {parameter}: wanted {kind.words}, got {shown(value)}")


def _plan(function: Any, arrays: bool, but: tuple[str, ...]) -> _Plan:
    inner = inspect.unwrap(function)
    names = _Names({**vars(builtins), **inner.__globals__, **_KNOWN})
    by_name: dict[str, Kind] = {}
    by_place: list[tuple[int, str, Kind]] = []
    for place, parameter in enumerate(inspect.signature(inner).parameters.values()):
        hint, name = parameter.annotation, parameter.name
        if parameter.kind in (parameter.VAR_KEYWORD, parameter.VAR_POSITIONAL):
            continue
        if isinstance(hint, str):
            hint = eval(hint, {}, names)
        if hint is parameter.empty or name in but:
            continue
        kind = kinds.of(hint, none=parameter.default is None)
        if kind is None or (kind.arrays and not arrays):
            continue
        by_name[name] = kind
        if parameter.kind is not parameter.KEYWORD_ONLY:
            by_place.append((place, name, kind))
    return _Plan(tuple(by_place), by_name)
