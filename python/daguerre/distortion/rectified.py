"""Maps pixels between a camera and its rectified (ideal) twin.

Pixel centres are at halves: (0, 0) is the upper left corner of the picture.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core
from daguerre.cached import cached_property
from daguerre.camera import shutter
from daguerre.camera.camera import Camera
from daguerre.camera.overscan import NONE, Overscan
from daguerre.camera.settled import settled
from daguerre.errors import InputError, UsageError, core_errors
from daguerre.scene.scene import Scene
from daguerre.setup.camera import set_up
from daguerre.setup.origin import origin_of

FloatArray = NDArray[np.float64]


class RectifiedView:
    """Maps pixels between a camera in the middle of its exposure and its rectified (ideal) twin.

    The ideal camera is the pinhole with the same focal length near the axis, principal point and
    squeeze: a rectilinear picture, in which straight lines are straight. The map is for points on
    the plane in focus, since the entrance pupil of a real lens moves with the angle.

    Args:
        camera: Its focus must be stated, or the scene given.
        resolution: Width and height of the picture, px.
        scene: Scene, for autofocus and the time.
        core_scene: The built scene.
        overscan: Pixels around the picture that are mapped, too.
    """

    def __init__(
        self,
        camera: Camera,
        resolution: tuple[int, int],
        *,
        scene: Scene | None = None,
        core_scene: _core.Scene | None = None,
        overscan: Overscan = NONE,
    ) -> None:
        scene = scene or Scene()
        begin, end = shutter.interval(camera, scene.time, resolution)
        still = camera.frozen_at(0.5 * (begin + end))
        self.resolution = resolution
        self.setup = set_up(scene, still, resolution, core_scene, overscan=overscan)
        lens = self.setup.lens
        self._center = np.array(self.setup.shift_mm)
        self._pitch = np.array(self.setup.frame_size_mm) / resolution
        with core_errors(InputError, "render"):
            self._chief = self.setup.core.chief_rays()
        if lens.projection is None:
            f = lens.pinhole_focal_length_mm
            self._focal = np.array([f / lens.squeeze, f])
            self._principal = np.zeros(2)
        else:
            if lens.projection.model == "cube":
                raise UsageError("stmap: projection: wanted one that can be undistorted, got cube")
            film = lens.projection.film(self.setup.frame_size_mm[0])
            self._focal, self._principal = map(np.array, (film["focal_mm"], film["principal_mm"]))

    def __repr__(self) -> str:
        return "<RectifiedView {}x{}>".format(*self.resolution)

    @cached_property
    def distance(self) -> float:
        """Distance of the plane on which both cameras are compared, m."""
        distance = self.setup.lens.focus_distance_m
        return math.inf if distance is None else distance

    def bent_from_straight(self, pixels: FloatArray) -> FloatArray:
        """Maps points (N, 2) of the ideal picture to the camera's, px; NaN: not visible."""
        slopes = (self._film(pixels) - self._principal) / self._focal
        ahead = np.column_stack([slopes, -np.ones(len(slopes))])
        endless = math.isinf(self.distance)
        points = ahead if endless else ahead * self.distance
        return self._pixels(self._chief.film_points(np.ascontiguousarray(points), endless))

    def straight_from_bent(self, pixels: FloatArray) -> FloatArray:
        """Maps points (N, 2) of the camera's picture to the ideal one's, px; NaN: not visible."""
        origins, directions = self._chief.rays(np.ascontiguousarray(self._film(pixels)))
        seen = self.sees(pixels)
        ahead = -directions[:, 2]
        known = seen & (ahead > 1e-9)
        ahead = np.where(known, ahead, np.nan)
        slopes = directions[:, :2] / ahead[:, None]
        if math.isfinite(self.distance):
            # The ray meets the plane z = -distance at origin + way * direction.
            slopes = (origins[:, :2] + (self.distance + origins[:, 2:]) * slopes) / self.distance
        return self._pixels(slopes * self._focal + self._principal)

    def sees(self, pixels: FloatArray) -> NDArray[np.bool_]:
        """Whether light reaches points (N, 2), px."""
        film = np.ascontiguousarray(self._film(pixels))
        return np.asarray(self._chief.sees(self.setup.core, film))

    def _film(self, pixels: FloatArray) -> FloatArray:
        """Film points (mm, upright) of pixels."""
        away = np.asarray(pixels, np.float64) - np.array(self.resolution) / 2
        return np.asarray(away * self._pitch * (1, -1) + self._center)

    def _pixels(self, film: FloatArray) -> FloatArray:
        away = (film - self._center) * (1, -1) / self._pitch
        return np.asarray(away + np.array(self.resolution) / 2)


def built(scene: Scene | None, camera: Camera, resolution: tuple[int, int]) -> _core.Scene | None:
    """Builds the scene for a camera's autofocus; None: no scene."""
    if scene is None:
        return None
    from daguerre.setup.scene import build

    camera = settled(camera, scene.time)
    origin = origin_of(camera, scene.time, resolution)
    return build(scene, shutter.interval(camera, scene.time, resolution), origin=origin)
