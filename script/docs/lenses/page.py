"""The text of docs/lens-catalogue.md."""

from __future__ import annotations

from pathlib import Path

from daguerre.lenses.library import Entry

PICTURES = Path(__file__).resolve().parents[3] / "docs" / "lenses"

INTRODUCTION = """# Lens catalogue

The {count} lenses that ship with Daguerre, each with its drawing, its source and one photograph of
the same scene. Use one by its name: `daguerre render SCENE --lens NAME`, `daguerre lens NAME`.
Numbers of a lens are facts, written down from the patent or book that is named. What the table of a
lens computes to (at 587.56 nm, focused at infinity, a zoom's back focus and f-number at its
shortest) stands first, and in brackets what the source claims; [lens-library.md](lens-library.md)
has it all in one table.

This page is built by one command, `script/docs/make-lens-catalogue`, with drawings,
photographs, and the data sheets of all lenses.
"""

PHOTOGRAPHS = """## The photographs

All show the arcade of [scenes/lens_scenes.py](../scenes/lens_scenes.py) through the lens wide
open, a zoom in the middle of its range, on the film that the lens was made for. The camera steps
back until the plane of the head, the chart and the white frame is half a metre high in the picture,
so the subject keeps its size and what differs is the lens: the discs of the lanterns (their size,
their edge, their cut toward the corners), the straightness of frame and columns, the darkening of
the corners, what happens to the fine lines of the chart. Very short lenses stop at 0.3 m, large
films at ten focal lengths. An anamorphic picture is stretched back.
"""


def text(entries: tuple[Entry, ...]) -> str:
    """The page: introduction, contents by family, a section for each lens."""
    parts = [INTRODUCTION.format(count=len(entries)), PHOTOGRAPHS, _contents(entries)]
    return "\n".join([*parts, *map(_section, entries)])


def _contents(entries: tuple[Entry, ...]) -> str:
    """Names by the first word of their kind of design."""
    families: dict[str, list[Entry]] = {}
    for entry in entries:
        families.setdefault(_family(entry), []).append(entry)
    lines = []
    for family, members in sorted(families.items(), key=lambda item: item[0].lower()):
        links = ", ".join(f"[{entry.title}](#{entry.name.replace('.', '')})" for entry in members)
        lines.append(f"- **{family}**: {links}")
    return "## Contents\n\n" + "\n".join(lines) + "\n"


def _family(entry: Entry) -> str:
    """Zooms, fisheyes and soft-focus lenses by what they do; others by their form."""
    for word in ("zoom", "fisheye", "anamorphic", "soft focus", "macro"):
        if word in entry.type:
            return word
    return entry.type.split(",")[0].split(" (")[0].strip()


def _section(entry: Entry) -> str:
    year = f" ({entry.year})" if entry.year else ""
    film = f", film {entry.format.replace('x', ' x ')} mm" if entry.format else ""
    pictures = " ".join(
        f'<img src="lenses/{folder}/{entry.name}.{suffix}" alt="{what} {entry.title}">'
        for folder, suffix, what in (
            ("drawings", "svg", "Section of the"),
            ("photographs", "jpg", "Photograph by the"),
        )
        if (PICTURES / folder / f"{entry.name}.{suffix}").exists()
    )
    return (
        f"### {entry.name}\n\n**{entry.title}**{year}, {entry.type}{film}. {_numbers(entry)}. "
        f"{entry.patent}.{_sheet(entry)}\n\n{pictures}\n"
    )


def _numbers(entry: Entry) -> str:
    """Computed and, in brackets, stated."""
    focal = _compared(entry.efl_mm, entry.efl_stated)
    if entry.efl_long_mm is not None:
        focal += " to " + _compared(entry.efl_long_mm, entry.efl_long_stated)
    back = _compared(entry.bfl_mm, entry.bfl_stated)
    return (
        f"Focal length {focal} mm, back focus {back} mm, "
        f"f/{_compared(entry.f_number, entry.f_stated)}"
    )


def _compared(computed: float, stated: float | None) -> str:
    return f"{computed:g}" + (f" [{stated:.6g}]" if stated is not None else "")


def _sheet(entry: Entry) -> str:
    """The link, if the sheet is in the docs."""
    found = next((PICTURES / "sheets").glob(f"{entry.name}.*"), None)
    return f" [Data sheet](lenses/sheets/{found.name})." if found else ""
