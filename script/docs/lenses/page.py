"""The text of docs/lens-catalogue.md."""

from __future__ import annotations

from pathlib import Path

from daguerre.lenses.library import Entry

DOCS = Path(__file__).resolve().parents[3] / "docs"
PICTURES = DOCS / "lenses"
#: The program shows the same photographs, so its package has them.
PHOTOGRAPHS_FROM_DOCS = "../python/daguerre/lenses/library/photographs"

INTRODUCTION = """# Lens catalogue

Choose one of the {count} lenses that ship with Daguerre: each has its drawing and a photograph of
the same scene. Use a lens by its name:

```
daguerre lens double-gauss-50mm-f2
daguerre render scene.glb --lens double-gauss-50mm-f2 -o out.exr
```

Each entry names the patent or book of its prescription. Numbers are computed from the lens's
table at 587.56 nm, focused at infinity; the source's own values are in brackets. The back focus
and f-number of a zoom are those of its shortest focal length. [Lens library](lens-library.md)
has all lenses in one table; `daguerre lenses zeiss wide`
[finds lenses](lens-library.md#find-a-lens) by such words.

`script/docs/make-lens-catalogue` builds this page with its drawings and photographs, and the data
sheets of all lenses.
"""

PHOTOGRAPHS = """## The photographs

All photographs show the arcade of [scenes/lens_scenes.py](../scenes/lens_scenes.py) through the
lens wide open, a zoom in the middle of its range, on the film that the lens was made for. The
camera stands so that the plane of the head, the chart and the white frame is half a metre high in
the picture. The subject therefore keeps its size, and the differences come from the lens: the
discs of the lanterns (their size, their edge, their cut toward the corners), the straightness of
frame and columns, the darkening of the corners, the fine lines of the chart. Very short lenses
come no closer than 0.3 m, large films no closer than ten focal lengths. Anamorphic pictures are
stretched back.
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
        f'<img src="{folder}/{entry.name}.{suffix}" alt="{what} {entry.title}">'
        for folder, suffix, what in (
            ("lenses/drawings", "svg", "Section of the"),
            (PHOTOGRAPHS_FROM_DOCS, "webp", "Photograph by the"),
        )
        if (DOCS / folder / f"{entry.name}.{suffix}").exists()
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
