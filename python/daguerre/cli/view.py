"""``daguerre view``: the picture in a browser, with the rings of the camera to turn."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from daguerre import memory, units
from daguerre.color.spaces import check_linear
from daguerre.files import extras
from daguerre.files.recorded import recorded
from daguerre.parameters.parameter import Parameter

from . import console
from .flags.calibration import CalibrationFlags
from .flags.camera import CameraFlags
from .flags.from_table import TableFlags
from .flags.groups import with_flags
from .flags.job import JobFlags
from .flags.scene import SceneFlags
from .flags.scene_file import ScenePath
from .flags.server import ServerFlags
from .flags.settings import SettingsFlags
from .flags.shutter import ShutterFlags
from .render import checks
from .render.photograph import photograph_of
from .render.views import Cameras

if TYPE_CHECKING:
    from daguerre.camera.camera import Camera
    from daguerre.scene.scene import Scene

#: Flags of this command alone, and whether they take a value.
_OWN = {
    "--host": True,
    "--port": True,
    "--token": True,
    "--proxy": True,
    "--no-browser": False,
}


@with_flags(
    camera_flags=CameraFlags,
    calibration_flags=CalibrationFlags,
    shutter_flags=ShutterFlags,
    scene_flags=SceneFlags,
    settings_flags=SettingsFlags,
    job_flags=JobFlags,
    server_flags=ServerFlags,
)
def view(
    scene_path: ScenePath,
    camera_flags: CameraFlags,
    calibration_flags: CalibrationFlags,
    shutter_flags: ShutterFlags,
    scene_flags: SceneFlags,
    settings_flags: SettingsFlags,
    job_flags: JobFlags,
    server_flags: ServerFlags,
) -> int:
    """Opens a page with the picture that the camera sees, and the rings of the camera to turn.

    It takes the flags of `render` as positions of the rings. Ctrl-C ends it.
    """
    from daguerre.viewfinder.background import in_background
    from daguerre.viewfinder.dials import DIALS, Dials
    from daguerre.viewfinder.opening import opened
    from daguerre.viewfinder.run import Listening, run
    from daguerre.viewfinder.stage import Stage

    for package in ("websockets", "simplejpeg"):
        extras.need(package, "view")
    memory.set_limit(
        None if job_flags.memory is None else units.memory_bytes("--memory", job_flags.memory)
    )
    given = texts_of(camera_flags) | texts_of(shutter_flags) | texts_of(settings_flags)
    given |= {
        name: text
        for name, text in (
            ("look", job_flags.look),
            ("time", scene_flags.time),
        )
        if text is not None
    }
    dials = Dials.of({name: text for name, text in given.items() if name in DIALS})
    cameras = Cameras(camera_flags.camera, calibration_flags, {}, camera_flags.placement)
    (seen,) = cameras.views(None)

    def load() -> tuple[Scene, Camera]:
        scene = scene_flags.load(scene_path)
        for warning in scene.warnings:
            console.warn(f"{scene_path}: {warning}")
        anew = replace(cameras, flags=replace(calibration_flags))  # they keep what they read
        (view,) = anew.views(None)
        return scene, view.view(anew).camera(scene)

    with recorded() as files:
        scene, camera = load()
        size = cameras.size(seen, job_flags.res, scene)
        settings = checks.settings_of(job_flags, settings_flags, [], size)
        checks.check_crop([settings])
        settings = dials.before(settings)
        photograph = photograph_of({}, None, None, settings.sampling.seed)
        if job_flags.colorspace is not None:
            space = check_linear(job_flags.colorspace, "--colorspace")
            photograph = replace(photograph, colorspace=space)
        stage = Stage(scene, camera, settings, photograph, job_flags.tone, load, files)
        in_background(lambda: stage.try_out(dials))
    dials, said = opened(stage, dials)
    words = without(console.argv, [*DIALS])
    if job_flags.output is None:
        words += ["-o", f"{scene_path.stem}.png"]
    listening = Listening(
        server_flags.host,
        server_flags.port,
        server_flags.token,
        browser=not server_flags.no_browser,
        proxies=tuple(server_flags.proxy or ()),
    )
    return run(stage, dials, words, listening, console.show, said)


def texts_of(flags: TableFlags) -> dict[str, str]:
    """Texts of the given flags of a table, by the name of their parameter."""
    found = {}
    for row in flags.table.flagged:
        value = getattr(flags, row.field)
        if value is not None and value != []:
            parts = value if isinstance(value, list) else [value]
            found[row.name] = " ".join(str(part) for part in parts)
    return found


def without(words: list[str], rows: list[Parameter]) -> list[str]:
    """Words of a command line without the command, its own flags and the flags of rows."""
    takes_value = _OWN | {
        name: row.kind != "flag" for row in rows for flag in row.flags for name in flag.split("/")
    }
    found, skip = [], False
    for word in words[1:]:
        if skip:
            skip = False
        elif word in takes_value:
            skip = takes_value[word]
        elif word.partition("=")[0] not in takes_value:
            found.append(word)
    return found
