"""Writes cameras for other programs."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from daguerre.argument_checks import guarded
from daguerre.camera.camera import Camera
from daguerre.checks import numbers, short
from daguerre.errors import UsageError
from daguerre.files import formats
from daguerre.scene.scene import Scene


@guarded
def export_camera(
    camera: Camera | dict[str, Camera] | Scene,
    path: str | Path,
    *,
    times: tuple[float, float] | None = None,
) -> None:
    """Writes cameras as a USD stage (.usda, .usdc, .usd), whole or not at all.

    Each camera is a ``UsdGeomCamera`` with all attributes that UsdGeomCamera has, NVIDIA's
    attributes for calibrations and rolling shutters, and ``daguerre:*`` for the rest
    (``docs/usd.md``).

    Args:
        camera: A camera, several by name, or all of a scene.
        path: The file.
        times: Begin and end of animated values, s; None: the first and last key. A motion without
            end, such as a spin, needs them.

    Raises:
        UsageError: There is no camera, or a camera has a part that no stage can hold, such as a
            lens that is in no file; or USD is not installed.
        OutputError: The file cannot be written.
    """
    if isinstance(camera, Camera):
        cameras: Mapping[Any, Any] = {"camera": camera}
    else:
        cameras = camera.cameras if isinstance(camera, Scene) else camera
    if not cameras:
        raise UsageError("export_camera: camera: no camera given")
    for name, value in cameras.items():
        if not isinstance(name, str) or not isinstance(value, Camera):
            got = f"{short(name)}: {short(value)}"
            raise UsageError(f"export_camera: camera: wanted cameras by name, got {got}")
    span = None
    if times is not None:
        begin, end = numbers(times, "export_camera: times", 2, "begin and end, s")
        if not begin <= end:
            raise UsageError(f"export_camera: times: wanted begin before end, got {times}")
        span = begin, end
    formats.write("camera", path, cameras, times=span)
