"""Values of flags, made from the words of a command line.

Typer lets pydantic make them, which costs 0.1 s at every start: its import, and a validator for
each flag, given or not.
"""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any, get_args, get_origin

import typer

#: Types of values with their names in messages; Typer converts other types.
_TYPES = {bool: "a flag", str: "a text", int: "a whole number", float: "a number", Path: "a path"}


class OwnValues:
    """Commands that make the values of their flags and arguments themselves."""

    def get_params(self, ctx: object) -> list[Any]:
        """Returns the flags and arguments."""
        found: list[Any] = super().get_params(ctx)  # type: ignore[misc]
        for one in found:
            kind = getattr(one, "type_descriptor", None)  # older releases do without pydantic
            if kind is not None and (made := _type(kind.annotation)) in _TYPES:
                one.get_runtime_param = partial(_Value, made)
        return found


def _type(annotation: object) -> Any:
    """The type of a value, or of each value of a list."""
    return get_args(annotation)[0] if get_origin(annotation) is list else annotation


class _Value:
    """Makes the value of a flag; stands in for Typer's own class."""

    def __init__(self, made: type) -> None:
        self.type = made

    def coerce(self, words: Any, param: Any, ctx: Any) -> Any:
        """Makes the value of words of the command line, or of a default."""
        try:
            if param.multiple or param.nargs == -1:
                return [self.type(word) for word in words or ()]
            return None if words is None else self.type(words)
        except ValueError:
            wanted = f"wanted {_TYPES[self.type]}, got {words!r}"
            raise typer.BadParameter(wanted, ctx=ctx, param=param) from None
