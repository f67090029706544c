"""Makes cameras from calibration files; ``Camera.from_opencv`` etc. document the parameters."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from daguerre.files.source import Source

from .files import read
from .opentrackio import read_opentrackio
from .ros import read_ros
from .track import is_take, read_track

if TYPE_CHECKING:
    from daguerre.camera.camera import Camera


def from_opencv(
    calibration: Source,
    name: str | None,
    camera: Camera | None,
    pixel_pitch: float | None,
    *,
    model: str | None,
    size: tuple[int, int] | None,
    rectified: bool,
    unit_m: float,
) -> Camera:
    """Makes a camera from an OpenCV calibration."""
    found = read(
        *(calibration, name),
        format="opencv",
        model=model,
        size=size,
        rectified=rectified,
        unit_m=unit_m,
    )
    return found.camera(camera, pixel_pitch)


def from_ros(
    calibration: Source, rectified: bool, camera: Camera | None, pixel_pitch: float | None
) -> Camera:
    """Makes a camera from a ROS ``camera_info``."""
    return read_ros(calibration, rectified=rectified).camera(camera, pixel_pitch)


def from_kalibr(
    calibration: Source,
    name: str | None,
    timeshift: bool,
    camera: Camera | None,
    pixel_pitch: float | None,
) -> Camera:
    """Makes a camera from a Kalibr camera chain."""
    found = read(calibration, name, format="kalibr")
    return found.camera(camera, pixel_pitch, timeshift=timeshift)


def from_colmap(
    folder: str | os.PathLike[str],
    name: str | None,
    unit_m: float,
    camera: Camera | None,
    pixel_pitch: float | None,
) -> Camera:
    """Makes the camera of a picture in a COLMAP model."""
    return read(folder, name, format="colmap", unit_m=unit_m).camera(camera, pixel_pitch)


def from_opentrackio(
    calibration: Source | list[Source],
    size: tuple[int, int] | None,
    camera: Camera | None,
    pixel_pitch: float | None,
) -> Camera:
    """Makes a tracked camera from one sample, or with keys from several."""
    if isinstance(calibration, list) or is_take(calibration):
        return read_track(calibration, size=size, camera=camera, pixel_pitch=pixel_pitch)
    return read_opentrackio(calibration, size=size).camera(camera, pixel_pitch)
