"""Frames of Blender (z-up, in units of the scene) and of a ``Scene`` (y-up, metres)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import bpy


Matrix = NDArray[np.float64]

#: (x, y, z) of Blender is (x, z, -y) here.
AXES: Matrix = np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])


def metres_per_unit(scene: bpy.types.Scene) -> float:
    """Length of a unit of a Blender scene, m."""
    return float(scene.unit_settings.scale_length)


def world_from_blender(scene: bpy.types.Scene) -> Matrix:
    """World (m, y-up) from the world of a Blender scene, shape (4, 4)."""
    scale = metres_per_unit(scene)
    return np.asarray(AXES @ np.diag([scale, scale, scale, 1.0]))


def seconds_per_frame(scene: bpy.types.Scene) -> float:
    """Time of a frame of a Blender scene, s."""
    return float(scene.render.fps_base) / float(scene.render.fps)
