"""Placement of a camera by position, aim and roll; the world's +y is up."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from daguerre.argument_checks import guarded
from daguerre.checks import number, numbers
from daguerre.errors import UsageError

if TYPE_CHECKING:
    from .camera import Camera

_POINT = "a point (x, y, z), m"


@guarded
def look_at(
    position: tuple[float, float, float], target: tuple[float, float, float], roll: float = 0.0
) -> NDArray[np.float64]:
    """Returns the ``transform`` of a camera that looks at a point.

    Args:
        position: Position of the camera, m.
        target: Point in the middle of its picture, m.
        roll: Roll about the view direction, degrees; 0 is level, positive turns the camera
            clockwise as its photographer sees it. A camera that looks straight down has -z at the
            top of its picture; straight up, +z.

    Returns:
        World from camera, shape (4, 4), float64.

    Raises:
        UsageError: Both points are the same, or a value is not finite.
    """
    origin = np.array(numbers(position, "look_at: position", 3, _POINT))
    aim = np.array(numbers(target, "look_at: target", 3, _POINT)) - origin
    if not np.any(aim):
        raise UsageError("look_at: target: must differ from the position")
    return _placed(origin, aim, number(roll, "look_at: roll"))


@dataclass(frozen=True)
class Placement:
    """Changes to where a camera stands and looks; None keeps the camera's own.

    Attributes:
        position: Position, m.
        look_at: Point in the middle of the picture, m; levels the camera.
        roll: Roll about the view direction, degrees, from level.
    """

    position: tuple[float, float, float] | None = None
    look_at: tuple[float, float, float] | None = None
    roll: float | None = None

    @property
    def given(self) -> bool:
        """Whether anything changes."""
        return self != Placement()

    @property
    def complete(self) -> bool:
        """Whether nothing of the camera's own place remains."""
        return self.position is not None and self.look_at is not None

    def of(self, camera: Camera) -> Camera:
        """Returns the camera at this place, where it no longer moves."""
        if not self.given:
            return camera
        pose = np.asarray(camera.transform, np.float64).copy()
        if self.position is not None:
            pose[:3, 3] = self.position
        if self.look_at is not None:
            pose = look_at(tuple(pose[:3, 3]), self.look_at, self.roll or 0.0)
        elif self.roll is not None:
            pose = _placed(pose[:3, 3], -pose[:3, 2], self.roll)
        return camera.with_(transform=pose)


def _placed(
    position: NDArray[np.float64], direction: NDArray[np.float64], roll: float
) -> NDArray[np.float64]:
    """World from camera with this view direction, at a roll (degrees) from level."""
    forward = direction / np.linalg.norm(direction)
    right = np.array([-forward[2], 0.0, forward[0]])  # forward x up
    length = np.linalg.norm(right)
    # Level is undefined there; near it, roundings would choose the side that is up.
    right = right / length if length > 1e-9 else np.array([1.0, 0.0, 0.0])
    up = np.cross(right, forward)
    cos, sin = math.cos(math.radians(roll)), math.sin(math.radians(roll))
    out = np.eye(4)
    out[:3, 0], out[:3, 1] = cos * right - sin * up, cos * up + sin * right
    out[:3, 2], out[:3, 3] = -forward, position
    return out
