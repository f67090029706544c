"""Writes a scene for Mitsuba 3: an XML file, and a folder of meshes and pictures beside it.

Units agree: Mitsuba's radiance of 1 is 1 cd/m2 here, its intensity 1 cd, its irradiance 1 lux, so
that its picture has the numbers of a frame.

Source: documentation of Mitsuba 3 (scene format and plugins), and its source for conventions.
"""

from __future__ import annotations

import os
from pathlib import Path
from xml.etree import ElementTree

from daguerre.compiled import __version__
from daguerre.exporters.outgoing.folder import OutgoingFolder
from daguerre.exporters.outgoing.looks import Looks
from daguerre.exporters.outgoing.meshes import MeshFiles
from daguerre.exporters.outgoing.pictures import Baker
from daguerre.exporters.outgoing.placing import placements
from daguerre.exporters.record import Outgoing

from .bsdfs import Bsdfs
from .camera import add_sensor
from .lights import add_environment, add_lights
from .media import Media
from .scene_xml import Element, add, add_value, with_comment
from .shapes import Shapes


def write(path: str | os.PathLike[str], outgoing: Outgoing) -> None:
    """Writes the scene; the XML file appears whole, after the files that it refers to.

    Raises:
        OutputError: A file cannot be written.
    """
    scene, notes = outgoing.scene, outgoing.notes
    folder = OutgoingFolder(Path(path))
    root = ElementTree.Element("scene", version="3.0.0")
    integrator = add(root, "integrator", type="path")
    add_value(integrator, "integer", "max_depth", outgoing.max_depth + 1)  # edges of a path
    sensor = add_sensor(root, outgoing)
    media = Media(scene.fog, notes)
    media.add_fog(root, sensor)
    looks = Looks(scene, Baker(scene.textures, notes)).all()
    bsdfs = Bsdfs(root, folder, notes)
    shapes = Shapes(root, looks, bsdfs, MeshFiles(scene, folder, notes, v_up=False), media)
    for placed in placements(scene, notes):
        shapes.add(placed)
    if media.used:
        integrator.set("type", "volpath")
    add_lights(root, scene.lights, folder, notes)
    add_environment(root, scene.environment, folder)
    folder.finish(_text(root))


def _text(root: Element) -> str:
    ElementTree.indent(root, "    ")
    text = ElementTree.tostring(root, encoding="unicode")
    return with_comment(text, f"Daguerre {__version__}; m, +y up; radiance 1 is 1 cd/m2") + "\n"
