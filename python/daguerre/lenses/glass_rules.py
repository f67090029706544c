"""Dispersion of a glass in a lens file: the first rule that applies, in this order.

1. ``formula``: a table or formula in the file.
2. ``theta_gF``: nd, Vd and theta_gF in the file, by a curve of three terms.
3. ``name``: the catalogue's glass of the name in the file, if its nd agrees.
4. ``numbers``: the one catalogue glass that has the nd and Vd of the file; several count as one if
   their theta_gF agree.
5. ``line``: Schott's normal line, through nd and Vd.

Rules 3 and 4 take the catalogue's dispersion and keep nd and Vd of the file. A name without nd is
the catalogue's glass itself.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

from daguerre.files.json_item import Item

from . import glasses
from .dispersion_rule import DispersionRule
from .glass_formula import formula_of
from .glasses import GlassData, numbers
from .glasses.catalogue import named
from .medium import Medium
from .reading import number

#: Largest difference of nd between a file and the catalogue's glass of the name that it gives.
SAME_ND = 6e-4
#: Values that theta_gF may have.
THETA_RANGE = (0.4, 0.8)
#: Catalogues of the glass makers that supply a lens maker.
SUPPLIERS = {
    "Canon": ("Ohara", "Hoya"),
    "Nikon": ("Hikari",),
    "Nippon Kogaku": ("Hikari",),
    "Olympus": ("Ohara",),
    "Minolta": ("Ohara",),
    "Sigma": ("Hoya", "Ohara"),
    "Tamron": ("Ohara", "Hoya"),
    "Sony": ("Hoya", "Ohara"),
    "Panasonic": ("Hoya", "Ohara"),
    "Fujifilm": ("Hoya", "Ohara"),
    "Carl Zeiss": ("Schott",),
    "Zeiss": ("Schott",),
    "Leica": ("Schott",),
    "Leitz": ("Schott",),
    "Rodenstock": ("Schott",),
    "Schneider": ("Schott",),
}


class Origin(NamedTuple):
    """Facts of a lens by which glasses are chosen.

    Attributes:
        makers: Catalogues to prefer, in order.
        year: Year of the lens; None: unknown.
        keeps_line: Whether glasses that only nd and Vd describe stay on the normal line.
    """

    makers: tuple[str, ...] = ()
    year: int | None = None
    keeps_line: bool = False


#: A lens without known facts.
ANY = Origin()


def suppliers_of(maker: str) -> tuple[str, ...]:
    """Catalogues of the glass makers that supply a lens maker; empty: unknown."""
    return next((found for name, found in SUPPLIERS.items() if maker.startswith(name)), ())


def dispersed(item: Item, label: str, origin: Origin) -> tuple[Medium, DispersionRule]:
    """Chooses the dispersion of a glass that has a formula or an nd; without absorption.

    Args:
        item: The glass in its file.
        label: Its name there; empty: none.
        origin: The lens.

    Raises:
        InputError: A member cannot be used; the message has the file and JSON path.
    """
    formula = formula_of(item)
    if formula is not None:
        return formula[0], DispersionRule("formula")
    nd, vd = item.need("nd").number(1, 5), number(item, "vd", above=0)
    theta = number(item, "theta_gF")
    if vd is None:
        if theta is not None:
            item.need("vd")  # raises: it is missing
            item.need("vd").fail("wanted an Abbe number beside theta_gF, got null")
        return Medium("constant", (nd,)), DispersionRule("constant")
    if vd < 5:
        item.need("vd").fail(f"wanted an Abbe number of at least 5, got {vd:g}")
    if theta is not None:
        theta = item.need("theta_gF").number(*THETA_RANGE)
        return Medium("partial", (nd, vd, theta)), DispersionRule("theta_gF")
    if origin.keeps_line:
        return Medium("abbe", (nd, vd)), DispersionRule("line")
    return _matched(nd, vd, label, origin)


def _matched(nd: float, vd: float, label: str, origin: Origin) -> tuple[Medium, DispersionRule]:
    """Matches a glass by its name, else by its numbers, else takes the normal line."""
    known = glasses.similar(label, nd, SAME_ND, origin.makers) if label else None
    if known is not None:
        return _like(known, nd, vd), DispersionRule("name", known.name, known.maker)
    found = numbers.candidates(nd, vd, origin.year, origin.makers)
    if not found or not numbers.agree(found):
        rule = DispersionRule("line")
        return Medium("abbe", (nd, vd)), _with_note(rule, label, nd, origin)
    near = glasses.find(found[0].name, found[0].maker)
    rule = DispersionRule("numbers", near.name, near.maker)
    return _like(near, nd, vd), _with_note(rule, label, nd, origin)


def _like(glass: GlassData, nd: float, vd: float) -> Medium:
    """Medium of an nd and Vd, with the dispersion of a catalogue's glass and no absorption."""
    return Medium("matched", (replace(glass.core, absorption=()), nd, vd))


def _with_note(rule: DispersionRule, label: str, nd: float, origin: Origin) -> DispersionRule:
    """Adds a note to a glass that its name does not describe; none if it has no name."""
    if not label:
        return rule
    other = named(label, origin.makers)
    why = (
        "is in no catalogue"
        if other is None
        else f"has nd {nd:.5f}, but {other.name} ({other.maker}) {other.nd:.5f}"
    )
    return replace(rule, note=f"{label} {why}, {rule} used")
