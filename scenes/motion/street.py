"""The street of scenes/extensions, with cameras that move: 0 s to 1 s.

Camera `zoom` stands and zooms from 28 to 70 mm; `drive` drives into the street at 8 m/s, from a
place at which it meets `zoom` at 0.5 s.
"""

from __future__ import annotations

import numpy as np

from daguerre.exporters.gltf import Glb, Track
from extensions import street
from kit.moves import going
from kit.pose import look

EYE, TARGET = (0.35, 1.55, 6.2), (0.0, 1.9, -8)
SHORT_MM, LONG_MM, SPEED = 28.0, 70.0, 8.0


def make() -> Glb:
    """The scene."""
    glb = street.make()
    turn = look(EYE, TARGET)
    zoom = glb.add_camera("zoom", (SHORT_MM + LONG_MM) / 2, 8, 12)
    glb.add_node("zoom", camera=zoom, translation=EYE, rotation=turn)
    pointer = f"/cameras/{zoom}/extensions/EXT_camera_physical/focalLength"
    drive = glb.add_camera("drive", 35, 8, 12)
    node = glb.add_node("drive", camera=drive, translation=EYE, rotation=turn)
    ahead = np.subtract(TARGET, EYE) / np.linalg.norm(np.subtract(TARGET, EYE))
    way = [np.asarray(EYE) + ahead * SPEED * (t - 0.5) for t in (0, 1)]
    glb.add_animation(
        "cameras",
        [Track.to(pointer, [0, 1], np.array([SHORT_MM, LONG_MM])), going(node, [0, 1], way)],
    )
    return glb
