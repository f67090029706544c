"""Reads lens files of pbrt: a row per surface, front to rear: radius, thickness, index, diameter.

Lengths in mm. The row of radius 0 is the stop; an index of 0 is air; ``#`` begins a comment. pbrt
has no planes: radius 0 where the medium changes is read as a plane.
In an older layout (Stanford CS348b), thicknesses are in front of their surfaces; the first is 0.
Sources: pbrt-v4's user's guide, "realistic" camera; the comments in the files that come with pbrt.
"""

from __future__ import annotations

import re
from typing import Any

from .assemble import Configuration, lens_file
from .draft import Draft
from .text import Line, Unread, lines_of, number


def parse(text: str, where: str) -> tuple[dict[str, Any], list[str]]:
    """Converts a pbrt lens file to ``daguerre-lens/0.1``, with notes on ignored content.

    Raises:
        LensError: The file cannot be read; the message has the line.
    """
    rows, comments, efl = _rows(text, where)
    unread = Unread()
    drafts = [Draft(0, thickness=float("inf"))]
    for i, row in enumerate(rows, 1):
        drafts.append(_surface(row, i, drafts[-1]))
        if drafts[-1].curvature == 0 and not drafts[-1].stop:
            unread.add(
                "radius 0 where the index changes is read as a plane, not the stop", f"surface {i}"
            )
    if drafts[1].thickness == 0 and drafts[-1].thickness > 0 and drafts[1].glass is not None:
        unread.add("thicknesses are read as standing before their surfaces, as the first is 0")
        for i, draft in enumerate(drafts[1:-1], 1):
            draft.thickness = drafts[i + 1].thickness
        drafts[-1].thickness = 0
    unread.add("indices have no dispersion, so the lens has no chromatic aberration")
    drafts.append(Draft(len(rows) + 1))
    nominal = {} if efl is None else {"efl_mm": efl}
    title = next((c for c in comments if c), "") or "pbrt lens"
    note = {"note": "; ".join(comments)[:1000]} if comments else {}
    configurations = [Configuration("infinity")]
    data = lens_file(where, title, drafts, configurations, unread, nominal, **note)
    return data, unread.notes()


def looks_like(text: str) -> bool:
    """Whether a text has only rows of four numbers, and comments."""
    rows = [row.split("#", 1)[0].split() for row in text[:20_000].splitlines()[:-1] or [text]]
    rows = [row for row in rows if row]
    return any(len(row) == 4 for row in rows) and all(
        len(row) in (1, 4) and all(number(word) is not None for word in row) for row in rows
    )


def _rows(text: str, where: str) -> tuple[list[Line], list[str], float | None]:
    rows: list[Line] = []
    comments: list[str] = []
    efl = None
    for i, content in enumerate(lines_of(text, where), 1):
        numbers, _, comment = content.partition("#")
        if comment.strip(' "\t'):
            comments.append(re.sub(r"\s+", " ", comment).strip(' "'))
        line = Line(where, i, tuple(numbers.replace(",", " ").split()))
        if len(line.words) == 1 and not rows:  # the focal length, in files of ISET
            efl = line.to_number(line.words[0], "focal length", 1e-6)
        elif line.words:
            if len(line.words) != 4:
                line.fail(
                    "wanted 4 numbers (radius, thickness, index, diameter), "
                    f"got {len(line.words)} words"
                )
            rows.append(line)
    if not rows:
        Line(where, 1, ()).fail("no surfaces: wanted rows of radius, thickness, index, diameter")
    return rows, comments, efl


def _surface(row: Line, index: int, before: Draft) -> Draft:
    radius, thickness, n, diameter = (
        row.to_number(word, what)
        for word, what in zip(row.words, ("radius", "thickness", "index", "diameter"), strict=True)
    )
    if n != 0 and not 1 <= n <= 5:
        row.fail(
            f"index: out of range: wanted 1 .. 5, or 0 for air, got {n:g}", "lens-glass", index
        )
    if diameter < 0:
        row.fail(f"diameter: out of range: wanted at least 0, got {diameter:g}", surface=index)
    glass = None if n in (0, 1) else {"nd": n}
    return Draft(
        index,
        thickness=thickness,
        curvature=1 / radius if radius else 0.0,
        glass=glass,
        semi_diameter=diameter / 2 or None,
        stop=radius == 0 and glass == before.glass,
    )
