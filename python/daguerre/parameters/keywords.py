"""Functions that take rows of a table as keywords: the signatures that people see.

Type checkers read a TypedDict, the type of the function's ``**keywords``; ``help()`` and
``inspect.signature`` get theirs from the table, so that a parameter is written down once.
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


def takes(rows: Rows, keywords: Any) -> Callable[[Function], Function]:
    """Shows the keywords of a TypedDict in the signature and the docstring of a function.

    They stand where the function has ``**keywords``, and where its docstring says ``{keywords}``.

    Args:
        rows: Row of each keyword.
        keywords: The TypedDict; its order is that of the signature.
    """
    types = keywords.__annotations__

    def decorate(function: Function) -> Function:
        signature = inspect.signature(function)
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


def with_rows(text: str | None, rows: Rows, names: Iterable[str]) -> str | None:
    """A docstring with a line of each parameter in the place of ``{keywords}``."""
    if text is None or "{keywords}" not in text:
        return text
    line = next(line for line in text.splitlines() if "{keywords}" in line)
    indent = line[: len(line) - len(line.lstrip())]
    return text.replace(line, attributes(rows, names, indent).rstrip("\n"))
