"""Distortion models as functions of points; ``daguerre.post`` applies them to pictures."""

from __future__ import annotations

from typing import TYPE_CHECKING

from daguerre.lazy_imports import lazy_attributes

if TYPE_CHECKING:
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

if not TYPE_CHECKING:  # checkers know the names above, and report all others
    __getattr__, __dir__ = lazy_attributes(
        __name__,
        {
            "BrownConrady": "opencv",
            "Distortion": "model",
            "Division": "projections",
            "Equidistant": "projections",
            "Equisolid": "projections",
            "OpenCV": "opencv",
            "OpenCVFisheye": "opencv",
            "Orthographic": "projections",
            "Radial": "model",
            "Stereographic": "projections",
        },
    )
