"""Loads scene files of any format; a scene without a camera gets one."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from daguerre.checks import number
from daguerre.doors import guarded
from daguerre.files import formats
from daguerre.scene.framing import frame_everything
from daguerre.scene.scene import Scene


@guarded
def load(
    path: str | Path,
    *,
    time: float = 0.0,
    variant: str | None = None,
    allow_dirs: Sequence[str | Path] = (),
    **options: Any,
) -> Scene:
    """Reads a scene file (.glb, .gltf, or a registered format) at a time, s.

    A file without a camera gets a camera named ``framing`` that has everything in view.

    Args:
        path: The file.
        time: Time at which animations are evaluated, s.
        variant: Material variant, one of ``Scene.variants``; default: the materials as in the file.
        allow_dirs: Folders, besides the file's own, from which it may read files.
        **options: Options of a registered format (``docs/importers.md``); None and empty ones count
            as absent.

    Raises:
        InputError: The file cannot be used; the message names the file and the place in it.
        UsageError: The file's format has no such option.
    """
    time = number(time, "time")
    options |= {"variant": variant, "allow_dirs": allow_dirs}
    given = {name: value for name, value in options.items() if value not in (None, (), [])}
    scene: Scene = formats.read("scene", path, time=time, **given)
    if not scene.cameras and (camera := frame_everything(scene)) is not None:
        scene.add_camera("framing", camera)
        scene.note("no camera in the file; 'framing' has everything in view")
    return scene
