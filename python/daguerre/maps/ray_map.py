"""Raymaps: the ray of each pixel, for programs without lens models.

A ray is the chief ray of the pixel's centre, as for ground truth (docs/ground-truth.md): it runs
through the middle of the pixel's field of view. Its time is the pixel's exposure time; with a
rolling shutter, it differs by line.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core
from daguerre.argument_checks import guarded
from daguerre.camera import shutter
from daguerre.camera.overscan import NONE, Overscan
from daguerre.camera.settled import settled
from daguerre.distortion.overscan import overscan_of
from daguerre.distortion.rectified import built
from daguerre.errors import InputError, UsageError, core_errors, suggest
from daguerre.files.value import BriefRecord
from daguerre.rendering.parameters import TABLE
from daguerre.rendering.truth import GT_TIMES, instants
from daguerre.scene.scene import Scene
from daguerre.setup.camera import set_up
from daguerre.setup.metadata import camera_metadata

if TYPE_CHECKING:
    from daguerre.camera.camera import Camera

FloatArray = NDArray[np.float64]
#: Coordinate frames of rays, and their descriptions.
FRAMES = {
    "camera": "x right, y down, z ahead (OpenCV); from the entrance pupil; m",
    "world": "the scene's: y up; m",
}
#: From the camera's own frame (x right, y up, looking along -z) to OpenCV's.
_OPENCV = np.array([1.0, -1.0, -1.0])


@guarded
@dataclass(frozen=True, repr=False)
class RayMap(BriefRecord):
    """Ray of each pixel; NaN where a pixel sees nothing.

    Attributes:
        origin: Origin of the ray, m, shape (H, W, 3): the camera's centre for ideal lenses and
            projections, a point on the ray in front of the glass for a traced lens.
        direction: Unit vectors, shape (H, W, 3).
        time: Time at which the pixel is exposed, s after the scene's time, shape (H, W).
        frame: Coordinate frame, one of ``FRAMES``: the camera's, as it stands at each ray's time,
            or the world's.
        metadata: Data of the camera, like those of frames.
    """

    origin: FloatArray
    direction: FloatArray
    time: FloatArray
    frame: str = "camera"
    metadata: dict[str, Any] = field(default_factory=dict)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes origin.X/Y/Z, direction.X/Y/Z and time.R, 32-bit OpenEXR.

        Raises:
            OutputError: The file cannot be written.
        """
        from daguerre.pictures.exr.write import attributes, write_planes

        near = self.origin - np.array(self.metadata.get("world_origin") or (0.0, 0.0, 0.0))
        planes = {
            f"{name}.{axis}": values[:, :, k].astype(np.float32)
            for name, values in (("origin", near), ("direction", self.direction))
            for k, axis in enumerate("XYZ")
        }
        planes["time.R"] = self.time.astype(np.float32)
        header = attributes(self.metadata) | {
            "daguerre:raymap": f"{self.frame}: {FRAMES[self.frame]}"
        }
        for name in ("chromaticities", "colorInteropID"):  # there is no colour in it
            header.pop(name)
        write_planes(path, header, planes, self.metadata)


@guarded
def raymap(
    camera: Camera,
    resolution: tuple[int, int],
    *,
    scene: Scene | None = None,
    gt_time: str = "mid",
    frame: str = "camera",
    overscan: object = None,
) -> RayMap:
    """Returns the ray of each pixel of any camera.

    Args:
        camera: Pinhole, thin, thick, exact, polynomial or projection.
        resolution: Width and height of the picture, px.
        scene: Scene, for its time and for autofocus; without it the camera then focuses at
            infinity.
        gt_time: Moment in the exposure of each pixel: open, mid or close.
        frame: Coordinate frame. ``"camera"``: OpenCV's, x right, y down, z ahead, from the entrance
            pupil, as the camera stands at the ray's time; ``"world"``: the scene's.
        overscan: Extra pixels around the picture, see ``Session``.

    Raises:
        UsageError: A parameter is out of its range.
    """
    from daguerre.rendering.pixels import check_resolution

    size = check_resolution(resolution)
    check_frame(frame)
    moment = TABLE["gt_time"].check(gt_time, "gt_time") or "mid"
    core_scene = built(scene, camera, size)
    wanted = overscan_of(overscan, camera, size, scene, core_scene)
    return rays_of(camera, size, scene or Scene(), core_scene, moment, frame, wanted)


def check_frame(frame: str, where: str = "frame") -> None:
    """Checks the name of a coordinate frame."""
    if frame not in FRAMES:
        raise UsageError(
            f"{where}: wanted {' or '.join(FRAMES)}, got {frame!r}{suggest(str(frame), FRAMES)}"
        )


def rays_of(
    camera: Camera,
    size: tuple[int, int],
    scene: Scene,
    core_scene: _core.Scene | None,
    gt_time: str,
    frame: str,
    overscan: Overscan = NONE,
) -> RayMap:
    """Returns the rays like ``raymap``, for checked arguments."""
    camera = settled(camera, scene.time)
    now = instants(camera, size)
    opens, _ = shutter.interval(camera, scene.time, size)
    begin = opens + GT_TIMES[gt_time] * shutter.shutter_time(camera)
    duration = shutter.core_shutter(now, size).duration_s
    # An exposure of length 0 takes place at the scene's time.
    at = scene.at(begin + duration / 2)
    setup = set_up(at, now, size, core_scene, overscan)
    settings = _core.RenderSettings()
    settings.resolution = size
    settings.sensor_size_mm = setup.frame_size_mm
    right, up = setup.shift_mm
    settings.sensor_center_mm = (right, up)
    settings.shutter = shutter.core_shutter(now, size)
    world = frame == "world"
    with core_errors(InputError, "render"):
        origin, direction, time = _core.ray_map(setup.core, settings, overscan.region(size), world)
    if world:
        origin = origin + np.array(setup.origin)
    else:
        origin, direction = origin * _OPENCV, direction * _OPENCV
    seconds = begin - scene.time + time * duration
    facts = camera_metadata(now, setup, size[0]) | {
        "time": at.time,
        "gt_time": gt_time,
        "resolution": size,
        "crop": overscan.region(size),
        "overscan": str(overscan) if overscan else None,
        "world_origin": list(setup.origin) if world and any(setup.origin) else None,
        "version": _core.__version__,
    }
    return RayMap(origin, direction, seconds, frame, facts)
