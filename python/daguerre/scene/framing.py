"""Camera for scenes without a camera: from the front, slightly above, all in view."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from daguerre.camera.camera import Camera

from .parts import reach_of
from .scene import Scene

FloatArray = NDArray[np.float64]
#: Direction to the camera: glTF's front is +z; slightly right and above shows depth.
_TOWARD_CAMERA = np.array([0.35, 0.3, 1.0]) / math.sqrt(0.35**2 + 0.3**2 + 1)
_HALF_FIELD = math.atan(12 / 50)  # of 50 mm over the height of 24 mm


#: Name of this camera.
NAME = "framing"


def is_framed(scene: Scene) -> bool:
    """Whether the scene has no other camera than the default camera of this module."""
    return list(scene.cameras) == [NAME]


def frame_everything(scene: Scene) -> Camera | None:
    """Makes a 50 mm camera at f/8 with the whole scene in view; None if the scene is empty."""
    corners = bounds(scene)
    if corners is None:
        return None
    low, high = corners
    middle, radius = (low + high) / 2, float(np.linalg.norm(high - low)) / 2
    distance = 1.05 * max(radius, 1e-3) / math.sin(_HALF_FIELD)
    z = _TOWARD_CAMERA
    x = np.cross([0.0, 1.0, 0.0], z)
    x /= np.linalg.norm(x)
    transform = np.eye(4)
    transform[:3, 0], transform[:3, 1], transform[:3, 2] = x, np.cross(z, x), z
    transform[:3, 3] = middle + distance * z
    return Camera(transform=transform, focal_length=50.0, f_stop=8.0)


def bounds(scene: Scene) -> tuple[FloatArray, FloatArray] | None:
    """Corners (3,) of the box around all visible instances, m; None if there are none."""
    filled = [i for i in scene.instances if i.shown and len(scene.meshes[i.mesh].positions)]
    if not filled:
        return None
    boxes = {}
    for mesh in {instance.mesh for instance in filled}:
        points, reach = scene.meshes[mesh].positions, reach_of(scene.meshes[mesh])
        low = points.min(axis=0).astype(float) - reach + scene.meshes[mesh].origin
        high = points.max(axis=0).astype(float) + reach + scene.meshes[mesh].origin
        boxes[mesh] = (low + high) / 2, (high - low) / 2
    centers, halves = np.array([boxes[i.mesh] for i in filled]).swapaxes(0, 1)
    matrices = np.array([i.transform for i in filled])
    # A rotated box reaches along an axis by the sum of its projected half edges.
    middles = np.einsum("nij,nj->ni", matrices[:, :3, :3], centers) + matrices[:, :3, 3]
    around = np.einsum("nij,nj->ni", np.abs(matrices[:, :3, :3]), halves)
    return (middles - around).min(axis=0), (middles + around).max(axis=0)
