"""YAML parser of plain data, for values with their place.

It refuses tags, anchors and aliases, which calibrations do not need, and through which a small file
can grow without bounds or name Python objects. The exceptions are OpenCV's tag of matrices and its
first line ``%YAML:1.0``, which is not valid YAML. Numbers follow YAML 1.2: YAML 1.1 reads
``1e-08``, as OpenCV and Python write it, as text.

LibYAML finds the events of a text (PyYAML's own parser takes 30 times as long), and this file makes
values of them.

Source: YAML 1.2.2, chapter 10.3 (the core schema).
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any, NoReturn

import yaml

from daguerre.errors import InputError

from .json_item import Item, short
from .reading import document

OPENCV_MATRIX = "tag:yaml.org,2002:opencv-matrix"
_OPENCV_HEAD = re.compile(r"\A\ufeff?%YAML:1\.0[^\n]*")
#: Most levels of lists and mappings, as many as JSON's parser takes; LibYAML stops there, too.
_DEEPEST = 1000
_PARSER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # builds without LibYAML have SafeLoader
_INT = re.compile(r"[-+]?[0-9]+")
_FLOAT = re.compile(r"[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?")
_WORDS: dict[str, Any] = {
    **dict.fromkeys(("", "~", "null", "Null", "NULL")),
    **dict.fromkeys(("true", "True", "TRUE"), True),
    **dict.fromkeys(("false", "False", "FALSE"), False),
    **dict.fromkeys((".nan", ".NaN", ".NAN", ".Nan"), float("nan")),
    **{f"{sign}{word}": float(f"{sign}inf") for sign in ("", "+", "-")
       for word in (".inf", ".Inf", ".INF")},
}  # fmt: skip


def parse(data: bytes, file: str) -> Item:
    """Parses the bytes of a file.

    Raises:
        InputError: The bytes are not YAML, or have features that calibrations do not need.
    """
    text = document(data, f"{file}: YAML")
    text = _OPENCV_HEAD.sub("", text, count=1)
    text = re.sub(r"\n---\s*\Z", "\n", text)  # as `rostopic echo` ends each message
    try:
        return Item(_Values(yaml.parse(text, Loader=_PARSER)).only(), file)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        place = f"line {mark.line + 1}, column {mark.column + 1}: " if mark else ""
        fault = str(error.problem or error.context)
        fault = "nested too deeply" if "nesting depth" in fault else fault
        raise InputError(f"{file}: YAML: {place}{fault}") from None
    except yaml.YAMLError as error:
        raise InputError(f"{file}: YAML: {' '.join(str(error).split())}") from None
    except RecursionError:
        raise InputError(f"{file}: YAML: nested too deeply") from None
    except ValueError as error:
        long = "digits" in str(error)  # Python's limit, and its advice for programs
        reason = "a whole number has too many digits" if long else error
        raise InputError(f"{file}: YAML: {reason}") from None


class _Values:
    """Values of the events of a text: mappings, lists, numbers, text, true, false and null."""

    def __init__(self, events: Iterator[Any]) -> None:
        self._events = events
        self._depth = 0

    def only(self) -> Any:
        """Value of the only document; None: no document."""
        next(self._events)  # the start of the stream
        event = next(self._events)
        if isinstance(event, yaml.StreamEndEvent):
            return None
        value = self._value(next(self._events))
        next(self._events)  # the end of the document
        more = next(self._events)
        if not isinstance(more, yaml.StreamEndEvent):
            _refuse("wanted one document: another document begins here", more)
        return value

    def _value(self, event: Any) -> Any:
        if isinstance(event, yaml.AliasEvent) or event.anchor is not None:
            kind = "alias" if isinstance(event, yaml.AliasEvent) else "anchor"
            text = f"anchors and aliases are not supported, got {kind} {short(event.anchor)}"
            _refuse(text, event)
        if event.tag not in (None, OPENCV_MATRIX):
            _refuse(f"the only supported tag is !!opencv-matrix, got {short(event.tag)}", event)
        if event.tag and not isinstance(event, yaml.MappingStartEvent):
            _refuse("!!opencv-matrix: wanted rows, cols, dt and data", event)
        if isinstance(event, yaml.ScalarEvent):
            return _plain(event.value) if event.implicit[0] else event.value
        self._depth += 1
        if self._depth > _DEEPEST:
            _refuse("nested too deeply", event)
        found = self._list() if isinstance(event, yaml.SequenceStartEvent) else self._mapping()
        self._depth -= 1
        return found

    def _list(self) -> list[Any]:
        found = []
        for event in self._events:
            if isinstance(event, yaml.SequenceEndEvent):
                break
            found.append(self._value(event))
        return found

    def _mapping(self) -> dict[str, Any]:
        """Accepts only text as names, each once; PyYAML would take the last of two."""
        found: dict[str, Any] = {}
        for event in self._events:
            if isinstance(event, yaml.MappingEndEvent):
                break
            if not isinstance(event, yaml.ScalarEvent):
                _refuse("names must be text", event)
            self._value(event)  # checks anchor and tag
            if event.value in found:
                _refuse(f"{short(event.value)} appears twice", event)
            found[event.value] = self._value(next(self._events))
        return found


def _refuse(what: str, at: Any) -> NoReturn:
    raise yaml.MarkedYAMLError(None, None, what, at.start_mark)


def _plain(text: str) -> Any:
    """Value of a text without quotes, by the core schema."""
    if text in _WORDS:
        return _WORDS[text]
    if _INT.fullmatch(text):
        return int(text)  # YAML 1.1 would take 010 for 8
    return float(text) if _FLOAT.fullmatch(text) else text
