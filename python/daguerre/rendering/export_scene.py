"""Writes scenes for other renderers, with the camera that a picture here would have."""

from __future__ import annotations

from pathlib import Path

from daguerre.argument_checks import guarded
from daguerre.camera.camera import Camera
from daguerre.exporters.record import Outgoing
from daguerre.files import formats, in_use
from daguerre.files.atomic import check_writable
from daguerre.files.notes import Notes
from daguerre.scene.scene import Scene

from .export_view import view_of
from .parameters import DEFAULT
from .prepare import prepare
from .settings import RenderSettings

#: Remark on a solid that overlaps another.
LITERAL_THERE = (
    "solid that overlaps another is written with its index against air: other renderers do not "
    "nest solids, so light refracts and dims otherwise there"
)


@guarded
def export_scene(
    scene: Scene,
    path: str | Path,
    camera: Camera | str | None = None,
    *,
    resolution: tuple[int, int] = DEFAULT["resolution"],
    spp: int | None = None,
) -> list[str]:
    """Writes a scene for pbrt-v4 (.pbrt) or Mitsuba 3 (.xml), so that they can draw it as well.

    Meshes and pictures go into a folder beside the file, which is named after it. Pictures by these
    renderers have the units of a frame (``docs/scenes.md``).

    Args:
        scene: The scene, which is written as it stands at its time.
        path: The file.
        camera: Camera, or its name in the scene; default: the scene's own.
        resolution: Width and height of the picture, px.
        spp: Samples per pixel; default: as in ``render``.

    Returns:
        Remarks on all that is approximated or left out, one sentence each, with counts.

    Raises:
        UsageError: Unknown suffix, the scene was read from this file, or a parameter of the camera
            is wrong.
        InputError: The scene cannot be drawn, or has no camera.
        OutputError: A file cannot be written.
    """
    formats.check_written(path, formats.written("exchange"))
    with in_use.call():
        in_use.note_read([] if scene.path is None else [scene.path])
        check_writable(path)
        settings = RenderSettings().with_(resolution=resolution, spp=spp)
        return _exported(scene, path, camera, settings)


def _exported(
    scene: Scene, path: str | Path, camera: Camera | str | None, settings: RenderSettings
) -> list[str]:
    prepared = prepare(scene, camera, settings)
    notes = Notes()
    if scene.motion:
        notes.add(f"motion is left out: the scene is written as it is at {scene.time:g} s")
    if scene.plate is not None:
        notes.add("photograph on catchers is left out")
    if nested := prepared.core_scene.nested_solids:
        notes.add(LITERAL_THERE, len(nested), scene.instances[nested[0]].name)
    view = view_of(prepared.setup, notes)
    depth = settings.light.max_depth
    outgoing = Outgoing(scene, view, prepared.size, settings.sampling.most, depth, notes)
    formats.write("exchange", path, outgoing)
    return [*prepared.notes, *notes.sentences()]
