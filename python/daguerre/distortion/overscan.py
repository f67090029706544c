"""Overscan needed so that undistorting or distorting a picture leaves no holes."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core
from daguerre.camera.camera import Camera
from daguerre.camera.overscan import Overscan, check_overscan
from daguerre.errors import UsageError
from daguerre.scene.scene import Scene

from .rectified import RectifiedView

FloatArray = NDArray[np.float64]


#: Pixels that the filters of ``daguerre post`` read around a point.
FILTER_MARGIN = 4


#: Largest overscan on a side, in sides of the picture.
MOST = 2.0


def to_undistort(view: RectifiedView, where: str = "overscan undistort") -> Overscan:
    """Finds the overscan with which undistorting leaves no holes in a picture of the same size.

    Raises:
        UsageError: It would need parts that the camera does not show, or too large a picture.
    """
    return _reach(view, view.bent_from_straight, where)


def note(overscan: Overscan) -> str:
    """Note on the overscan found for ``"undistort"``."""
    told = f"{overscan} px" if overscan else "none is needed"
    return f"overscan (left, top, right, bottom) to undistort the picture: {told}"


def to_redistort(view: RectifiedView) -> Overscan | None:
    """Finds the overscan with which an ideal picture redistorts without holes; None: unbounded."""

    def place(points: FloatArray) -> FloatArray:
        found = view.straight_from_bent(points)
        dark = ~view.sees(points)  # dark pixels need no source
        found[dark] = np.array(view.resolution) / 2
        return found

    try:
        return _reach(view, place, "")
    except UsageError:
        return None


def _reach(view: RectifiedView, place: Any, where: str) -> Overscan:
    """Overscan that contains the mapped pixels of the display window."""
    width, height = view.resolution
    # The map is smooth: corners and edges reach farthest, except for folds within.
    x, y = (np.linspace(0, n, min(n, 256) + 1) for n in (width, height))
    at = np.stack(np.meshgrid(x, y), axis=-1)
    found = place(at.reshape(-1, 2)).reshape(at.shape)
    lost = ~np.isfinite(found).all(axis=2)
    if lost.any():
        row, column = np.argwhere(lost)[0]
        raise UsageError(
            f"{where}: impossible: the camera does not see what the undistorted picture shows "
            f"at ({x[column]:.0f}, {y[row]:.0f}) px ({lost.mean():.2g} of the picture is "
            "lost); give a number of pixels"
        )
    (left, top), (right, bottom) = found.min(axis=(0, 1)), found.max(axis=(0, 1))
    beside = (-left, -top, right - width, bottom - height)
    if max(beside) > MOST * max(width, height):
        raise UsageError(
            f"{where}: needs {max(beside):.0f} px around a picture of {width} x {height}, but at "
            f"most {MOST * max(width, height):.0f} are possible; give a number of pixels"
        )
    # Rounding is not distortion: a camera without distortion needs no overscan.
    return Overscan(*(math.ceil(n) + FILTER_MARGIN if n > 0.01 else 0 for n in beside))


def overscan_of(
    wanted: object,
    camera: Camera,
    resolution: tuple[int, int],
    scene: Scene | None,
    core_scene: _core.Scene | None,
) -> Overscan:
    """Returns the overscan as given, in px; ``"undistort"``: as the camera needs it."""
    found = check_overscan(wanted, resolution)
    if found is not None:
        return found
    return to_undistort(RectifiedView(camera, resolution, scene=scene, core_scene=core_scene))
