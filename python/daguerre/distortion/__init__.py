"""Models of distortion as functions of points; pictures are bent with them in ``daguerre.post``."""

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
