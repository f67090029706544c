"""Signatures of functions with the rows of a table as keywords.

Type checkers read a TypedDict, the type of the function's ``**keywords``. ``help()`` and
``inspect.signature`` use the table, so that each parameter is declared once.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable, Mapping
from typing import Any, TypeVar

from .parameter import Parameter
from .table import Table
from .texts import attributes

Function = TypeVar("Function", bound=Callable[..., Any])
Rows = Table | Mapping[str, Parameter]


def takes(rows: Rows, keywords: object) -> Callable[[Function], Function]:
    """Puts the keywords of a TypedDict into the signature and the docstring of a function.

    They replace ``**keywords`` in the signature and ``{keywords}`` in the docstring.

    Args:
        rows: Rows of the keywords.
        keywords: The TypedDict, in the order of the signature.
    """
    types = keywords.__annotations__

    def decorate(function: Function) -> Function:
        signature = _signature(function)
        own = [p for p in signature.parameters.values() if p.kind is not p.VAR_KEYWORD]
        made = [
            inspect.Parameter(
                name, inspect.Parameter.KEYWORD_ONLY,
                default=rows[name].default, annotation=kind.__forward_arg__,
            )
            for name, kind in types.items()
        ]  # fmt: skip
        shown = signature.replace(parameters=[*own, *made])
        function.__signature__ = shown  # type: ignore[attr-defined]
        function.__doc__ = with_rows(function.__doc__, rows, types)
        return function

    return decorate


def _signature(function: Callable[..., Any]) -> inspect.Signature:
    """Signature of a function, or of a class without those that its bases show."""
    if not isinstance(function, type):
        return inspect.signature(function)
    own = inspect.signature(function.__init__)  # type: ignore[misc]
    return own.replace(parameters=list(own.parameters.values())[1:])


def with_rows(text: str | None, rows: Rows, names: Iterable[str]) -> str | None:
    """Replaces ``{keywords}`` in a docstring by a line for each parameter."""
    if text is None or "{keywords}" not in text:
        return text
    line = next(line for line in text.splitlines() if "{keywords}" in line)
    indent = line[: len(line) - len(line.lstrip())]
    return text.replace(line, attributes(rows, names, indent).rstrip("\n"))
