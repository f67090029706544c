"""Code that tests if the iris stops a ray: a circle, or edges (core/optics/lens/stop.h)."""

from __future__ import annotations

from .expression import Expression, Function, select
from .plan import Blades


def outside_iris(
    f: Function, blades: Blades | None, x: Expression, y: Expression, otherwise: Expression
) -> Expression:
    """1 outside of the opening, ``otherwise`` inside; x, y are in units of its radius."""
    stopped = otherwise
    if blades is None:
        return f.temporary(select(x * x + y * y > 1.0, 1.0, stopped))
    for ex, ey in blades.edges:
        if blades.bend <= 0:
            past = x * ex + y * ey
            stopped = f.temporary(select(past > blades.apothem, 1.0, stopped))
        if blades.bend:
            dx = f.temporary(x - blades.center * ex)
            dy = f.temporary(y - blades.center * ey)
            square, limit = dx * dx + dy * dy, blades.arc_radius**2
            past_arc = square > limit if blades.bend > 0 else square < limit
            stopped = f.temporary(select(past_arc, 1.0, stopped))
    return stopped
