"""Widest: the smallest f-stop of a lens, and dials at it."""

from __future__ import annotations

from dataclasses import replace

from daguerre.lenses.errors import LensError

from .dials import Dials
from .drawn import PictureRequest
from .shot import Shot
from .stage import Stage

#: Dials that set the opening.
_STOPS = ("f_stop", "t_stop", "aperture_diameter")


def widest_stop(stage: Stage, shot: Shot) -> float:
    """Smallest f-stop of the lens of a shot; 0: an ideal lens, which opens as wide as asked."""
    camera = shot.camera.with_(f_stop=None, t_stop=None)
    lens = stage.set_up(replace(shot, camera=camera))
    return lens.widest_stop if lens.glass else 0.0


def opened_as_wide(request: PictureRequest, error: Exception, before: Dials) -> Dials | None:
    """Dials at the widest stop of the lens, after a lens or a zoom that opens less was chosen.

    Args:
        request: The request that cannot be drawn.
        error: Error of the request.
        before: Dials of the picture that is shown.

    Returns:
        The dials; None: the error has another cause, or the stop itself was turned.
    """
    stops = [[dials.texts.get(name) for name in _STOPS] for dials in (before, request.dials)]
    if not isinstance(error, LensError) or error.code != "lens-f-stop" or stops[0] != stops[1]:
        return None
    return request.dials.turned({"f_stop": f"{widest_stop(request.stage, request.shot):.3g}"})
