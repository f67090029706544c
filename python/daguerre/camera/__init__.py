"""Cameras in a photographer's terms: mm, m, s, degrees."""

from __future__ import annotations

from typing import TYPE_CHECKING

from daguerre.on_use import on_use

if TYPE_CHECKING:
    from .camera import Camera
    from .projection import Projection
    from .rolling_shutter import RollingShutter

__all__ = ["Camera", "Projection", "RollingShutter"]

if not TYPE_CHECKING:  # checkers know the names above, and report all others
    __getattr__, __dir__ = on_use(
        __name__,
        {
            "Camera": "camera",
            "Projection": "projection",
            "RollingShutter": "rolling_shutter",
        },
    )
