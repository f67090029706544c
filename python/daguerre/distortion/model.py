"""Interface of all distortion models: maps undistorted points to distorted points, and back.

Points are on the plane at distance 1 in front of the camera: (x, y) = (X / Z, Y / Z), x to the
right and y down, OpenCV's convention. ``distort`` maps points of an ideal (rectilinear) picture to
points of the lens's picture, undistorted -> distorted, OpenCV's direction. Where a model is not
defined or folds, the result is NaN.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daguerre.argument_checks import guarded
from daguerre.checks import to_numbers
from daguerre.errors import UsageError

FloatArray = NDArray[np.float64]
#: Largest angle off the axis, rad, that an ideal picture can show.
WIDEST = math.radians(89.99)


@guarded(arrays=False)
class Distortion(ABC):
    """Base class of distortion models."""

    def distort(self, points: ArrayLike) -> FloatArray:
        """Maps ideal points to points of the lens's picture.

        Args:
            points: Points at distance 1, shape (N, 2).

        Returns:
            Points at distance 1, shape (N, 2); NaN for points that the lens does not show.
        """
        return self._distorted(_checked(points))

    def undistort(self, points: ArrayLike) -> FloatArray:
        """Maps points of the lens's picture to ideal points: the inverse of ``distort``.

        Args:
            points: Points at distance 1, shape (N, 2).

        Returns:
            Points at distance 1, shape (N, 2); NaN where the lens shows none.
        """
        return self._ideal(_checked(points))

    @abstractmethod
    def _distorted(self, points: FloatArray) -> FloatArray: ...

    @abstractmethod
    def _ideal(self, points: FloatArray) -> FloatArray: ...


class Radial(Distortion):
    """Base class of models that move points only along their radius."""

    @abstractmethod
    def _bent(self, radius: FloatArray) -> FloatArray:
        """Distorted radii of ideal radii, shape (N,); NaN beyond the end."""

    @abstractmethod
    def _straight(self, radius: FloatArray) -> FloatArray:
        """Ideal radii of distorted radii, shape (N,); NaN beyond the end."""

    def _distorted(self, points: FloatArray) -> FloatArray:
        return _scaled(points, self._bent)

    def _ideal(self, points: FloatArray) -> FloatArray:
        return _scaled(points, self._straight)


def _scaled(points: FloatArray, new: Callable[[FloatArray], FloatArray]) -> FloatArray:
    radius = np.hypot(points[:, 0], points[:, 1])
    # Near the axis the ratio of a small radius is used, as all models are smooth there.
    safe = np.maximum(radius, 1e-9)
    return np.asarray(points * (new(safe) / safe)[:, None])


def _checked(points: ArrayLike) -> FloatArray:
    array = to_numbers(points, "distortion", "points", "shape (N, 2)").astype(np.float64)
    if array.ndim != 2 or array.shape[1] != 2:
        raise UsageError(f"distortion: points: wanted shape (N, 2), got {array.shape}")
    return array
