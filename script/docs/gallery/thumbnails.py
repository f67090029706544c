"""The page of thumbnails: each opens its picture, with the command under it."""

from __future__ import annotations

import re
from pathlib import Path

COLUMNS = 3
#: Pages of the gallery, in the order of their thumbnails.
SHEETS = (
    ("Pictures", "README.md"),
    ("Imperfections, three ways", "imperfections.md"),
    ("From exposure to photograph", "exposure.md"),
    ("Calibrated cameras", "calibrated.md"),
    ("Into the plate", "plates.md"),
)
HEAD = """# Thumbnails

A thumbnail opens its picture. Under the picture stand the command that made it, to copy and
change, and the program that makes its scene.
"""
_PLACE = re.compile(r'<a id="([^"]+)"></a>|^## (.+)$|^!\[([^\]]*)\]\(([\w.]+\.jpg)\)', re.MULTILINE)


def page(folder: Path) -> str:
    """The page, of the pages that are in the folder of the gallery."""
    parts = [HEAD]
    for title, name in SHEETS:
        cells = thumbnails(name, (folder / name).read_text("utf-8"))
        parts += [f"## {title}\n", *rows(cells), ""]
    return "\n".join(parts)


def thumbnails(name: str, text: str) -> list[str]:
    """A cell for each picture of a page, which leads to its place there."""
    cells = []
    place = ""
    for anchor, heading, alt, file in _PLACE.findall(text):
        if not file:
            place = anchor or slug(heading)
            continue
        shown = (
            f'<img src="gallery/{file}" width="260" loading="lazy" alt="{alt.replace("|", ",")}">'
        )
        words = Path(file).stem.replace("_", " ")
        cells.append(f"[{shown}](gallery/{name}#{place})<br>{words}")
    return cells


def rows(cells: list[str]) -> list[str]:
    """The cells as a table."""
    cells = [*cells, *[""] * (-len(cells) % COLUMNS)]
    lines = [f"| {' | '.join(cells[k : k + COLUMNS])} |" for k in range(0, len(cells), COLUMNS)]
    return [f"|{' |' * COLUMNS}", f"|{'---|' * COLUMNS}", *lines]


def slug(heading: str) -> str:
    """The anchor of a heading, as forges and the manual make it."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-")
