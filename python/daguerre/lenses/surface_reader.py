"""Reads the surfaces of a lens file: their forms, apertures and glasses."""

from __future__ import annotations

from typing import NoReturn

from daguerre.files.json_item import Item, short

from .errors import LensError, reported
from .glass_json import glass_from_json
from .glass_rules import Origin
from .reading import flag, member, number, triple
from .surface import KINDS, TWO_SECTIONS, LensSurface

#: Highest power of r in an asphere.
MAX_POWER = 40
COATINGS = ("uncoated", "mgf2", "v-coat", "broadband", "perfect")


def read_surfaces(items: list[Item], gaps: dict[int, float], origin: Origin) -> list[LensSurface]:
    """Reads the surfaces, with the gaps of one configuration."""
    last = len(items) - 1
    surfaces = []
    for i, item in enumerate(items):
        with reported(item.file, "lens-format", i):
            surfaces.append(_surface(item, gaps.get(i), origin, last=i == last))
    return surfaces


def _surface(item: Item, gap: float | None, origin: Origin, *, last: bool) -> LensSurface:
    item.need("kind").text()
    kind = item.need("kind").choice(KINDS)
    radius = _radius(item, "radius")
    radius_x = _radius(item, "radius_x") if kind in TWO_SECTIONS else None
    semi_diameter = _semi_diameter(item, radius)
    glass = glass_from_json(member(item, "glass"), origin)
    coating = member(item, "coating")
    return LensSurface(
        kind=kind,
        radius=radius,
        thickness=_thickness(item, gap, last),
        semi_diameter=semi_diameter,
        glass=glass.label,
        stop=kind == "stop" or flag(item, "stop"),
        medium=glass.medium,
        conic=number(item, "conic") or 0.0,
        asphere=_asphere(item),
        radius_x=radius_x,
        conic_x=(number(item, "conic_x") or 0.0) if kind == "biconic" else 0.0,
        inner_semi_diameter=_inner(item, semi_diameter),
        semi_diameter_after=number(item, "semi_diameter_after", above=0),
        decenter=triple(item, "decenter", 1e4),
        tilt=triple(item, "tilt", 90),
        coating="" if coating is None else coating.choice(COATINGS),
        ripple=_ripple(item),
        dispersion=glass.rule,
        widened_from=_widened_from(item, semi_diameter),
        fitted=_fitted(item, semi_diameter),
    )


def _ripple(item: Item) -> tuple[float, float, int]:
    """Reads grooves left by grinding: RMS height in nm, period in um, seed."""
    ripple = member(item, "ripple")
    if ripple is None:
        return 0.0, 0.0, 0
    height, period = number(ripple, "rms_nm", above=0), number(ripple, "period_um", above=0)
    if height is None or period is None or height > 1000 or not 5 <= period <= 10000:
        ripple.fail("wanted rms_nm up to 1000 and period_um of 5 to 10000")
    seed = number(ripple, "seed") or 0.0
    if seed != int(seed) or not 0 <= seed < 2**32:
        ripple.need("seed").fail("wanted a whole number from 0 to 2^32 - 1")
    return height, period, int(seed)


def _radius(item: Item, key: str) -> float | None:
    radius = number(item, key)
    if radius == 0:
        item.need(key).fail("wanted a signed radius in mm, or null for a plane, got 0")
    return radius


def _thickness(item: Item, gap: float | None, last: bool) -> float | None:
    stated = number(item, "thickness")  # of other configurations, where this has a gap
    thickness = stated if gap is None else gap
    if not last and thickness is None:
        item.need("thickness").fail("wanted the distance to the next surface in mm, got null")
    if not last and thickness is not None and thickness < 0:
        _overlap(item, f"thickness: wanted at least 0 mm, got {thickness:g}")
    return thickness


def _overlap(item: Item, message: str) -> NoReturn:
    raise LensError(f"{item.file}: {item.path}.{message}", "lens-overlap", int(item.key))


def _semi_diameter(item: Item, radius: float | None) -> float | None:
    value = number(item, "semi_diameter", above=0)
    round_form = not member(item, "conic") and not member(item, "asphere")
    if value is None or radius is None or not round_form:
        return value
    if value > abs(radius) * (1 + 1e-9):
        item.need("semi_diameter").fail(
            f"wanted at most the radius, {abs(radius):g} mm, got {value:g}"
        )
    return value


def _widened_from(item: Item, semi_diameter: float | None) -> float | None:
    value = number(item, "widened_from", above=0)
    if value is not None and (semi_diameter is None or value >= semi_diameter):
        item.need("widened_from").fail(f"wanted less than the semi-diameter, got {value:g}")
    return value


def _fitted(item: Item, semi_diameter: float | None) -> bool:
    if not flag(item, "fitted"):
        return False
    bends = any(member(item, key) for key in ("radius", "glass", "asphere"))
    if bends or semi_diameter is None:
        item.need("fitted").fail("wanted a plane in air with a semi_diameter: a mount")
    return True


def _inner(item: Item, semi_diameter: float | None) -> float:
    inner = number(item, "inner_semi_diameter") or 0.0
    if inner < 0 or (semi_diameter is not None and inner >= semi_diameter):
        item.need("inner_semi_diameter").fail(
            f"wanted 0 mm to less than the semi-diameter, got {inner:g}"
        )
    return inner


def _asphere(item: Item) -> dict[int, float]:
    terms = member(item, "asphere")
    out: dict[int, float] = {}
    for term in terms.members() if terms else []:
        key = str(term.key)
        power = int(key[1:]) if key[:1] == "a" and key[1:].isdecimal() and len(key) < 6 else 0
        if not 2 <= power <= MAX_POWER:
            term.fail(f"wanted a power of r as a2 to a{MAX_POWER}, got {short(key)}")
        if (value := term.number()) != 0:
            out[power] = value
    return out
