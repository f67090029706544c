"""Small HTML tables, by which values show themselves in notebooks."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

_LEFT = 'style="text-align: left"'


def shown_numbers(numbers: Iterable[float]) -> str:
    """Makes a text of a vector, to four digits; no -0."""
    return f"({', '.join(f'{number + 0.0:.4g}' for number in numbers)})"


def html_table(caption: str, rows: Mapping[str, str]) -> str:
    """Makes a table of names and values; texts are escaped."""
    import html  # not at every start of the program

    cells = "".join(
        f"<tr><th {_LEFT}>{html.escape(name)}</th><td {_LEFT}>{html.escape(text)}</td></tr>"
        for name, text in rows.items()
    )
    return f"<table><caption>{html.escape(caption)}</caption>{cells}</table>"
