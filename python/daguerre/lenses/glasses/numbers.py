"""Glasses by their numbers: the catalogue glass that has an nd and Vd."""

from __future__ import annotations

import json
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import NamedTuple

from .catalogue import LINE_C, LINE_F, GlassData

FILE = Path(__file__).parent / "numbers.json"
#: Mercury line g, nm.
LINE_G = 435.8343
#: A glass is a candidate if its nd and Vd differ by less.
NEAR_ND, NEAR_VD = 2.5e-4, 0.25
#: Candidates count as one glass if their P_gF differ by less.
SAME_P = 0.003
#: Lenses from before the first year have glass with lead, lenses from the second year on have none.
LEAD_UNTIL, FREE_FROM = 1990, 2000
#: Prefixes of types without lead. Hoya marks its flints alone, LZOS has none of them.
_FREE = {
    "Schott": ("N-", "P-"),
    "Ohara": ("S-", "L-", "TIH", "TIM", "TIL"),
    "Hoya": ("E-",),
    "Hikari": ("J-", "Q-", "E-"),
    "CDGM": ("H-", "D-"),
    "Sumita": ("K-",),
}
_UNMARKED = ("Hoya", "Corning", "materials")
#: Makers of tables with rounded indices: curves through them are less smooth than formulas.
TABLES = ("LZOS",)


class Listed(NamedTuple):
    """Numbers of one glass of the catalogues."""

    maker: str
    name: str
    nd: float
    vd: float
    p_gf: float

    def fits(self, year: int | None) -> bool:
        """Whether lenses of a year may have this type: lead was given up between 1990 and 2000."""
        free = self.name.startswith(_FREE.get(self.maker, ()))
        if year is None or LEAD_UNTIL <= year < FREE_FROM or (self.maker in _UNMARKED and not free):
            return True
        return free == (year >= FREE_FROM)


def partial_dispersion(glass: GlassData) -> float | None:
    """P_gF = (ng - nF) / (nF - nC), which patents call theta_gF; None: no dispersion."""
    n_f, n_c = glass.core.index(LINE_F), glass.core.index(LINE_C)
    return (glass.core.index(LINE_G) - n_f) / (n_f - n_c) if n_f > n_c else None


@cache
def listed() -> tuple[Listed, ...]:
    """All glasses of the catalogues."""
    return tuple(Listed(*row) for row in json.loads(FILE.read_text("utf-8")))


def candidates(
    nd: float, vd: float, year: int | None = None, makers: Sequence[str] = ()
) -> list[Listed]:
    """Glasses with an nd and Vd: the makers' first, formulas before tables, then the nearest.

    If they differ, types of another time are left out if others remain, then other makers'.

    Args:
        nd: Index at 587.56 nm.
        vd: Abbe number.
        year: Year of the lens.
        makers: Makers that supply the lens's maker.
    """
    found = [g for g in listed() if abs(g.nd - nd) <= NEAR_ND and abs(g.vd - vd) <= NEAR_VD]
    if not agree(found):
        found = [g for g in found if g.fits(year)] or found
    if not agree(found):
        found = [g for g in found if g.maker in makers] or found

    def order(g: Listed) -> tuple[bool, bool, bool, float]:
        off = abs(g.nd - nd) / NEAR_ND + abs(g.vd - vd) / NEAR_VD
        return g.maker not in makers, g.maker in TABLES, not g.fits(year), off

    return sorted(found, key=order)


def agree(found: Sequence[Listed]) -> bool:
    """Whether glasses count as the same: their blue dispersion is about equal."""
    return not found or max(g.p_gf for g in found) - min(g.p_gf for g in found) <= SAME_P
