"""Image circle of a lens, as its file states it."""

from __future__ import annotations

import math
import re

from .lens import FirstOrder, Lens
from .projections import projected

#: Half of the diagonal of 36 x 24 mm.
FULL_FRAME = 0.5 * math.hypot(36, 24)


def stated_half_image(lens: Lens, order: FirstOrder) -> float | None:
    """Half of the image circle, mm: nominal, of the nominal field, or of the format; else None.

    A fisheye has the smaller of circle and field: its picture may be a circle within its film.
    """
    known = []
    if lens.nominal.image_circle_mm:
        known.append(0.5 * lens.nominal.image_circle_mm)
    field, law = lens.nominal.full_field_deg, lens.nominal.projection or "rectilinear"
    if field and field > 1 and (law != "rectilinear" or (not known and field < 160)):
        known.append(float(abs(projected(law, order.efl, math.radians(0.5 * field)))))
    return min(known, default=_half_format(lens))


def half_image(lens: Lens, order: FirstOrder) -> float:
    """Half of the image circle, mm.

    A lens that states none has the smaller of that of 36 x 24 mm and that of 60 degrees from the
    axis.
    """
    stated = stated_half_image(lens, order)
    return stated or min(FULL_FRAME, math.sqrt(3) * abs(order.efl))


def format_mm(lens: Lens) -> tuple[float, float] | None:
    """Width and height of the file's format, such as ``36x24``, mm; None: no such format."""
    text = str(lens.data.get("format"))
    sides = re.fullmatch(r"(\d+(?:\.\d+)?)x(\d+(?:\.\d+)?)", text)
    if sides is None or not min(map(float, sides.groups())):
        return None
    return float(sides[1]), float(sides[2])


def _half_format(lens: Lens) -> float | None:
    """Half of the diagonal of the file's format, mm."""
    sides = format_mm(lens)
    return 0.5 * math.hypot(*sides) if sides else None
