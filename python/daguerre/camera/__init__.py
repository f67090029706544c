"""Cameras in a photographer's terms: mm, m, s, degrees."""

from __future__ import annotations

from typing import TYPE_CHECKING

from daguerre.lazy_imports import lazy_attributes

if TYPE_CHECKING:
    from .camera import Camera
    from .projection import Projection
    from .rolling_shutter import RollingShutter

__all__ = ["Camera", "Projection", "RollingShutter"]

if not TYPE_CHECKING:  # checkers know the names above, and report all others
    __getattr__, __dir__ = lazy_attributes(
        __name__,
        {
            "Camera": "camera",
            "Projection": "projection",
            "RollingShutter": "rolling_shutter",
        },
    )
