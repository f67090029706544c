"""The models of OpenCV: Brown's and Conrady's, the rational one with all its parts, and fisheye.

Formulas: OpenCV, "Camera Calibration and 3D Reconstruction" (calib3d) and "Fisheye camera model".
After Conrady 1919, Decentred lens-systems; Brown 1971, Close-range camera calibration; Kannala and
Brandt 2006.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .model import Distortion, FloatArray, Radial
from .monotone import SAMPLES, Monotone

NEWTON = 30
ANGLES = np.linspace(0, math.radians(89.9), SAMPLES)


@dataclass(frozen=True)
class OpenCV(Distortion):
    """The rational model with tangential terms, thin prism and tilt: all 14 numbers of OpenCV.

    x' = x (1 + k1 r^2 + k2 r^4 + k3 r^6) / (1 + k4 r^2 + k5 r^4 + k6 r^6)
         + 2 p1 x y + p2 (r^2 + 2 x^2) + s1 r^2 + s2 r^4,
    y' likewise with p1 (r^2 + 2 y^2) + 2 p2 x y + s3 r^2 + s4 r^4; then the sensor is turned by
    tau_x about x and by tau_y about y (rad).
    """

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

    @cached_property
    def _radial(self) -> Monotone:
        return Monotone(lambda r: r * self._factor(r * r), np.tan(ANGLES))

    def _factor(self, r2: FloatArray) -> FloatArray:
        top = 1 + r2 * (self.k1 + r2 * (self.k2 + r2 * self.k3))
        bottom = 1 + r2 * (self.k4 + r2 * (self.k5 + r2 * self.k6))
        return np.where(bottom > 0, top / bottom, np.nan)

    def _formula(self, points: FloatArray) -> FloatArray:
        x, y = points[:, 0], points[:, 1]
        xx, yy, xy = x * x, y * y, x * y
        r2 = xx + yy
        factor = self._factor(r2)
        u = x * factor + 2 * self.p1 * xy + self.p2 * (r2 + 2 * xx) + r2 * (self.s1 + r2 * self.s2)
        v = y * factor + self.p1 * (r2 + 2 * yy) + 2 * self.p2 * xy + r2 * (self.s3 + r2 * self.s4)
        return self._tilted(np.column_stack([u, v]))

    def _tilted(self, points: FloatArray) -> FloatArray:
        if self.tau_x == 0 and self.tau_y == 0:
            return points
        homogeneous = np.column_stack([points, np.ones(len(points))]) @ self._tilt.T
        return np.asarray(homogeneous[:, :2] / homogeneous[:, 2:])

    @cached_property
    def _tilt(self) -> FloatArray:
        """The plane of a sensor that is turned about x, then y, seen along the axis."""
        cx, sx = math.cos(self.tau_x), math.sin(self.tau_x)
        cy, sy = math.cos(self.tau_y), math.sin(self.tau_y)
        about_x = np.array([[1, 0, 0], [0, cx, sx], [0, -sx, cx]])
        about_y = np.array([[cy, 0, -sy], [0, 1, 0], [sy, 0, cy]])
        turned = about_y @ about_x
        along_z = [[turned[2, 2], 0, -turned[0, 2]], [0, turned[2, 2], -turned[1, 2]], [0, 0, 1]]
        return np.asarray(np.array(along_z) @ turned)

    def _distorted(self, points: FloatArray) -> FloatArray:
        with np.errstate(all="ignore"):
            out = self._formula(points)
            out[~self._upright(points)] = np.nan
        return out

    def _ideal(self, points: FloatArray) -> FloatArray:
        with np.errstate(all="ignore"):
            x = self._start(points)
            open_ = np.arange(len(points))
            for _ in range(NEWTON):
                miss = self._formula(x[open_]) - points[open_]
                far = np.abs(miss).max(axis=1) > 1e-14  # False for what has been lost
                open_, miss = open_[far], miss[far]
                if not len(open_):
                    break
                x[open_] -= self._solved(x[open_], miss)
            lost = ~(np.abs(self._formula(x) - points).max(axis=1) < 1e-9) | ~self._upright(x)
        x[lost] = np.nan
        return x

    def _start(self, points: FloatArray) -> FloatArray:
        """The radial part undone: near enough for Newton's method."""
        if self.tau_x or self.tau_y:
            flat = np.column_stack([points, np.ones(len(points))]) @ np.linalg.inv(self._tilt).T
            points = flat[:, :2] / flat[:, 2:]
        radius = np.hypot(points[:, 0], points[:, 1])
        limit = self._radial.value_limit
        safe = np.clip(radius, 1e-9, limit)
        return points * (self._radial.inverse(safe) / np.maximum(radius, 1e-9))[:, None]

    def _jacobian(self, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        h = 1e-6
        across, along = np.array([h, 0]), np.array([0, h])
        by_x = (self._formula(points + across) - self._formula(points - across)) / (2 * h)
        by_y = (self._formula(points + along) - self._formula(points - along)) / (2 * h)
        return by_x, by_y

    def _solved(self, points: FloatArray, miss: FloatArray) -> FloatArray:
        a, b = self._jacobian(points)
        det = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
        dx = (miss[:, 0] * b[:, 1] - miss[:, 1] * b[:, 0]) / det
        dy = (a[:, 0] * miss[:, 1] - a[:, 1] * miss[:, 0]) / det
        return np.column_stack([dx, dy])

    def _upright(self, points: FloatArray) -> np.ndarray:
        """Within the radius at which the radial part turns back, and not mirrored."""
        a, b = self._jacobian(points)
        radius = np.hypot(points[:, 0], points[:, 1])
        return (radius <= self._radial.limit) & (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0] > 0)


@dataclass(frozen=True)
class BrownConrady(OpenCV):
    """Radial and tangential distortion: k1, k2, k3 and p1, p2 in OpenCV's order and meaning."""

    def __init__(
        self,
        k1: float = 0.0,
        k2: float = 0.0,
        p1: float = 0.0,
        p2: float = 0.0,
        k3: float = 0.0,
    ) -> None:
        super().__init__(k1, k2, p1, p2, k3)


@dataclass(frozen=True)
class OpenCVFisheye(Radial):
    """Radius = t (1 + k1 t^2 + k2 t^4 + k3 t^6 + k4 t^8), t the angle off the axis."""

    k1: float = 0.0
    k2: float = 0.0
    k3: float = 0.0
    k4: float = 0.0

    @cached_property
    def _of_angle(self) -> Monotone:
        return Monotone(self._radius, np.linspace(0, math.pi, SAMPLES))

    def _radius(self, angle: FloatArray) -> FloatArray:
        a2 = angle * angle
        return np.asarray(
            angle * (1 + a2 * (self.k1 + a2 * (self.k2 + a2 * (self.k3 + a2 * self.k4))))
        )

    def _bent(self, radius: FloatArray) -> FloatArray:
        return self._of_angle(np.arctan(radius))

    def _straight(self, radius: FloatArray) -> FloatArray:
        return tangent(self._of_angle.inverse(radius))


def tangent(angle: FloatArray) -> FloatArray:
    """Radius at distance 1 of an angle off the axis; NaN for what lies beside or behind."""
    return np.where(angle < math.radians(89.99), np.tan(np.minimum(angle, 1.5706)), np.nan)
