"""Makes cameras from calibration files; ``Camera.from_opencv`` etc. document the parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .files import read
from .opentrackio import read_opentrackio
from .ros import read_ros
from .track import is_take, read_track

if TYPE_CHECKING:
    from daguerre.camera.camera import Camera


def read_camera(
    format: str, source: Any, camera: Camera | None, pixel_pitch: float | None, **options: Any
) -> Camera:
    """Makes a camera from a calibration in a format, with the options of its method of ``Camera``.

    Samples of OpenTrackIO make a tracked camera: one sample as it is, several as keys.
    """
    if format == "opentrackio":
        if isinstance(source, list) or is_take(source):
            return read_track(source, camera=camera, pixel_pitch=pixel_pitch, **options)
        return read_opentrackio(source, **options).camera(camera, pixel_pitch)
    if format == "ros":
        return read_ros(source, **options).camera(camera, pixel_pitch)
    name, timeshift = options.pop("name"), options.pop("timeshift", False)
    found = read(source, name, format=format, **options)
    return found.camera(camera, pixel_pitch, timeshift=timeshift)
