"""Reads a JSON glass's dispersion formula and internal transmittance."""

from __future__ import annotations

import itertools
import math

from daguerre.errors import CoreError
from daguerre.files.json_item import Item

from .medium import Medium

#: Members that each define the index.
FORMULAS = ("table", "sellmeier", "polynomial")
MAX_TERMS = 32


def formula_of(item: Item) -> tuple[Medium, str] | None:
    """Makes the glass of ``table``, ``sellmeier`` or ``polynomial``, with that name; None: neither.

    Raises:
        InputError: A member cannot be used; the message has the file and JSON path.
    """
    for kind, read in zip(FORMULAS, (_table, _sellmeier, _polynomial), strict=True):
        member = item.get(kind)
        if member is not None and member.value is not None:
            try:
                glass = read(member)
                vacuum = item.get("against_vacuum")
                if vacuum is not None and vacuum.flag():
                    glass = glass.against_vacuum()
                return glass, kind
            except CoreError as error:
                member.fail(str(error))  # the core's message, such as an impossible index
    return None


def absorption_of(item: Item) -> tuple[list[float], list[float]] | None:
    """Nodes (nm) and coefficients (1/mm, base e) of ``internal_transmittance``; None: absent.

    Raises:
        InputError: A member cannot be used; the message has the file and JSON path.
    """
    member = item.get("internal_transmittance")
    if member is None or member.value is None:
        return None
    thickness = member.need("thickness_mm").number(0, 1e4, above=0)
    nodes = _nodes(member.need("table"), "tau", above=0, high=1)
    return [nm for nm, _ in nodes], [-math.log(tau) / thickness for _, tau in nodes]


def _table(member: Item) -> Medium:
    nm, n = zip(*_nodes(member, "n", low=1, high=5), strict=True)
    return Medium("table", (nm, n))


def _sellmeier(member: Item) -> Medium:
    b, c = _terms(member, "b", "c")
    return Medium("sellmeier", (b, c, member.number_of("constant", 0.0, -10, 10)))


def _polynomial(member: Item) -> Medium:
    coefficients, powers = _terms(member, "coefficients", "powers")
    return Medium("polynomial", (coefficients, powers))


def _terms(member: Item, first: str, second: str) -> tuple[list[float], list[float]]:
    """Reads two lists of equal length."""
    a = [x.number(-1e6, 1e6) for x in member.need(first)]
    b = [x.number(-1e6, 1e6) for x in member.need(second)]
    if not a or len(a) != len(b) or len(a) > MAX_TERMS:
        member.fail(
            f"wanted as many {second} as {first}, 1 to {MAX_TERMS}, got {len(b)} and {len(a)}"
        )
    return a, b


def _nodes(
    table: Item, what: str, *, low: float = 0, high: float, above: float | None = None
) -> list[tuple[float, float]]:
    """Reads [[nm, value], ...], sorted by wavelength; a repeated wavelength is an error."""
    nodes = []
    for row in table:
        nm, _ = row.numbers(2)
        Item(nm, 0, row).number(1, 1e5)
        nodes.append((nm, Item(row.value[1], 1, row).number(low, high, above=above)))
    if not nodes:
        table.fail(f"wanted [[nm, {what}], ...], got an empty list")
    nodes.sort()
    if any(a[0] == b[0] for a, b in itertools.pairwise(nodes)):
        values = "indices" if what == "n" else "values"
        table.fail(f"wavelengths must differ, got two {values} for one wavelength")
    return nodes
