"""Ground truth: exact values at a stated moment of the exposure, and motion in pixels.

It uses the chief ray of the pixel's centre, or means over a fixed set of the rays that expose the
pixel, at the pixel's own time: with a rolling shutter each line has another. See
docs/ground-truth.md.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core
from daguerre.camera import rolling_shutter, shutter
from daguerre.camera.camera import Camera
from daguerre.camera.overscan import NONE, Overscan
from daguerre.camera.settled import settled
from daguerre.errors import InputError, core_errors
from daguerre.frame.aovs import MEANS_CHANNELS, TRUTH_CHANNELS, Aov, Source, made_by
from daguerre.frame.world import in_world
from daguerre.scene.far import ZERO, Place
from daguerre.scene.scene import Scene
from daguerre.setup.camera import set_up
from daguerre.setup.resolved import ResolvedCamera
from daguerre.setup.scene import build

#: Moments of the exposure of a pixel, as fractions of its length.
GT_TIMES = {"open": 0.0, "mid": 0.5, "close": 1.0}
#: Rays of a pixel: the chief ray of its centre, or a mean over all rays that expose it.
GT_LENSES = ("chief", "mean")
#: Number of rays per pixel for means: default and maximum.
GT_RAYS = 64
MAX_RAYS = 65536


class Shot(NamedTuple):
    """A picture as the core takes it."""

    scene: _core.Scene
    camera: _core.Camera
    settings: _core.RenderSettings


@dataclass(frozen=True)
class Moment:
    """Scene and camera at a moment of ground truth.

    Attributes:
        shot: The moment as the core takes it.
        scene: Scene at that moment; with a rolling shutter, at the moment of the middle line.
        setup: Camera at that moment, like the scene.
    """

    shot: Shot
    scene: Scene
    setup: ResolvedCamera


@dataclass(frozen=True)
class GroundTruth:
    """Ground truth of a frame.

    Attributes:
        scene: The scene, at the time of the frame.
        camera: The camera, with resolved focus.
        resolution: Width and height of the picture, px.
        crop: Pixels (x0, y0, x1, y1), end exclusive.
        gt_time: Moment in the exposure of each pixel: open, mid or close.
        gt_lens: Rays: chief or mean.
        gt_rays: Rays per pixel for means.
        threads: Number of threads; 0: all cores.
        core_scene: Built scene for reuse, if nothing moves.
        overscan: Extra pixels around the picture that the crop may include.
        origin: Origin of the core's scene in the world, m; that of ``core_scene``, if it is given.
    """

    scene: Scene
    camera: Camera
    resolution: tuple[int, int]
    crop: tuple[int, int, int, int]
    gt_time: str
    gt_lens: str = "chief"
    gt_rays: int = GT_RAYS
    threads: int = 0
    core_scene: _core.Scene | None = None
    overscan: Overscan = NONE
    origin: Place = ZERO

    @core_errors(InputError, "render")
    def planes(self, *, motion: bool) -> dict[str, NDArray[Any]]:
        """Channels (H, W) by name; with ``motion`` also ``motion.U`` and so on, px.

        ``motion`` is the displacement of the surface point that a pixel sees to its position in the
        next frame, 1 / fps later: +U right, +V down. ``motion_back`` is that to the frame before.
        They are NaN where the point has no position there: it is behind the camera, or its instance
        is not shown then. Means also have coverage.
        """
        now = self._shot(0)
        if self.gt_lens == "mean":
            return self._means(now, motion=motion)
        seen = _core.see(now.scene, now.camera, now.settings, self.crop)
        planes = {name: np.asarray(seen.plane(name)) for name in TRUTH_CHANNELS}
        planes = in_world(planes, self.origin)
        if not motion:
            return planes
        here = seen.places(now.scene, now.camera, now.settings)
        for row in made_by(Source.MOTION):
            then = self._shot(row.frames)
            places = seen.places(then.scene, then.camera, then.settings)
            planes |= _by_channel(row, places - here)
        return planes

    def _means(self, now: Shot, *, motion: bool) -> dict[str, NDArray[Any]]:
        seen = self._see_mean(now)
        planes = {name: np.asarray(seen.plane(name)) for name in MEANS_CHANNELS}
        planes = in_world(planes, self.origin)
        for row in made_by(Source.MOTION) if motion else ():
            then = self._shot(row.frames)
            moved = _core.mean_motion(
                now.scene, now.camera, now.settings,
                then.scene, then.camera, then.settings,
                self.crop, self.gt_rays,
            )  # fmt: skip
            planes |= _by_channel(row, moved)
        return planes

    def _see_mean(self, shot: Shot) -> _core.MeanTruth:
        return _core.see_mean(shot.scene, shot.camera, shot.settings, self.crop, self.gt_rays)

    @core_errors(InputError, "render")
    def object_ids(self, moment: Moment) -> NDArray[np.uint32]:
        """Plane of object ids at ``moment(0)``, shape (H, W)."""
        shot = moment.shot
        if self.gt_lens == "mean":
            seen: Any = self._see_mean(shot)
        else:
            seen = _core.see(shot.scene, shot.camera, shot.settings, self.crop)
        return np.asarray(seen.plane("object_id"))

    def _shot(self, frames: int) -> Shot:
        return self.moment(frames).shot

    def moment(self, frames: int) -> Moment:
        """Builds scene and camera some frames later, for the moment of ground truth only."""
        own = settled(self.camera, self.scene.time)
        camera = instants(own, self.resolution)
        opens, _ = shutter.interval(own, self.scene.time, self.resolution)
        exposure = shutter.shutter_time(own)
        begin = opens + GT_TIMES[self.gt_time] * exposure + frames / self.camera.fps
        begin, end = begin, begin + shutter.core_shutter(camera, self.resolution).duration_s
        scene = self.scene.at(0.5 * (begin + end))
        core_scene = self.core_scene or build(scene, (begin, end), origin=self.origin)
        setup = set_up(scene, camera, self.resolution, core_scene, self.overscan)
        settings = _core.RenderSettings()
        settings.resolution = self.resolution
        settings.sensor_size_mm = setup.frame_size_mm
        right, up = camera.frozen_at(scene.time).shift
        settings.sensor_center_mm = (right, up)
        settings.shutter = shutter.core_shutter(camera, self.resolution)
        settings.threads = self.threads
        return Moment(Shot(core_scene, setup.core, settings), scene, setup)


def _by_channel(row: Aov, values: NDArray[Any]) -> dict[str, NDArray[Any]]:
    """Splits values (H, W, channels) into planes (H, W)."""
    return {name: values[:, :, i].astype(np.float32) for i, name in enumerate(row.channels)}


def focused(camera: Camera, distance: float | None) -> Camera:
    """Returns the camera with the focus of the picture fixed, so that it does not hunt."""
    if distance is None or "focus_distance" in camera.motion:
        return camera
    return replace(
        camera, focus_distance=distance, focus_at=None, focus_on=None, focus_from="pupil"
    )


def instants(camera: Camera, resolution: tuple[int, int]) -> Camera:
    """Returns the camera with an exposure of length 0 on each line, about the scene's time."""
    order, line_time = shutter.scan(camera, resolution)
    rolling = (
        rolling_shutter.RollingShutter(order, line_time=line_time) if order != "none" else None
    )
    return replace(
        camera,
        shutter_time=0.0,
        shutter_angle=None,
        shutter_offset=None,
        shutter_type=None,
        shutter_curve=None,
        rolling_shutter=rolling,
    )
