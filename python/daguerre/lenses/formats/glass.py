"""Resolves glasses of imported files: by catalogue name, by code, or by nd and Vd."""

from __future__ import annotations

import re
from typing import Any

from daguerre.files.json_item import clean
from daguerre.lenses.glass_rules import THETA_RANGE

from .catalogue import find, known_maker, missing
from .text import Line, Unread

Glass = dict[str, Any]


def model(
    line: Line,
    surface: int,
    nd: float,
    vd: float,
    name: str = "",
    maker: str = "",
    deviation: float = 0,
) -> Glass | None:
    """Makes a glass from nd and Vd; Vd 0: no dispersion, nd 1: air.

    Args:
        line: Line of the file.
        surface: Number of the surface.
        nd: Index at 587.56 nm.
        vd: Abbe number.
        name: Name in the file.
        maker: Maker in the file; a maker without a catalogue is dropped.
        deviation: theta_gF less the value of Schott's normal line; 0: not known.
    """
    if nd == 1:
        return None
    if not 1 <= nd <= 5:
        line.fail(f"glass: nd: out of range: wanted 1 .. 5, got {nd:g}", "lens-glass", surface)
    if vd != 0 and not 5 <= vd <= 1000:
        line.fail(f"glass: Vd: out of range: wanted 5 .. 1000, got {vd:g}", "lens-glass", surface)
    out: Glass = {"nd": nd}
    if vd:
        out["vd"] = vd
    if name:
        out["name"] = name
    if name and vd and (known := known_maker(maker)):
        out["maker"] = known
    if vd and deviation:
        out["theta_gF"] = _theta(line, surface, vd, deviation)
    return out


def _theta(line: Line, surface: int, vd: float, deviation: float) -> float:
    theta = 0.6438 - 0.001682 * vd + deviation  # normal line: Schott, TIE-29
    least, most = THETA_RANGE
    if not least <= theta <= most:
        what = f"glass: dPgF: theta_gF out of range: wanted {least} .. {most}, got {theta:g}"
        line.fail(what, "lens-glass", surface)
    return theta


def coded(word: str) -> tuple[float, float] | None:
    """Nd and Vd of a glass code such as ``517642`` or ``517000.642000``, or None.

    The digits before the point are the decimals of nd - 1; those after it are Vd, with two digits
    before Vd's own point. CODE V writes fictitious glasses so; the military code has no point.
    """
    if re.fullmatch(r"\d{6}", word):
        return 1 + int(word[:3]) / 1000, int(word[3:]) / 10
    match = re.fullmatch(r"(\d{3,12})\.(\d{2,12})", word)
    if match is None:
        return None
    n, v = match.groups()
    return 1 + int(n) / 10 ** len(n), int(v) / 10 ** (len(v) - 2)


def named(
    line: Line,
    surface: int,
    name: str,
    unread: Unread,
    embedded: tuple[float, float] | None = None,
    makers: tuple[str, ...] = (),
) -> Glass | None:
    """Finds a glass by name in the catalogues, else by its code, else by the file's nd and Vd."""
    name = clean(name)[:60]
    if name.upper() in ("AIR", "VACUUM"):
        return None
    found = find(name, makers)
    if found is not None:
        glass, instead = found
        if instead:
            unread.add(f"glass {instead}", f"surface {surface}")
        return glass
    numbers = coded(name)
    if numbers is not None:
        return model(line, surface, *numbers)
    if embedded is not None:
        return model(line, surface, *embedded, name)
    line.fail(f"glass: {missing(name)}", "lens-glass", surface)
