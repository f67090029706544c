"""Strict JSON parser for values with their place.

Python's parser is more lenient: it accepts NaN, and takes the last of two members of one name.
Source: RFC 8259, chapters 4 (names should be unique), 6 and 8.1.
"""

from __future__ import annotations

import json
import re
from typing import Any, NoReturn

from daguerre.errors import InputError

from .json_item import Item
from .reading import document


def parse(data: bytes, file: str) -> Item:
    """Parses the bytes of a file.

    Raises:
        InputError: The bytes are not JSON, are nested too deeply, or an object has a member twice.
    """
    return Item(_value(document(data, f"{file}: JSON"), file), file)


class _NotJson(Exception):
    """Constant that JSON does not have."""


class _Twice:
    """Marker for an object with two members of one name."""


def _value(text: str, file: str) -> Any:
    doubled = False

    def members(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        nonlocal doubled
        found = dict(pairs)
        if len(found) < len(pairs):
            doubled = True
            names: set[str] = set()
            for name, _ in pairs:
                if name in names:
                    found[name] = _Twice()
                names.add(name)
        return found

    try:
        value = json.loads(text, parse_constant=_refuse, object_pairs_hook=members)
    except json.JSONDecodeError as error:
        raise InputError(
            f"{file}: JSON: line {error.lineno}, column {error.colno}: {error.msg}"
        ) from None
    except _NotJson as error:
        line, column = _place(text)
        raise InputError(
            f"{file}: JSON: line {line}, column {column}: wanted a finite number, got {error}"
        ) from None
    except RecursionError:
        raise InputError(f"{file}: JSON: nested too deeply") from None
    except ValueError:  # Python's limit
        raise InputError(f"{file}: JSON: a whole number has too many digits") from None
    if doubled:
        _complain(Item(value, file))
    return value


def _refuse(name: str) -> NoReturn:
    raise _NotJson(name)


def _place(text: str) -> tuple[int, int]:
    """Line and column of the first NaN or Infinity outside of strings, which the parser lacks."""
    for match in re.finditer(r'"(?:[^"\\]|\\.)*"|NaN|-?Infinity', text):
        if match[0][0] != '"':
            line = text.count("\n", 0, match.start()) + 1
            return line, match.start() - text.rfind("\n", 0, match.start())
    return 1, 1


def _complain(root: Item) -> None:
    """Raises an error for the first duplicate member; without recursion."""
    stack = [root]
    while stack:
        item = stack.pop()
        if isinstance(item.value, _Twice):
            item.fail("this member appears twice")
        if isinstance(item.value, dict):
            stack.extend(reversed(item.members()))
        elif isinstance(item.value, list):
            stack.extend(reversed(list(item)))
