"""Cameras by calibration files, for ``Camera.from_opencv`` and its kin, which explain them."""

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
    """A camera as OpenCV calibrated it."""
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
    """A camera by its ROS ``camera_info``."""
    return read_ros(calibration, rectified=rectified).camera(camera, pixel_pitch)


def from_kalibr(
    calibration: Source,
    name: str | None,
    timeshift: bool,
    camera: Camera | None,
    pixel_pitch: float | None,
) -> Camera:
    """A camera of Kalibr's chain."""
    found = read(calibration, name, format="kalibr")
    return found.camera(camera, pixel_pitch, timeshift=timeshift)


def from_colmap(
    folder: str | os.PathLike[str],
    name: str | None,
    unit_m: float,
    camera: Camera | None,
    pixel_pitch: float | None,
) -> Camera:
    """The camera of a picture of a COLMAP model."""
    return read(folder, name, format="colmap", unit_m=unit_m).camera(camera, pixel_pitch)


def from_opentrackio(
    calibration: Source | list[Source],
    size: tuple[int, int] | None,
    camera: Camera | None,
    pixel_pitch: float | None,
) -> Camera:
    """A tracked camera of one sample, or with keys of several."""
    if isinstance(calibration, list) or is_take(calibration):
        return read_track(calibration, size=size, camera=camera, pixel_pitch=pixel_pitch)
    return read_opentrackio(calibration, size=size).camera(camera, pixel_pitch)
