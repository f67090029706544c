"""The text of docs/lens-library.md."""

from __future__ import annotations

from pathlib import Path

from daguerre.lenses.library import Entry

DOCS = Path(__file__).resolve().parents[3] / "docs"
PICTURES = DOCS / "lenses"
#: The program shows the same photographs, so its package has them.
PHOTOGRAPHS_FROM_DOCS = "../python/daguerre/lenses/library/photographs"

HEAD = Path(__file__).with_name("head.md")


def text(entries: tuple[Entry, ...]) -> str:
    """The page: introduction, then families, with an entry for each lens."""
    years = [entry.year for entry in entries if entry.year]
    head = HEAD.read_text("utf-8")
    parts = [head.format(count=len(entries), first=min(years), last=max(years))]
    families: dict[str, list[Entry]] = {}
    for entry in entries:
        families.setdefault(_family(entry), []).append(entry)
    for family, members in sorted(families.items(), key=lambda item: item[0].lower()):
        parts += [f"## {family[0].upper()}{family[1:]}\n", *map(_section, members)]
    return "\n".join(parts)


def _family(entry: Entry) -> str:
    """Zooms, fisheyes and soft-focus lenses by what they do; others by their form."""
    for word in ("zoom", "fisheye", "anamorphic", "soft focus", "macro"):
        if word in entry.type:
            return word
    return entry.type.split(",")[0].split(" (")[0].strip()


def _section(entry: Entry) -> str:
    year = f" ({entry.year})" if entry.year else ""
    also = f" (also {entry.also})" if entry.also else ""
    film = f", film {entry.format.replace('x', ' x ')} mm" if entry.format else ""
    remark = f" {entry.remark[0].upper()}{entry.remark[1:]}." if entry.remark else ""
    pictures = " ".join(
        f"![{what}]({folder}/{entry.name}.{suffix})"
        for folder, suffix, what in (
            ("lenses/drawings", "svg", "Section"),
            (PHOTOGRAPHS_FROM_DOCS, "webp", "Photograph"),
        )
        if (DOCS / folder / f"{entry.name}.{suffix}").exists()
    )
    return (
        f"### {entry.name}\n\n**{entry.title}**{year}{also}{_kinds(entry)}{film}. "
        f"{_numbers(entry)}. {entry.patent}.{remark}{_sheet(entry)}\n\n{pictures}\n"
    )


def _kinds(entry: Entry) -> str:
    """The kinds of the lens that the heading of its family does not say."""
    first, *rest = entry.type.split(", ")
    said = [] if first.lower() == _family(entry).lower() else [first]
    return "".join(f", {kind}" for kind in [*said, *rest])


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
