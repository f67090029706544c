"""Distortion models as functions of points; ``daguerre.post`` applies them to pictures."""

from __future__ import annotations

from .model import Distortion, Radial
from .opencv import BrownConrady, OpenCV, OpenCVFisheye
from .projections import Division, Equidistant, Equisolid, Orthographic, Stereographic

__all__ = [
    "BrownConrady",
    "Distortion",
    "Division",
    "Equidistant",
    "Equisolid",
    "OpenCV",
    "OpenCVFisheye",
    "Orthographic",
    "Radial",
    "Stereographic",
]
