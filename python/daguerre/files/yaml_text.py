"""YAML parser of plain data, for values with their place.

It refuses tags, anchors and aliases, which calibrations do not need, and through which a small file
can grow without bounds or name Python objects. The exceptions are OpenCV's tag of matrices and its
first line ``%YAML:1.0``, which is not valid YAML. Numbers are those of YAML 1.2: YAML 1.1 reads
``1e-08``, as OpenCV and Python write it, as text.

Source: YAML 1.2.2, chapter 10.3 (the core schema).
"""

from __future__ import annotations

import re
from typing import Any

import yaml

from daguerre.errors import InputError

from .json_item import Item, short
from .reading import document

OPENCV_MATRIX = "tag:yaml.org,2002:opencv-matrix"
_OPENCV_HEAD = re.compile(r"\A\ufeff?%YAML:1\.0[^\n]*")


def parse(data: bytes, file: str) -> Item:
    """Parses the bytes of a file.

    Raises:
        InputError: They are not YAML, or have features that calibrations do not need.
    """
    text = document(data, f"{file}: YAML")
    text = _OPENCV_HEAD.sub("", text, count=1)
    text = re.sub(r"\n---\s*\Z", "\n", text)  # as `rostopic echo` ends each message
    try:
        return Item(yaml.load(text, _Plain), file)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        place = f"line {mark.line + 1}, column {mark.column + 1}: " if mark else ""
        raise InputError(f"{file}: YAML: {place}{error.problem or error.context}") from None
    except yaml.YAMLError as error:
        raise InputError(f"{file}: YAML: {' '.join(str(error).split())}") from None
    except RecursionError:
        raise InputError(f"{file}: YAML: nested too deeply") from None
    except ValueError as error:
        long = "digits" in str(error)  # Python's limit, and its advice for programs
        reason = "a whole number has too many digits" if long else error
        raise InputError(f"{file}: YAML: {reason}") from None


class _Plain(yaml.SafeLoader):
    """Mappings, lists, numbers, text, true, false and null."""

    yaml_implicit_resolvers: dict[str, Any] = {}  # noqa: RUF012 (PyYAML's own way)

    def compose_node(self, parent: Any, index: Any) -> Any:
        event: Any = self.peek_event()  # type: ignore[no-untyped-call]
        if isinstance(event, yaml.AliasEvent) or event.anchor is not None:
            kind = "alias" if isinstance(event, yaml.AliasEvent) else "anchor"
            self._refuse(
                f"anchors and aliases are not supported, got {kind} {short(event.anchor)}", event
            )
        if event.tag not in (None, OPENCV_MATRIX):
            self._refuse(
                f"the only supported tag is !!opencv-matrix, got {short(event.tag)}", event
            )
        if event.tag and not isinstance(event, yaml.MappingStartEvent):
            self._refuse("!!opencv-matrix: wanted rows, cols, dt and data", event)
        return super().compose_node(parent, index)

    def construct_mapping(self, node: Any, deep: bool = False) -> dict[Any, Any]:
        """Accepts only text as names, each once; PyYAML would take the last of two."""
        found: dict[str, Any] = {}
        for key, value in node.value:
            if not isinstance(key, yaml.ScalarNode):
                self._refuse("names must be text", key)
            if key.value in found:
                self._refuse(f"{short(key.value)} appears twice", key)
            found[key.value] = self.construct_object(value, deep=deep)
        return found

    def _refuse(self, what: str, at: Any) -> None:
        raise yaml.constructor.ConstructorError(None, None, what, at.start_mark)


_CORE = {
    "null": (r"(?:~|null|Null|NULL|)", ["~", "n", "N", ""]),
    "bool": (r"(?:true|True|TRUE|false|False|FALSE)", list("tTfF")),
    "int": (r"[-+]?[0-9]+", list("-+0123456789")),
    "float": (
        r"[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?"
        r"|[-+]?\.(?:inf|Inf|INF)|\.(?:nan|NaN|NAN|Nan)",
        list("-+.0123456789"),
    ),
}
for _name, (_form, _first) in _CORE.items():
    _form = f"(?:{_form})\\Z"
    _Plain.add_implicit_resolver(f"tag:yaml.org,2002:{_name}", re.compile(_form), _first)


def _whole(loader: _Plain, node: Any) -> int:
    return int(loader.construct_scalar(node))  # 1.1 would take 010 for 8


def _matrix(loader: _Plain, node: Any) -> dict[Any, Any]:
    return loader.construct_mapping(node, deep=True)


_Plain.add_constructor("tag:yaml.org,2002:int", _whole)
_Plain.add_constructor(OPENCV_MATRIX, _matrix)
