"""Scene files of any format into scenes that can be looked at."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from daguerre.checks import number
from daguerre.files import formats
from daguerre.scene.framing import frame_everything
from daguerre.scene.scene import Scene


def load(path: str | Path, *, time: float = 0.0, **options: Any) -> Scene:
    """Reads a scene file at a time in seconds, by the table of formats; see :func:`daguerre.load`.

    Args:
        path: The file.
        time: Where motion is evaluated, s.
        **options: Those of the format; None and empty ones count as absent.
    """
    time = number(time, "time")
    given = {name: value for name, value in options.items() if value not in (None, (), [])}
    scene: Scene = formats.read("scene", path, time=time, **given)
    if not scene.cameras and (camera := frame_everything(scene)) is not None:
        scene.add_camera("framing", camera)
        scene.note("no camera in the file; 'framing' has everything in view")
    return scene
