"""Live ghosts: the ghosts of a picture that follows a hand, drawn in a tenth of a second."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core
from daguerre.camera.parameters.needs import TRACED
from daguerre.color.spectra import xyz_of
from daguerre.errors import InputError, core_errors
from daguerre.frame.frame import Frame
from daguerre.sensors.fit import channels_from_xyz

from .light_plan import core_settings_of
from .session import Session


class LiveGhosts:
    """Draws live ghosts; keeps where they come through the front of a lens that stays."""

    def __init__(self) -> None:
        self._core = _core.LiveFlare()

    @core_errors(InputError, "flare")
    def draw(self, session: Session) -> Frame | None:
        """Draws the ghosts by two reflections of the brightest small lamps, and nothing else.

        Args:
            session: Session of the picture, at any number of samples.

        Returns:
            Light of the ghosts, to add to a frame without ghosts; None: no ghosts.
        """
        prepared = session.prepared
        if prepared.setup.lens.model not in TRACED:
            return None
        whole = self._core.draw(
            prepared.core_scene, prepared.setup.core, core_settings_of(prepared)
        )
        return _frame(session, whole) if self._core.sources else None


def _frame(session: Session, whole: NDArray[np.float32]) -> Frame:
    """Returns the crop of a session's ghosts as a frame."""
    prepared = session.prepared
    left, top, right, bottom = prepared.crop
    rgb = np.ascontiguousarray(whole[top:bottom, left:right])
    light = Frame(rgb, flare=rgb)
    if prepared.sensor is not None:
        matrix = channels_from_xyz(prepared.sensor).T
        light.channels = np.asarray(xyz_of(rgb) @ matrix, np.float32)
    return light
