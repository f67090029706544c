"""Attributes of docstrings from tables of parameters."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Mapping

from .parameter import Parameter, fill
from .table import Table

#: Line length of docstrings.
WIDTH = 100


def attributes(
    table: Table | Mapping[str, Parameter], names: Iterable[str], indent: str = " " * 8
) -> str:
    """Makes the attributes of a docstring, in the order of ``names``."""
    return "".join(_attribute(table[name], indent) for name in names)


def _attribute(row: Parameter, indent: str) -> str:
    text = f"{row.name}: {row.in_python or _described(row)}"
    further = indent + "    "
    lines = textwrap.wrap(text, WIDTH, initial_indent=indent, subsequent_indent=further)
    return "\n".join(lines) + "\n"


def _described(row: Parameter) -> str:
    meaning = row.meaning
    if row.kind == "choice":
        meaning += f": {', '.join(row.choices[:-1])} or {row.choices[-1]}"
    default = f"; default: {row.default_shown}" if row.default_shown else ""
    more = f" {row.more}." if row.more else ""
    text = fill(f"{meaning}{default}.{more}", lambda name: f"`{name}`")
    return re.sub("`+", "``", text)
