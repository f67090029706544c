"""``daguerre export-camera``: the cameras of a scene as a USD stage."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated

from daguerre import units as q
from daguerre.errors import UsageError

from . import console
from .flags.calibration import CalibrationFlags
from .flags.camera import CameraFlags
from .flags.groups import option, with_flags
from .flags.scene_file import SceneFileFlags, ScenePath
from .flags.shutter import ShutterFlags
from .render.views import Cameras


@with_flags(
    camera_flags=CameraFlags,
    calibration_flags=CalibrationFlags,
    shutter_flags=ShutterFlags,
    file_flags=SceneFileFlags,
)
def export_camera(
    scene_path: ScenePath,
    camera_flags: CameraFlags,
    calibration_flags: CalibrationFlags,
    shutter_flags: ShutterFlags,
    file_flags: SceneFileFlags,
    output: Annotated[
        Path | None,
        option("-o", "--output", metavar="FILE.usda|usdc|usd", help="Stage to write."),
    ] = None,
    times: Annotated[
        str | None,
        option(
            "--times",
            metavar="BEGIN,END",
            help="Begin and end of motion, s [from its keys].",
        ),
    ] = None,
) -> int:
    """Writes the cameras of a scene as a USD stage, for other programs.

    Flags change the cameras before they are written: a lens, a stop, a calibration. All cameras are
    written unless -c names some.
    """
    import daguerre
    from daguerre.files.atomic import check_writable
    from daguerre.files.formats import check_written, written

    if output is None:
        raise UsageError("export-camera: wanted SCENE -o FILE.usda, got no -o")
    check_written(output, written("camera"))
    check_writable(output)
    span = None
    if times is not None:
        begin, end = q.numbers("--times", times, 2, "0,2.5")
        span = begin, end
    changes = camera_flags.changes() | shutter_flags.changes()
    flags = Cameras(camera_flags.camera, calibration_flags, changes, camera_flags.placement)
    views = flags.views(None)
    calibration_flags.check(changes)
    scene = file_flags.read(scene_path, moments=(0.0, 0.0))
    if camera_flags.camera is None and len(views) == 1:
        views = [replace(views[0], name=name, camera=name) for name in scene.cameras]
    cameras = {view.name: view.view(flags).camera(scene) for view in views}
    daguerre.export_camera(cameras, output, times=span)
    for text in scene.warnings:
        console.note(f"{scene_path}: {text}")
    console.note(f"wrote {output}")
    return 0
