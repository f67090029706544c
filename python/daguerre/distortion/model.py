"""Interface of all distortion models: ideal points to those of a lens, and back.

Points lie on the plane at distance 1 in front of the camera: (x, y) = (X / Z, Y / Z), x to the
right and y down, OpenCV's convention. A model maps the points of an ideal (rectilinear) picture to
those of the picture of the lens: ``distort``, undistorted -> distorted, which is OpenCV's
direction. Where a model is not defined, or turns back upon itself, the answer is NaN.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daguerre.checks import to_numbers
from daguerre.doors import guarded
from daguerre.errors import UsageError

FloatArray = NDArray[np.float64]
#: Angle off the axis, rad, from which on things lie beside the camera: no ideal picture shows them.
WIDEST = math.radians(89.99)


@guarded(arrays=False)
class Distortion(ABC):
    """The base of all models."""

    def distort(self, points: ArrayLike) -> FloatArray:
        """Where the lens shows ideal points.

        Args:
            points: Shape (N, 2), at distance 1.

        Returns:
            Shape (N, 2); NaN for points that it does not show.
        """
        return self._distorted(_checked(points))

    def undistort(self, points: ArrayLike) -> FloatArray:
        """The ideal points that the lens shows at these points: the inverse of ``distort``."""
        return self._ideal(_checked(points))

    @abstractmethod
    def _distorted(self, points: FloatArray) -> FloatArray: ...

    @abstractmethod
    def _ideal(self, points: FloatArray) -> FloatArray: ...


class Radial(Distortion):
    """A model that moves points along their radius alone."""

    @abstractmethod
    def _bent(self, radius: FloatArray) -> FloatArray:
        """Distorted radii of ideal ones, shape (N,); NaN beyond the end."""

    @abstractmethod
    def _straight(self, radius: FloatArray) -> FloatArray:
        """Ideal radii of distorted ones, shape (N,); NaN beyond the end."""

    def _distorted(self, points: FloatArray) -> FloatArray:
        return _scaled(points, self._bent)

    def _ideal(self, points: FloatArray) -> FloatArray:
        return _scaled(points, self._straight)


def _scaled(points: FloatArray, new: Callable[[FloatArray], FloatArray]) -> FloatArray:
    radius = np.hypot(points[:, 0], points[:, 1])
    # Near the axis the ratio is that of a small radius: all models are smooth there.
    safe = np.maximum(radius, 1e-9)
    return np.asarray(points * (new(safe) / safe)[:, None])


def _checked(points: ArrayLike) -> FloatArray:
    array = to_numbers(points, "distortion", "points", "shape (N, 2)").astype(np.float64)
    if array.ndim != 2 or array.shape[1] != 2:
        raise UsageError(f"distortion: points: wanted shape (N, 2), got {array.shape}")
    return array
