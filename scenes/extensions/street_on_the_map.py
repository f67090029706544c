"""The street at map coordinates, where floats are 0.5 m apart: as surveys place their scenes."""

from __future__ import annotations

from daguerre.exporters.gltf import Glb
from extensions import street

PLACE_M = (500000.25, 40.0, -5400000.75)


def make() -> Glb:
    """The scene."""
    glb = street.make()
    children, glb.roots = glb.roots, []
    glb.add_node("map", translation=PLACE_M, children=children)
    return glb
