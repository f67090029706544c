"""Small lamps in the dark, 20 m away: out of focus each draws the pupil of the lens.

The camera focuses at a metre; white lamps stand in a grid that reaches over the frame of a 50 mm
lens, those of the middle row are red, green and blue in turn, and nothing else is there.
"""

from __future__ import annotations

import numpy as np

from daguerre.exporters.gltf import Glb
from night.stage import Stage

AWAY, STEP = 20.0, 1.6  # m
ROWS, COLUMNS = 4, 6  # to each side of the middle
RADIUS = 0.07
LUMINANCE = 55.0  # cd/m2; a disc of light shows some 1/70 of it


def make() -> Glb:
    """The lamps and their camera."""
    stage = Stage("daguerre scenes/lens_scenes.py")
    camera = stage.glb.add_camera("Camera", 50.0, 2.0, 1.0)
    stage.glb.add_node("Camera", camera=camera)
    colors = ((1.0, 0.1, 0.05), (0.1, 1.0, 0.1), (0.1, 0.2, 1.0))
    for row in np.arange(-ROWS, ROWS + 1):
        for column in np.arange(-COLUMNS, COLUMNS + 1):
            color = (1.0, 1.0, 1.0)
            at = (STEP * float(column), STEP * float(row), -AWAY)
            stage.lamp(at, RADIUS, colors[column % 3] if row == 2 else color, LUMINANCE, True)
    return stage.glb
