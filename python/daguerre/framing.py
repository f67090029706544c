"""A camera for scenes that bring none: from the front, a little above, everything in the frame."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from .camera import Camera
from .scene import Scene

#: From where: glTF's front is +z; a little to the right and above shows depth.
_TOWARD_CAMERA = np.array([0.35, 0.3, 1.0]) / math.sqrt(0.35**2 + 0.3**2 + 1)
_HALF_FIELD = math.atan(12 / 50)  # of 50 mm over the height of 24 mm


def frame_everything(scene: Scene) -> Camera | None:
    """A 50 mm camera at f/8 that has the whole scene in view; None if there is nothing to see."""
    boxes = (_world_bounds(scene, i) for i in range(len(scene.instances)))
    bounds = [box for box in boxes if box is not None]
    if not bounds:
        return None
    low = np.min([b[0] for b in bounds], axis=0)
    high = np.max([b[1] for b in bounds], axis=0)
    middle, radius = (low + high) / 2, float(np.linalg.norm(high - low)) / 2
    distance = 1.05 * max(radius, 1e-3) / math.sin(_HALF_FIELD)
    z = _TOWARD_CAMERA
    x = np.cross([0.0, 1.0, 0.0], z)
    x /= np.linalg.norm(x)
    transform = np.eye(4)
    transform[:3, 0], transform[:3, 1], transform[:3, 2] = x, np.cross(z, x), z
    transform[:3, 3] = middle + distance * z
    return Camera(transform=transform, focal_length=50.0, f_stop=8.0)


def _world_bounds(
    scene: Scene, index: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
    instance = scene.instances[index]
    points = scene.meshes[instance.mesh].positions
    if not len(points):
        return None
    box = np.array([points.min(axis=0), points.max(axis=0)], np.float64)
    corners = np.array([(box[a, 0], box[b, 1], box[c, 2]) for a, b, c in np.ndindex(2, 2, 2)])
    world = corners @ instance.transform[:3, :3].T + instance.transform[:3, 3]
    return world.min(axis=0), world.max(axis=0)
