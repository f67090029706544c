"""Errors, each with an exit code. Every message names what, where, wanted and got."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager

from ._core import Error as CoreError

__all__ = [
    "CoreError",
    "DaguerreError",
    "InputError",
    "MismatchError",
    "OutputError",
    "UsageError",
    "asked_by",
    "core_errors",
    "did_you_mean",
    "nearest",
    "suggest",
]


class DaguerreError(ValueError):
    """Base of all errors that a user can correct."""

    exit_code = 3


class UsageError(DaguerreError):
    """A wrong command line or parameter (exit code 2)."""

    exit_code = 2


class InputError(DaguerreError):
    """An unreadable or invalid input file, scene or lens (exit code 3)."""

    exit_code = 3


class MismatchError(DaguerreError):
    """Passes or checkpoints that do not belong together (exit code 4)."""

    exit_code = 4


class OutputError(DaguerreError):
    """An output that cannot be written (exit code 5)."""

    exit_code = 5


@contextmanager
def core_errors(raised: type[DaguerreError], where: str = "") -> Iterator[None]:
    """Converts errors of the core to ``raised``, with ``where`` in front of the message.

    It works as a decorator, too. Other errors pass: a ``ValueError`` of our own code is a bug.
    """
    try:
        yield
    except CoreError as error:
        raise raised(f"{where}: {error}" if where else str(error)) from None


@contextmanager
def asked_by(place: object) -> Iterator[None]:
    """Puts the place that asks for a file in front of messages about this file.

    ``place`` becomes text only when there is a message.
    """
    try:
        yield
    except InputError as error:
        raise InputError(f"{place}: {error}") from None


def suggest(name: object, known: Iterable[str], *, few: bool = False) -> str:
    """Makes " (did you mean 'a', 'b' or 'c'?)" from the nearest known names.

    The spelling decides, upper and lower case alike; else names that have all words of the given
    one. With ``few``, for messages that do not list the names, a short list is shown if none is
    near.
    """
    names = sorted(known)
    if near := nearest(name, names):
        return did_you_mean(near)
    return f" (known: {', '.join(map(repr, names))})" if few and 0 < len(names) <= 8 else ""


def nearest(name: object, names: list[str]) -> list[str]:
    """Names with a spelling near another; if there are none, those that have all of its words."""
    import difflib  # not at every start of the program

    text = str(name).casefold()
    plain = {each: each.casefold() for each in names}
    close = difflib.get_close_matches(text, list(plain.values()), n=3, cutoff=0.5)
    if close:
        return sorted((n for n in names if plain[n] in close), key=lambda n: close.index(plain[n]))
    words = [word for word in re.findall(r"[^\W_]+", text) if len(word) > 1]
    return [n for n in names if words and all(word in plain[n] for word in words)]


def did_you_mean(names: Sequence[str]) -> str:
    """Makes " (did you mean 'a', 'b', 'c' or 4 others?)" from names, best first; "" from none."""
    if not names:
        return ""
    words = [*map(repr, names[:3]), *([_others(len(names) - 3)] if len(names) > 3 else [])]
    return f" (did you mean {' or '.join(filter(None, (', '.join(words[:-1]), words[-1])))}?)"


def _others(count: int) -> str:
    return "1 other" if count == 1 else f"{count} others"
