"""The page of thumbnails: each opens its picture, with the command under it."""

from __future__ import annotations

import re
from pathlib import Path

#: of a thumbnail, px
WIDTH = 230
#: Pages of the gallery, in the order of their thumbnails.
SHEETS = (
    ("Pictures", "README.md"),
    ("Imperfections, three ways", "imperfections.md"),
    ("From exposure to photograph", "exposure.md"),
    ("Calibrated cameras", "calibrated.md"),
    ("Into the plate", "plates.md"),
)
HEAD = """# Thumbnails

Click a thumbnail to open its picture, with the command that rendered it and the program that writes
its scene.
"""
_PLACE = re.compile(r'<a id="([^"]+)"></a>|^## (.+)$|^!\[([^\]]*)\]\(([\w.]+\.jpg)\)', re.MULTILINE)


def page(folder: Path) -> str:
    """The page, of the pages that are in the folder of the gallery."""
    parts = [HEAD]
    for title, name in SHEETS:
        parts += [f"## {title}\n", *thumbnails(name, (folder / name).read_text("utf-8")), ""]
    return "\n".join(parts)


def thumbnails(name: str, text: str) -> list[str]:
    """Each picture of a page, leading to its place there; in one paragraph, which wraps."""
    found = []
    place = ""
    for anchor, heading, alt, file in _PLACE.findall(text):
        if not file:
            place = anchor or slug(heading)
            continue
        words = alt.replace('"', "&quot;")
        shown = f'<img src="gallery/{file}" width="{WIDTH}" loading="lazy" alt="{words}">'
        found.append(f"[{shown}](gallery/{name}#{place})")
    return found


def brief(title: str) -> str:
    """The first words of a caption: the text of a picture whose whole caption follows it."""
    return re.split(r"(?<=\w)(?:[:;]|\. |\.$)", title, maxsplit=1)[0]


def slug(heading: str) -> str:
    """The anchor of a heading, as forges and the manual make it."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-")
