"""Writes a scene for pbrt-v4: a text file, and a folder of meshes and pictures beside it.

Units agree: pbrt scales each light so that L, I or a picture of 1 is 1 nit, and its film, with
the CIE's observer as its sensor, ISO 100 and 1 s, keeps that number; so its picture has the numbers
of a frame.

Source: pbrt-v4 file format (pbrt.org/fileformat-v4), and pbrt's source for conventions.
"""

from __future__ import annotations

import os
from pathlib import Path

from daguerre.exporters.outgoing.folder import OutgoingFolder
from daguerre.exporters.outgoing.looks import Looks
from daguerre.exporters.outgoing.meshes import MeshFiles
from daguerre.exporters.outgoing.pictures import Baker
from daguerre.exporters.outgoing.placing import placements
from daguerre.exporters.record import Outgoing

from .camera import add_camera
from .lights import add_environment, add_lights
from .materials import Materials
from .media import Media
from .shapes import Shapes
from .text import Text


def write(path: str | os.PathLike[str], outgoing: Outgoing) -> None:
    """Writes the scene; its file appears whole, after the files that it refers to.

    Raises:
        OutputError: A file cannot be written.
    """
    scene, notes = outgoing.scene, outgoing.notes
    folder = OutgoingFolder(Path(path))
    text = Text()
    media = Media(text, scene.fog, notes)
    media.add_fog()
    add_camera(text, outgoing, folder, Path(path).stem)
    text.line("WorldBegin")
    looks = Looks(scene, Baker(scene.textures, notes)).all()
    materials = Materials(text, folder, notes)
    meshes = MeshFiles(scene, folder, notes, v_up=True)
    shapes = Shapes(text, looks, materials, meshes, media)
    add_lights(text, scene.lights, folder, notes)
    add_environment(text, scene.environment, folder, notes)
    for placed in placements(scene, notes):
        shapes.add(placed)
    folder.finish(str(text))
