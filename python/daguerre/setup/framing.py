"""Framing: camera, pose, film and focus at one moment, from which any lens is set up."""

from __future__ import annotations

from dataclasses import dataclass

import daguerre._core as _core
from daguerre.camera.camera import Camera

from .focus import Focus


@dataclass(frozen=True)
class Framing:
    """A camera at one moment, without its lens.

    Attributes:
        camera: Camera at that moment.
        pose: Pose of the camera while the shutter is open, relative to the core's scene.
        focus: Finder of the focus distance.
        film_mm: Width and height of the film, centred on the frame, with overscan.
    """

    camera: Camera
    pose: _core.Motion
    focus: Focus
    film_mm: tuple[float, float]

    @property
    def frame_mm(self) -> tuple[float, float]:
        """Width and height of the picture on the film, without overscan."""
        return self.focus.frame_mm

    @property
    def pitch_mm(self) -> float:
        """Pixel pitch."""
        return self.focus.frame_mm[0] / self.focus.resolution[0]
