"""Texts from tables of parameters: attributes of docstrings, and tables of pages."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Mapping

from .parameter import Parameter, fill
from .table import Table

#: Line length of docstrings.
WIDTH = 100
#: Page with the tables.
PAGE = "cli.md"
HEAD = "| flag | unit | meaning |\n|---|---|---|"


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


def page_table(table: Table, names: Table) -> str:
    """Makes a table of flags for a page: names, unit and meaning.

    Args:
        table: Rows of the flags.
        names: Table of the parameters that texts refer to.
    """
    return "\n".join([HEAD, *(_line(row, names) for row in table.flagged)])


def _line(row: Parameter, names: Table) -> str:
    flags = [part for flag in row.flags for part in flag.split("/")]
    if row.placeholder:
        flags[-1] += " " + row.placeholder.replace("|", "\\|")
    shown = ", ".join(f"`{flag}`" for flag in flags)
    text = row.help(lambda name: f"`{names.flag(name)}`")
    more = " " + fill(row.more, lambda name: f"`{names.flag(name)}`") + "." if row.more else ""
    links = f" ({', '.join(map(_link, row.explained))})" if row.explained else ""
    meaning = (text + more).removesuffix(".")
    return f"| {shown} | {row.unit} | {meaning}{links} |"


def _link(place: str) -> str:
    """Makes a link to a page or a section, with its name as text."""
    page, _, part = place.partition("#")
    own = page == PAGE
    name = part if own else page.removesuffix(".md")
    return f"[{name.replace('-', ' ')}]({'#' + part if own else place})"


def marked(name: str) -> tuple[str, str]:
    """Marks in a page between which a table is written."""
    return f"<!-- {name}: by script/docs/make-cli-reference -->", f"<!-- end of {name} -->"


def put_between_marks(page: str, name: str, text: str) -> str:
    """Returns the page with the text between the marks of this name.

    Raises:
        ValueError: The page has no such marks.
    """
    begin, end = marked(name)
    before, found, rest = page.partition(begin)
    _, closed, after = rest.partition(end)
    if not found or not closed:
        raise ValueError(f"the page wants the marks {begin} and {end}")
    return f"{before}{begin}\n\n{text}\n\n{end}{after}"
