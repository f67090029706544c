"""Geometry of a ball in a photograph: mirrored directions and normals of pixels.

The camera looks along -z with +y up. Pixels are counted from the upper left corner, with centres
at + 0.5. The surroundings are taken as far away compared with the ball's radius.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .latlong import FloatArray

Circle = tuple[float, float, float]
#: Distance from the outline within which pixels are not used, px, as they show the background.
INSIDE = 1.25


@dataclass(frozen=True)
class Ball:
    """A ball in a photograph.

    Attributes:
        circle: Centre and radius of its outline, px.
        axis: Unit vector from the camera to its centre, shape (3,).
        sine: Radius over distance; 0: seen from far away, without perspective.
        focal_px: Focal length, px; infinite: seen from far away.
        centre: Principal point, px.
    """

    circle: Circle
    axis: tuple[float, float, float] = (0.0, 0.0, -1.0)
    sine: float = 0.0
    focal_px: float = math.inf
    centre: tuple[float, float] = (0.0, 0.0)

    @property
    def unseen_deg(self) -> float:
        """Half angle of the directions that the ball hides, around the view direction, degrees."""
        inside = 1 - INSIDE / self.circle[2]
        if self.sine == 0:
            return 180 - 2 * math.degrees(math.asin(inside))
        normal, seen = self._turns()
        return 180 - math.degrees(np.interp(inside * seen[-1], seen, 2 * normal + seen))

    def mirrored(self, toward: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Returns the points of the picture in which directions are mirrored.

        Args:
            toward: Unit directions in the camera's frame, shape (N, 3).

        Returns:
            Points in px, shape (N, 2), and angles to the direction from ball to camera, rad, (N,).
            Directions that the ball hides are on its rim.
        """
        back = -np.array(self.axis)
        along = np.clip(toward @ back, -1, 1)
        side = toward - along[:, None] * back
        length = np.linalg.norm(side, axis=1)
        side /= np.maximum(length, 1e-12)[:, None]
        angle = np.arctan2(length, along)
        if self.sine == 0:
            x, y, radius = self.circle
            off = np.minimum(radius * np.sin(angle / 2), radius - INSIDE)
            return np.stack([x + off * side[:, 0], y - off * side[:, 1]], axis=1), angle
        seen = self._seen_at(angle)
        ray = np.cos(seen)[:, None] * -back + np.sin(seen)[:, None] * side
        return self._place(ray), angle

    def _seen_at(self, angle: FloatArray) -> FloatArray:
        """Angle from the camera between the ball's centre and the point that mirrors a direction.

        If the normal is at angle t from the direction to the camera, the camera sees the point at
        g = atan(s sin t / (1 - s cos t)), with s the radius over distance. The mirrored ray leaves
        at 2 t + g, which grows with t and is inverted by a table.
        """
        normal, seen = self._turns()
        inside = seen[-1] * (1 - INSIDE / self.circle[2])
        return np.asarray(np.minimum(np.interp(angle, 2 * normal + seen, seen), inside))

    def _turns(self) -> tuple[FloatArray, FloatArray]:
        """Table of t and g from the centre of the ball to its outline, rad."""
        normal = np.linspace(0, math.acos(self.sine), 4096)
        return normal, np.arctan2(self.sine * np.sin(normal), 1 - self.sine * np.cos(normal))

    def _place(self, ray: FloatArray) -> FloatArray:
        scale = self.focal_px / -ray[:, 2]
        return np.stack(
            [self.centre[0] + scale * ray[:, 0], self.centre[1] - scale * ray[:, 1]], axis=1
        )

    def normals(self, places: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Normals of the ball at places of the picture, in the camera's frame.

        Args:
            places: px, shape (N, 2).

        Returns:
            Unit normals, shape (N, 3), and cosines toward the camera, shape (N,); beside the ball
            cosines are NaN.
        """
        if self.sine == 0:
            x, y, radius = self.circle
            flat = (places - (x, y)) / (radius, -radius)
            with np.errstate(invalid="ignore"):
                front = np.sqrt(1 - (flat**2).sum(axis=1))
            return np.column_stack([flat, front]), front
        off = (places - self.centre) / (self.focal_px, -self.focal_px)
        ray = np.column_stack([off, np.full(len(off), -1.0)])
        ray /= np.linalg.norm(ray, axis=1)[:, None]
        # The nearer crossing of the ray with a ball of radius `sine` at distance 1.
        along = ray @ np.array(self.axis)
        with np.errstate(invalid="ignore"):
            near = along - np.sqrt(along**2 - 1 + self.sine**2)
        normal = (near[:, None] * ray - np.array(self.axis)) / self.sine
        return normal, -(normal * ray).sum(axis=1)


def seen_ball(circle: Circle, outline: FloatArray, size: tuple[int, int], focal_px: float) -> Ball:
    """Finds the ball from points on its outline.

    Rays c to the outline lie on a cone with axis a and half angle h: c . a = cos h. So c . m = 1
    with m = a / cos h, which is linear in m.

    Args:
        circle: Centre and radius of the outline, px.
        outline: Points on the outline, px, shape (N, 2).
        size: Width and height of the picture, px.
        focal_px: Focal length, px; infinite: seen from far away.
    """
    if math.isinf(focal_px):
        return Ball(circle)
    centre = (size[0] / 2, size[1] / 2)
    off = (outline - centre) / (focal_px, -focal_px)
    rays = np.column_stack([off, np.full(len(off), -1.0)])
    rays /= np.linalg.norm(rays, axis=1)[:, None]
    m = np.linalg.lstsq(rays, np.ones(len(rays)), rcond=None)[0]
    length = float(np.linalg.norm(m))
    axis = m / length
    sine = math.sqrt(max(1 - 1 / length**2, 0.0))
    return Ball(circle, (axis[0], axis[1], axis[2]), sine, focal_px, centre)


def points_on(circle: Circle, count: int = 360) -> FloatArray:
    """Points on a circle, px, shape (N, 2)."""
    angle = np.arange(count) * (2 * np.pi / count)
    x, y, radius = circle
    return np.stack([x + radius * np.cos(angle), y + radius * np.sin(angle)], axis=1)
