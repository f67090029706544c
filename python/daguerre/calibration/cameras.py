"""Makes cameras from calibration files; ``Camera.from_opencv`` etc. document the parameters."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import TYPE_CHECKING

from daguerre.files.source import Source

from .files import read
from .opentrackio import read_opentrackio
from .ros import read_ros
from .track import is_take, read_track

if TYPE_CHECKING:
    from daguerre.camera.camera import Camera


@dataclass(frozen=True)
class CalibratedCameras:
    """Makes cameras from calibrations.

    Attributes:
        camera: Camera that gives all other parameters; None: the default camera.
        pixel_pitch: Pixel pitch of the calibrated sensor, um; None: as the calibration has it.
    """

    camera: Camera | None
    pixel_pitch: float | None

    def from_opencv(
        self,
        calibration: Source,
        name: str | None,
        *,
        model: str | None,
        size: tuple[int, int] | None,
        rectified: bool,
        unit_m: float,
    ) -> Camera:
        """Makes a camera from an OpenCV calibration."""
        found = read(
            calibration,
            name,
            format="opencv",
            model=model,
            size=size,
            rectified=rectified,
            unit_m=unit_m,
        )
        return found.camera(self.camera, self.pixel_pitch)

    def from_ros(self, calibration: Source, *, rectified: bool) -> Camera:
        """Makes a camera from a ROS ``camera_info``."""
        found = read_ros(calibration, rectified=rectified)
        return found.camera(self.camera, self.pixel_pitch)

    def from_kalibr(self, calibration: Source, name: str | None, *, timeshift: bool) -> Camera:
        """Makes a camera from a Kalibr camera chain."""
        found = read(calibration, name, format="kalibr")
        return found.camera(self.camera, self.pixel_pitch, timeshift=timeshift)

    def from_colmap(
        self, folder: str | os.PathLike[str], name: str | None, *, unit_m: float
    ) -> Camera:
        """Makes the camera of a picture in a COLMAP model."""
        found = read(folder, name, format="colmap", unit_m=unit_m)
        return found.camera(self.camera, self.pixel_pitch)

    def from_opentrackio(
        self, calibration: Source | list[Source], *, size: tuple[int, int] | None
    ) -> Camera:
        """Makes a tracked camera from one sample, or with keys from several."""
        camera, pixel_pitch = self.camera, self.pixel_pitch
        if isinstance(calibration, list) or is_take(calibration):
            return read_track(calibration, size=size, camera=camera, pixel_pitch=pixel_pitch)
        return read_opentrackio(calibration, size=size).camera(camera, pixel_pitch)
