"""Image circle of a lens, as its file states it."""

from __future__ import annotations

import math
import re

from daguerre.units import SENSORS

from .lens import FirstOrder, Lens
from .projections import projected

#: Half of the diagonal of 36 x 24 mm.
FULL_FRAME = 0.5 * math.hypot(36, 24)
#: Pictures on film and common sensors by the name of their format, mm. Sheet film is named in
#: inches and roll film in cm, both by the film and not by its picture.
FORMATS = {
    **dict.fromkeys(("135", "ff", "full-frame", "35mm-full-frame"), SENSORS["ff"]),
    "4x5": (121.0, 97.0),
    "5x7": (170.0, 121.0),
    "8x10": (246.0, 195.0),
    "6x9": (84.0, 56.0),
    "6x7": (69.5, 56.0),
    "6x6": (56.0, 56.0),
    **dict.fromkeys(("645", "6x4.5"), SENSORS["645"]),
    "aps-c": SENSORS["apsc"],
    **dict.fromkeys(("four-thirds", "micro-four-thirds", "mft"), SENSORS["mft"]),
    **dict.fromkeys(("super-35", "s35"), (24.9, 18.7)),
}
_NUMBER, _LARGEST_MM = r"(\d+(?:\.\d+)?)", 1000.0


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

    A lens without a stated circle has the circle of 36 x 24 mm, or of 60 degrees from the axis if
    that is smaller.
    """
    stated = stated_half_image(lens, order)
    return stated or min(FULL_FRAME, math.sqrt(3) * abs(order.efl))


def format_mm(lens: Lens) -> tuple[float, float] | None:
    """Width and height of the file's format, mm; None: it states none that is known.

    A format is a size such as ``36x24``, a name such as ``4x5`` (inches), ``6x7`` (cm) or
    ``135-full-frame``, or a text that has one of them, such as ``135 full frame (36x24 mm)``.
    """
    text = lens.data.get("format")
    if not isinstance(text, str):
        return None
    text = re.sub(r"(?<=\d)\s*[x\u00d7]\s*(?=\d)", "x", text.lower())
    if text.strip() in FORMATS:
        return FORMATS[text.strip()]
    sides = re.search(rf"(?<![\w.]){_NUMBER}x{_NUMBER}(?:\s*mm|\s*$)", text)
    if sides is not None and min(found := (float(sides[1]), float(sides[2]))) > 0:
        return found if max(found) < _LARGEST_MM else None
    words = " ".join(re.findall(r"[a-z0-9.]+", text))
    named = (name for name in FORMATS if f" {name.replace('-', ' ')} " in f" {words} ")
    longest = max(named, key=len, default=None)
    return None if longest is None else FORMATS[longest]


def film_mm(lens: Lens, most: float = math.inf) -> tuple[float, float]:
    """Width and height of a lens's film, mm: its format, or 3:2 within its image circle.

    Args:
        lens: The lens; without a stated circle, it has the circle of 36 x 24 mm.
        most: Largest half of the diagonal where no format is stated, mm.
    """
    stated = format_mm(lens)
    if stated:
        return stated
    half = stated_half_image(lens, lens.first_order()) or FULL_FRAME
    share = min(half, most) / FULL_FRAME
    return share * 36, share * 24


def _half_format(lens: Lens) -> float | None:
    """Half of the diagonal of the file's format, mm."""
    sides = format_mm(lens)
    return 0.5 * math.hypot(*sides) if sides else None
