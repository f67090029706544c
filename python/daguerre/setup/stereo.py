"""Parallax of stereo pairs with a fixed baseline, by the direction of sight."""

from __future__ import annotations

import math

import numpy as np

from daguerre.camera.camera import Camera
from daguerre.camera.projection import Projection

#: Angle to the side from which a pair gets a note: a quarter of the parallax ahead is left there.
_WIDE_DEG = math.degrees(math.acos(0.25))


def stereo_note(camera: Camera) -> str:
    """Returns a note if a stereo pair of a camera lacks parallax at its sides; else nothing.

    Both cameras of a pair look ahead, so parallax falls with the cosine of the angle to the side.

    Args:
        camera: The camera between both.
    """
    side = 0.0 if camera.projection is None else _side_deg(camera.projection)
    if side < _WIDE_DEG:
        return ""
    behind = ", reversed behind" if side > 90 else ""
    return (
        "stereo: both cameras look ahead, so parallax falls with the cosine of the angle to the "
        f"side: none at 90 degrees{behind}; this picture reaches {side:.0f} degrees"
    )


def _side_deg(projection: Projection) -> float:
    """Largest angle to the left or right of the axis, degrees."""
    if projection.model in ("equirectangular", "cube"):
        return 180.0
    y = projection.center[1]
    seen = projection.unproject([[-0.5, y], [projection.size[0] - 0.5, y]])
    angles = np.degrees(np.arctan2(np.hypot(seen[:, 0], seen[:, 1]), seen[:, 2]))
    return float(np.nan_to_num(angles, nan=projection.largest_angle).max())
