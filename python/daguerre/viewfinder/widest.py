"""Widest: the stop of a lens that does not open as wide as the dials are set."""

from __future__ import annotations

from dataclasses import replace

from daguerre.lenses.errors import LensError

from .dials import Dials
from .drawn import Wish

#: Dials that set the opening.
_STOPS = ("f_stop", "t_stop", "aperture_diameter")


def opened_as_wide(wish: Wish, error: Exception, before: Dials) -> Dials | None:
    """Dials at the widest stop of the lens, after a lens or a zoom that opens less was chosen.

    Args:
        wish: The wish that cannot be drawn.
        error: Why it cannot.
        before: Dials of the picture that is shown.

    Returns:
        The dials; None: the error is another one, or the stop itself was turned.
    """
    stops = [[dials.texts.get(name) for name in _STOPS] for dials in (before, wish.dials)]
    if not isinstance(error, LensError) or error.code != "lens-f-stop" or stops[0] != stops[1]:
        return None
    camera = wish.shot.camera.with_(f_stop=None, t_stop=None)
    widest = wish.stage.set_up(replace(wish.shot, camera=camera)).widest_stop
    return wish.dials.turned({"f_stop": f"{widest:.3g}"})
