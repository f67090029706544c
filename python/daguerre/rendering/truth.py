"""Ground truth: exact values at a stated time of the exposure, and motion in pixels.

One ray per pixel, the chief ray of the pixel's centre, or means over a fixed set of the rays that
expose it, at the pixel's own moment: with a rolling shutter each line has its own. See
docs/ground-truth.md.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core
from daguerre.camera import rolling_shutter, shutter
from daguerre.camera.camera import Camera
from daguerre.camera.overscan import NONE, Overscan
from daguerre.checks import short, whole
from daguerre.errors import UsageError, suggest
from daguerre.frame.aovs import COVERAGE, MOTION, PLANES
from daguerre.scene.scene import Scene
from daguerre.setup.camera import set_up
from daguerre.setup.resolved import ResolvedCamera
from daguerre.setup.scene import build

Shot = tuple[_core.Scene, _core.Camera, _core.RenderSettings]
#: When in the exposure of a pixel: as a fraction of its length.
GT_TIMES = {"open": 0.0, "mid": 0.5, "close": 1.0}
#: Through which rays: the chief ray of the pixel's centre, or all that expose it.
GT_LENSES = ("chief", "mean")
#: How many of those are drawn.
GT_RAYS = 64
MAX_RAYS = 65536


def check_gt_time(gt_time: str | None, *, wanted: bool, where: str = "gt_time") -> str | None:
    """The moment of ground truth, or None; what is ``wanted`` without one is that of the middle.

    Raises:
        UsageError: There is no such moment.
    """
    if gt_time is None:
        return "mid" if wanted else None
    if str(gt_time) not in GT_TIMES:
        known = ", ".join(GT_TIMES)
        raise UsageError(
            f"{where}: wanted {known}, got {short(gt_time)}{suggest(str(gt_time), GT_TIMES)}"
        )
    return gt_time


def check_gt_lens(
    gt_lens: str, gt_rays: int | None, *, where: tuple[str, str] = ("gt_lens", "gt_rays")
) -> int:
    """How many rays of each pixel ground truth takes.

    Raises:
        UsageError: There is no such kind, or the number goes with means alone.
    """
    if str(gt_lens) not in GT_LENSES:
        known = " or ".join(GT_LENSES)
        raise UsageError(
            f"{where[0]}: wanted {known}, got {short(gt_lens)}{suggest(str(gt_lens), GT_LENSES)}"
        )
    if gt_lens == "chief":
        if gt_rays is not None:
            raise UsageError(f"{where[1]}: the chief ray is one; wanted {where[0]} mean too")
        return 1
    return whole(GT_RAYS if gt_rays is None else gt_rays, where[1], 1, MAX_RAYS)


@dataclass(frozen=True)
class Moment:
    """Scene and camera at a moment of ground truth.

    Attributes:
        shot: The core's shot.
        scene: The scene then; with a rolling shutter, when the line in the middle opens.
        setup: The camera, likewise.
    """

    shot: Shot
    scene: Scene
    setup: ResolvedCamera


@dataclass(frozen=True)
class GroundTruth:
    """Ground truth of a frame.

    Attributes:
        scene: The scene; its time is that of the frame.
        camera: The camera, its focus chosen.
        resolution: Width and height, px.
        crop: Pixels (x0, y0, x1, y1), end exclusive.
        gt_time: Moment in the exposure of each pixel: open, mid or close.
        gt_lens: chief or mean: through which rays.
        gt_rays: Rays per pixel for means.
        threads: 0: all cores.
        core_scene: The scene if it does not move, so that it need not be built again.
        overscan: Pixels around the picture that the crop may have, too.
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

    def planes(self, *, motion: bool) -> dict[str, NDArray[Any]]:
        """Channels (H, W) by name: ``PLANES``, and with ``motion`` also ``motion.U``, ... in px.

        ``motion`` is where the surface point that a pixel sees appears in the next frame, 1 / fps
        later, minus where it is now: +U right, +V down. ``motion_back``: the frame before. NaN
        where it does not appear there, hidden or behind the camera. Means also have ``COVERAGE``.
        """
        now = self._shot(0)
        if self.gt_lens == "mean":
            return self._means(now, motion=motion)
        seen = _core.see(*now, self.crop)
        planes: dict[str, NDArray[Any]] = {name: np.asarray(seen.plane(name)) for name in PLANES}
        if not motion:
            return planes
        here = seen.places(*now)
        for name, frames in MOTION.items():
            moved = seen.places(*self._shot(frames)) - here
            for axis, channel in enumerate("UV"):
                planes[f"{name}.{channel}"] = moved[:, :, axis].astype(np.float32)
        return planes

    def _means(self, now: Shot, *, motion: bool) -> dict[str, NDArray[Any]]:
        seen = _core.see_mean(*now, self.crop, self.gt_rays)
        names = (*PLANES, COVERAGE)
        planes: dict[str, NDArray[Any]] = {name: np.asarray(seen.plane(name)) for name in names}
        for name, frames in MOTION.items() if motion else ():
            moved = _core.mean_motion(*now, *self._shot(frames), self.crop, self.gt_rays)
            for axis, channel in enumerate("UV"):
                planes[f"{name}.{channel}"] = moved[:, :, axis].astype(np.float32)
        return planes

    def object_ids(self, moment: Moment) -> NDArray[np.uint32]:
        """That plane alone, (H, W), of ``moment(0)``."""
        if self.gt_lens == "mean":
            seen: Any = _core.see_mean(*moment.shot, self.crop, self.gt_rays)
        else:
            seen = _core.see(*moment.shot, self.crop)
        return np.asarray(seen.plane("object_id"))

    def _shot(self, frames: int) -> Shot:
        return self.moment(frames).shot

    def moment(self, frames: int) -> Moment:
        """Scene and camera some frames later, built for the moments of ground truth alone."""
        camera = instants(self.camera, self.resolution)
        opens, _ = shutter.interval(self.camera, self.scene.time, self.resolution)
        exposure = shutter.shutter_time(self.camera)
        begin = opens + GT_TIMES[self.gt_time] * exposure + frames / self.camera.fps
        begin, end = begin, begin + shutter.core_shutter(camera, self.resolution).duration_s
        scene = self.scene.at(0.5 * (begin + end))
        core_scene = self.core_scene or build(scene, (begin, end))
        setup = set_up(scene, camera, self.resolution, core_scene, self.overscan)
        settings = _core.RenderSettings()
        settings.resolution = self.resolution
        settings.sensor_size_mm = setup.frame_size_mm
        right, up = camera.frozen_at(scene.time).shift
        settings.sensor_center_mm = (right, up)
        settings.shutter = shutter.core_shutter(camera, self.resolution)
        settings.threads = self.threads
        return Moment((core_scene, setup.core, settings), scene, setup)


def focused(camera: Camera, distance: float | None) -> Camera:
    """The camera with the focus that was found for the picture: it does not hunt between frames."""
    if distance is None or "focus_distance" in camera.motion:
        return camera
    return replace(
        camera, focus_distance=distance, focus_at=None, focus_on=None, focus_from="pupil"
    )


def instants(camera: Camera, resolution: tuple[int, int]) -> Camera:
    """The camera with an exposure of no length, around the scene's time, on each of its lines."""
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
