"""Live ghosts: the ghosts of a picture that follows a hand, drawn in a tenth of a second."""

from __future__ import annotations

import numpy as np

import daguerre._core as _core
from daguerre.camera.parameters.needs import TRACED
from daguerre.color.spectra import xyz_of
from daguerre.errors import InputError, core_errors
from daguerre.frame.frame import Frame
from daguerre.sensors.fit import channels_from_xyz

from .light_plan import core_settings_of
from .session import Session


class LiveGhosts:
    """Draws the ghosts by two reflections of the brightest small lamps, and nothing else."""

    def __init__(self) -> None:
        self._core = _core.LiveFlare()

    @core_errors(InputError, "flare")
    def draw(self, session: Session) -> Frame | None:
        """Draws the ghosts of a session's picture, whatever the session has drawn.

        Returns:
            Their light, which adds to a frame without ghosts; None: there is none.
        """
        one = session.prepared
        if one.setup.lens.model not in TRACED:
            return None
        whole = self._core.draw(one.core_scene, one.setup.core, core_settings_of(one))
        if not self._core.sources:
            return None
        left, top, right, bottom = one.crop
        rgb = np.ascontiguousarray(whole[top:bottom, left:right])
        light = Frame(rgb, flare=rgb, metadata=session.metadata)
        if one.sensor is not None:
            matrix = channels_from_xyz(one.sensor).T
            light.channels = np.asarray(xyz_of(rgb) @ matrix, np.float32)
        return light
