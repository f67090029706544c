"""Exposure and shutter of a picture: constant within it, though they may change over time."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from .parameters import OPTICS

if TYPE_CHECKING:
    from .camera import Camera


def settled(camera: Camera, time: float) -> Camera:
    """Returns the camera with the brightness and the shutter of the picture of a time, s.

    Its optics keep their motion.
    """
    now = {name: value.at(time) for name, value in camera.motion.items() if name not in OPTICS}
    if not now:
        return camera
    rest = {name: value for name, value in camera.motion.items() if name in OPTICS}
    return replace(camera, motion=rest, **now)
