"""``daguerre lenses``: the library."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from . import console
from .flags.groups import option

if TYPE_CHECKING:
    from daguerre.lenses.index import Entry


def lenses(
    words: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="WORD",
            help="Words to search for, such as canon 50 1.2 or 1970s zoom [all lenses].",
            show_default=False,
        ),
    ] = None,
    json: Annotated[bool, option("--json", help="Print a JSON list.")] = False,
) -> int:
    """Lists the lenses of the library, or those that have all words, best match first.

    A word may be a maker, a part of the name, a focal length, a speed, a kind (zoom, macro,
    fisheye, anamorphic, tele, wide), a year or decade, a format, a patent, a designer.
    Columns: name, year, focal length, f-stop, format, source, other names.
    """
    from daguerre.checks import short
    from daguerre.errors import InputError
    from daguerre.lenses.search import find, suggest

    text = " ".join(words or ())
    found = find(text)
    if not found:
        hint = suggest(text) or "; `daguerre lenses` lists all"
        raise InputError(f"lenses: no lens of the library matches {short(text)}{hint}")
    if json:
        _print_json(found)
        return 0
    rows = [
        (
            e.name,
            f"{e.year or ''}",
            e.focal_length,
            f"f/{e.f_number:.3g}",
            e.format,
            e.patent,
            e.also,
        )
        for e in found
    ]
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    for row in rows:
        console.show(
            "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
        )
    return 0


def _print_json(found: list[Entry]) -> None:
    from dataclasses import asdict
    from json import dumps

    from daguerre.lenses.kinds import kinds_of

    rows = [
        {**asdict(e), "source": e.patent, "kinds": [kind.words[0] for kind in kinds_of(e)]}
        for e in found
    ]
    console.show(dumps(rows, indent=2))
