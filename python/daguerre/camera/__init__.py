"""Cameras in a photographer's terms: mm, m, s, degrees."""

from __future__ import annotations

from .camera import Camera
from .projection import Projection
from .rolling_shutter import RollingShutter

__all__ = ["Camera", "Projection", "RollingShutter"]
