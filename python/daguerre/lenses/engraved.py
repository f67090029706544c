"""Engraved f-stops: the round number on a barrel may be a little wider than the lens opens."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .lens import Lens

#: Shares of the widest f-number: from the first, a stop is taken as it is, as in the core; from
#: the second, the lens is wide open. Makers round: a lens of f/1.44 is engraved 1.4.
AS_GIVEN, ROUNDED = 0.99, 0.97


def opened(f_stop: float, widest: float) -> float:
    """Returns the f-stop to use: the lens's widest, if the given f-stop is up to 3 % wider."""
    return widest if ROUNDED * widest <= f_stop < AS_GIVEN * widest else f_stop


def remark(name: str, given: float, used: float, letter: str = "f") -> str | None:
    """Note that the widest stop of a lens is used; None: the given stop is used."""
    if opened(given, used) == given:
        return None
    return f"{letter}/{given:.4g}: {name} opens to {letter}/{used:.4g}, which is used"


def stop_remark(
    lens: Lens,
    f_stop: float | None = None,
    zoom_mm: float | None = None,
    *,
    widest: float | None = None,
    **_: object,
) -> str | None:
    """Note of a lens on the bench; see :func:`remark`.

    Args:
        lens: The lens.
        f_stop: F-stop that was asked for; None: wide open.
        zoom_mm: Focal length of a zoom, mm.
        widest: Widest f-number, if it is known.
    """
    if f_stop is None:
        return None
    if widest is None:
        widest = (lens if zoom_mm is None else lens.at_zoom(zoom_mm)).first_order().f_number
    return remark(lens.name, f_stop, widest)
