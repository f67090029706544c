"""Reads a glass of a lens file: ``{nd, vd, name}``, ``{name}``, ``{table}``, ``{sellmeier}`` ..."""

from __future__ import annotations

from typing import NamedTuple

from daguerre.files.json_item import Item

from . import glasses
from .dispersion_rule import DispersionRule
from .errors import LensError
from .glass_formula import FORMULAS, absorption_of
from .glass_rules import ANY, SAME_ND, Origin, dispersed
from .glasses.catalogue import LINE_D, maker_of
from .medium import AIR, Medium
from .reading import member, number, text


class ReadGlass(NamedTuple):
    """A glass of a lens file.

    Attributes:
        medium: Index and absorption.
        label: Its name, or nd/Vd; empty: air.
        rule: Rule that gave its dispersion; None: air.
    """

    medium: Medium
    label: str
    rule: DispersionRule | None


def glass_from_json(item: Item | None, origin: Origin = ANY) -> ReadGlass:
    """Reads a glass. None and null are air.

    ``glass_rules`` gives it its dispersion; a name without numbers is looked up in the makers'
    catalogues. Absorption comes from ``internal_transmittance``, else from the catalogue's glass of
    this name if its nd agrees within ``SAME_ND``.

    Args:
        item: The glass in its file.
        origin: The lens.

    Raises:
        InputError: A member cannot be used; the message has the file and JSON path. LensError
            (lens-glass): no catalogue has the name.
    """
    if item is None or item.value is None:
        return ReadGlass(AIR, "", None)
    label, maker = text(item, "name") or "", text(item, "maker")
    formula = next((name for name in FORMULAS if member(item, name)), None)
    if label and formula is None and member(item, "nd") is None:
        return _of_catalogue(item, label, maker, origin)
    if maker is not None:
        origin = origin._replace(makers=(maker_of(label, maker), *origin.makers))
    glass, rule = dispersed(item, label, origin)
    default = formula or _numbers(item)
    return ReadGlass(_with_absorption(item, glass, label, origin), label or default, rule)


def _numbers(item: Item) -> str:
    """Label of a glass that has no name."""
    nd, vd = item.need("nd").number(), number(item, "vd")
    return f"{nd:.5g}" if vd is None else f"{nd:.5g}/{vd:.4g}"


def _of_catalogue(item: Item, label: str, maker: str | None, origin: Origin) -> ReadGlass:
    if member(item, "vd") is not None:
        item.need("nd")  # raises: it is missing
    try:
        found = glasses.find(label, maker or _supplier(label, origin))
    except LensError as error:
        name = item.need("name")
        raise LensError(f"{name.file}: {name.path}: {error}", error.code) from None
    own = absorption_of(item)
    medium = found.core.with_absorption(*own) if own else found.core
    return ReadGlass(medium, found.name, DispersionRule("catalogue", found.name, found.maker))


def _supplier(label: str, origin: Origin) -> str | None:
    """First supplier of the lens's maker that has a glass of exactly this name; None: any maker."""
    has = ((one, glasses.lookup(label, one)) for one in origin.makers)
    return next((one for one, glass in has if glass is not None and not glass.note), None)


def _with_absorption(item: Item, glass: Medium, label: str, origin: Origin) -> Medium:
    own = absorption_of(item)
    if own is not None:
        return glass.with_absorption(*own)
    nd = glass.index(LINE_D)
    known = glasses.similar(label, nd, SAME_ND, origin.makers) if label else None
    return glass.with_absorption_of(known.core) if known else glass
