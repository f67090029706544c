"""The models of OpenCV: Brown-Conrady, the full rational model, and fisheye.

Formulas: OpenCV, "Camera Calibration and 3D Reconstruction" (calib3d) and "Fisheye camera model".
After Conrady 1919, Decentred lens-systems; Brown 1971, Close-range camera calibration; Kannala and
Brandt 2006.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from daguerre.argument_checks import guarded

from .projected import Projected


@guarded(init=True, arrays=False)
@dataclass(frozen=True)
class OpenCV(Projected):
    """The rational model with tangential terms, thin prism and tilt: all 14 numbers of OpenCV.

    x' = x (1 + k1 r^2 + k2 r^4 + k3 r^6) / (1 + k4 r^2 + k5 r^4 + k6 r^6)
         + 2 p1 x y + p2 (r^2 + 2 x^2) + s1 r^2 + s2 r^4,
    y' likewise with p1 (r^2 + 2 y^2) + 2 p2 x y + s3 r^2 + s4 r^4; then the sensor is turned by
    tau_x about x and by tau_y about y (rad).
    """

    _projection: ClassVar = "opencv"
    k1: float = 0.0
    k2: float = 0.0
    p1: float = 0.0
    p2: float = 0.0
    k3: float = 0.0
    k4: float = 0.0
    k5: float = 0.0
    k6: float = 0.0
    s1: float = 0.0
    s2: float = 0.0
    s3: float = 0.0
    s4: float = 0.0
    tau_x: float = 0.0
    tau_y: float = 0.0


@guarded(init=True, arrays=False)
@dataclass(frozen=True)
class BrownConrady(OpenCV):
    """Radial (k1, k2, k3) and tangential (p1, p2) distortion, in OpenCV's order and meaning."""

    def __init__(
        self,
        k1: float = 0.0,
        k2: float = 0.0,
        p1: float = 0.0,
        p2: float = 0.0,
        k3: float = 0.0,
    ) -> None:
        super().__init__(k1, k2, p1, p2, k3)


@guarded(init=True, arrays=False)
@dataclass(frozen=True)
class OpenCVFisheye(Projected):
    """OpenCV's fisheye: radius = t (1 + k1 t^2 + k2 t^4 + k3 t^6 + k4 t^8), t the angle, rad."""

    _projection: ClassVar = "kannala_brandt"
    k1: float = 0.0
    k2: float = 0.0
    k3: float = 0.0
    k4: float = 0.0
