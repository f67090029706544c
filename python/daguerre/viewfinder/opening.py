"""Opening: the exposure at which a viewfinder starts."""

from __future__ import annotations

from dataclasses import replace

from daguerre.camera.exposure import is_held
from daguerre.camera.exposure_mode import LIGHT
from daguerre.errors import InputError
from daguerre.rendering.backdrop import shows_plate

from .background import in_background
from .dials import Dials, texts_of_words
from .shot import Shot
from .stage import Stage


def opened(stage: Stage, dials: Dials) -> tuple[Dials, str]:
    """Dials in ``manual``, at a given ISO or at an ISO that a meter chooses once.

    An exposure mode from the command line or the file stays, and so does ``light`` where a picture
    can have no other mode.

    Returns:
        The dials, and a note on them for the user; empty: no note.
    """
    shot = stage.shot(dials)
    if "exposure" in dials.texts or shot.camera.exposure != LIGHT or _only_light(shot):
        return dials, ""
    if "iso" in dials.texts or is_held(shot.camera, "iso"):
        return dials.turned({"exposure": "manual"}), ""
    # The ring keeps its compensation, so the meter leaves it out.
    camera = shot.camera.with_(exposure="auto", exposure_compensation=0.0)
    try:
        chosen = in_background(lambda: stage.exposed(replace(shot, camera=camera))).chosen
    except InputError as error:  # such as a frozen shutter
        return dials, f"{error}; so the exposure mode is light"
    assert chosen is not None
    texts = texts_of_words(chosen.words)
    if texts["exposure"] == LIGHT:
        return dials, chosen.warning
    return dials.turned(texts), chosen.missing  # the dial is not at the mode that metered


def _only_light(shot: Shot) -> bool:
    return shot.tone != "srgb" or shows_plate(shot.settings)
