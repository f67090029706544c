"""``daguerre lenses``: the library."""

from __future__ import annotations

from typing import Annotated

from . import console
from .flags.groups import option


def lenses(json: Annotated[bool, option("--json", help="Print a JSON list.")] = False) -> int:
    """Lists the lenses of the library.

    Columns: name, year, focal length, f-stop, format, source.
    """
    from dataclasses import asdict
    from json import dumps

    from daguerre.lenses.library import entries

    if json:
        console.show(dumps([{**asdict(e), "source": e.patent} for e in entries()], indent=2))
        return 0
    rows = [
        (e.name, f"{e.year or ''}", e.focal_length, f"f/{e.f_number:.3g}", e.format, e.patent)
        for e in entries()
    ]
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    for row in rows:
        console.show(
            "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
        )
    return 0
