# SPDX-License-Identifier: GPL-3.0-or-later
"""Photograph: the exposed and developed picture, and its raw file, beside the render."""

import os
from pathlib import Path
from typing import Any

import bpy

from daguerre.camera.camera import Camera
from daguerre.camera.exposure_mode import is_automatic
from daguerre.exposure.retaken import retaken
from daguerre.frame.frame import Frame
from daguerre.rendering import Photograph, Reporter
from daguerre.sensors import load

#: Endings of the files, after the name of the render.
PICTURE, RAW = "_photograph.png", "_photograph.dng"


def paths(scene: Any, *, numbered: bool) -> list[Path]:
    """Files beside the render of a scene; ``numbered``: beside that of its frame."""
    render = scene.render
    name = render.frame_path(frame=scene.frame_current) if numbered else render.filepath
    folder, name = os.path.split(bpy.path.abspath(name))
    stem = name.removesuffix(render.file_extension) or "render"
    ends = (PICTURE, RAW) if scene.daguerre.raw else (PICTURE,)
    return [Path(folder, stem + end) for end in ends]


def photograph_of(camera: Camera, look: str, group: Any) -> Photograph:
    """Sensor and development that the camera's panel asks for."""
    return Photograph(
        sensor=None if camera.sensor is None else load(camera.sensor),
        iso=None if is_automatic(group.exposure_mode) else group.iso,
        look=look,
    )


def write(frame: Frame, camera: Camera, scene: Any, group: Any, files: list[Path]) -> None:
    """Writes the photograph of a frame into files, in the exposure mode of the camera's panel.

    Raises:
        DaguerreError: It cannot be exposed, or a file cannot be written.
    """
    silent = Reporter()
    for file in files:
        file.parent.mkdir(parents=True, exist_ok=True)
    asked = photograph_of(camera, scene.daguerre.look, group)
    if not is_automatic(group.exposure_mode):  # of a camera without a lens of Daguerre, too
        frame = retaken(frame, group.exposure_mode).frame
    asked.check(frame.metadata, files, silent)
    asked.write(frame, files, "srgb", silent)
