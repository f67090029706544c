"""Tables of pages from tables of parameters."""

from __future__ import annotations

from daguerre.parameters.parameter import Parameter, fill
from daguerre.parameters.table import Table

#: Page with the tables.
PAGE = "cli.md"
HEAD = "| flag | unit | meaning |\n|---|---|---|"


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
