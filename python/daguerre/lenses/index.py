"""Index of the library of lenses that ship with Daguerre.

``library/sources.csv`` has one row for each lens: its source, stated values and computed values.
Listing and searching therefore parse no lens file.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass
from functools import cache
from pathlib import Path

FOLDER = Path(__file__).parent / "library"
#: A picture of the same scene through each lens, as NAME.webp.
PHOTOGRAPHS = FOLDER / "photographs"


@dataclass(frozen=True)
class Entry:
    """One lens in the index of the library. Lengths in mm; computed unless "stated".

    Attributes:
        name: Name by which it is loaded.
        title: Full name of the lens.
        maker: Maker; empty if unknown.
        year: Year of product or patent.
        patent: Patent, with the example, or book.
        format: Film or sensor, mm x mm; empty if unknown.
        type: Design type.
        efl_mm: Focal length; for a zoom the shortest.
        efl_long_mm: Longest focal length of a zoom; None: not a zoom.
        f_number: F-number wide open; for a zoom at its shortest focal length.
        bfl_mm: Last vertex to paraxial focus; for a zoom at its shortest focal length.
        efl_stated: Focal length that the source states; None: not stated.
        efl_long_stated: Longest focal length that the source states.
        f_stated: F-number that the source states.
        bfl_stated: Back focal length that the source states.
        remark: Reason why a stated value is not compared.
        designer: Designers, as the lens file names them.
        also: Other names that a search finds it by: a second maker, a copy, the name of its form.
    """

    name: str
    title: str
    maker: str
    year: int | None
    patent: str
    format: str
    type: str
    efl_mm: float
    efl_long_mm: float | None
    f_number: float
    bfl_mm: float
    efl_stated: float | None
    efl_long_stated: float | None
    f_stated: float | None
    bfl_stated: float | None
    remark: str
    designer: str
    also: str

    @property
    def focal_length(self) -> str:
        """Focal length as text, such as ``50 mm`` or ``71.5-196 mm``."""
        ends = [self.efl_mm] if self.efl_long_mm is None else [self.efl_mm, self.efl_long_mm]
        return "-".join(f"{end:.3g}" if end < 999 else f"{end:.0f}" for end in ends) + " mm"


@cache
def entries() -> tuple[Entry, ...]:
    """Returns the index of the library, sorted by name."""
    with (FOLDER / "sources.csv").open(encoding="utf-8", newline="") as file:
        return tuple(_entry(row) for row in csv.DictReader(file))


def names() -> list[str]:
    """Returns the names of the library's lenses, sorted."""
    return [entry.name for entry in entries()]


def _entry(row: dict[str, str]) -> Entry:
    def number(key: str) -> float | None:
        return float(row[key]) if row[key] else None

    return Entry(
        name=row["name"],
        title=row["title"],
        maker=row["maker"],
        year=int(row["year"]) if row["year"] else None,
        patent=row["patent"],
        format=row["format"],
        type=row["type"],
        efl_mm=float(row["efl_mm"]),
        efl_long_mm=number("efl_long_mm"),
        f_number=float(row["f_number"]),
        bfl_mm=float(row["bfl_mm"]),
        efl_stated=number("efl_stated"),
        efl_long_stated=number("efl_long_stated"),
        f_stated=number("f_stated"),
        bfl_stated=number("bfl_stated"),
        remark=row["remark"],
        designer=row["designer"],
        also=row["also"],
    )
