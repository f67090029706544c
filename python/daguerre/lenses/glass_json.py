"""Reads a glass of a lens file: ``{nd, vd, name}``, ``{name}``, ``{table}``, ``{sellmeier}`` ..."""

from __future__ import annotations

from daguerre.files.json_item import Item

from . import glasses
from .errors import LensError
from .glass_formula import absorption_of, formula_of
from .glasses.catalogue import LINE_D
from .medium import AIR, Medium
from .reading import member, number, text


def glass_from_json(item: Item | None) -> tuple[Medium, str]:
    """Returns the glass and its label (its name, or nd/Vd). None and null are air.

    The index comes from a formula or a table, else from nd and vd; a name without numbers is looked
    up in the makers' catalogues. Absorption comes from ``internal_transmittance``, else from the
    catalogue's glass of this name if its nd agrees within 5e-4.

    Raises:
        InputError: A member cannot be used; the message has the file and JSON path. LensError
            (lens-glass): no catalogue has the name.
    """
    if item is None or item.value is None:
        return AIR, ""
    label = text(item, "name") or ""
    formula = formula_of(item)
    if formula is not None:
        glass, default = formula
    elif label and member(item, "nd") is None:
        return _of_catalogue(item, label)
    else:
        glass, default = _abbe(item)
    return _with_absorption(item, glass, label), label or default


def _abbe(item: Item) -> tuple[Medium, str]:
    nd = item.need("nd").number(1, 5)
    vd = number(item, "vd", above=0)
    if vd is None:
        return Medium("constant", (nd,)), f"{nd:.5g}"
    if vd < 5:
        item.need("vd").fail(f"wanted an Abbe number of at least 5, got {vd:g}")
    return Medium("abbe", (nd, vd)), f"{nd:.5g}/{vd:.4g}"


def _of_catalogue(item: Item, label: str) -> tuple[Medium, str]:
    if member(item, "vd") is not None:
        item.need("nd")  # raises: it is missing
    try:
        found = glasses.find(label, text(item, "maker"))
    except LensError as error:
        name = item.need("name")
        raise LensError(f"{name.file}: {name.path}: {error}", error.code) from None
    own = absorption_of(item)
    return found.core.with_absorption(*own) if own else found.core, found.name


def _with_absorption(item: Item, glass: Medium, label: str) -> Medium:
    own = absorption_of(item)
    if own is not None:
        return glass.with_absorption(*own)
    known = glasses.similar(label, glass.index(LINE_D)) if label else None
    return glass.with_absorption_of(known.core) if known else glass
