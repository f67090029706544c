"""``daguerre export-scene``: a scene for pbrt-v4 or Mitsuba 3."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from daguerre.errors import UsageError

from . import console
from .flags.calibration import CalibrationFlags
from .flags.camera import CameraFlags
from .flags.groups import Text, option, with_flags
from .flags.scene_file import SceneFileFlags, ScenePath
from .flags.shutter import ShutterFlags
from .render.views import Cameras


@with_flags(
    camera_flags=CameraFlags,
    calibration_flags=CalibrationFlags,
    shutter_flags=ShutterFlags,
    file_flags=SceneFileFlags,
)
def export_scene(
    scene_path: ScenePath,
    camera_flags: CameraFlags,
    calibration_flags: CalibrationFlags,
    shutter_flags: ShutterFlags,
    file_flags: SceneFileFlags,
    output: Annotated[
        Path | None,
        option("-o", "--output", metavar="FILE.pbrt|xml", help="Scene file to write."),
    ] = None,
    res: Annotated[
        Text,
        option(
            "--res",
            metavar="WxH",
            help="Size of the picture, px [the scene file's, else 960x540].",
        ),
    ] = None,
    spp: Annotated[int | None, option("--spp", metavar="N", help="Samples per pixel [64].")] = None,
) -> int:
    """Writes a scene for pbrt-v4 or Mitsuba 3, so that its picture can be checked against theirs.

    Flags change the camera before it is written, as in `render`. Notes name features that these
    renderers lack.
    """
    import daguerre
    from daguerre.files.atomic import check_writable
    from daguerre.files.formats import check_written, written

    if output is None:
        raise UsageError("export-scene: wanted SCENE -o FILE.pbrt or FILE.xml, got no -o")
    check_written(output, written("exchange"))
    check_writable(output)
    changes = camera_flags.changes() | shutter_flags.changes()
    flags = Cameras(camera_flags.camera, calibration_flags, changes, camera_flags.placement)
    views = flags.views(None)
    if len(views) > 1:
        raise UsageError(
            f"export-scene: wanted one camera, got {len(views)}; --camera NAME chooses one"
        )
    calibration_flags.check(changes)
    scene = file_flags.read(scene_path)
    camera = views[0].view(flags).camera(scene)
    size = flags.size(views[0], res, scene)
    notes = daguerre.export_scene(scene, output, camera, resolution=size, spp=spp)
    for text in scene.warnings:
        console.note(f"{scene_path}: {text}")
    for text in notes:
        console.note(f"{output}: {text}")
    console.note(f"wrote {output}")
    return 0
