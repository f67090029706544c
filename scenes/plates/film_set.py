"""The set: the desk by the window of `calibrated/`, with other things and a paper lamp.

Metres, y up, the floor at y = 0. Lights are in cd/m2: dusk in the window on the left, and paper
around a warm bulb on the right. Both are large, so glass and metal gather little of them.
"""

from __future__ import annotations

import math

import numpy as np

from calibrated import furniture, papers, room, things
from calibrated.place import on_desk, put
from kit import shapes
from kit.pose import Point, look
from lens_scenes.view_camera import add_view_camera
from night.stage import WARM, Stage

EYE: Point = (0.12, 1.06, 0.80)  # of the camera, m
TARGET: Point = (0.30, 0.80, 0.02)
FOCUS = 0.76  # m, between the pawns of glass and of steel
DUSK = 260.0  # cd/m2, of the sky
LAMP = 0.085, 0.27, 8.0  # radius and height of the paper, m, and what it gives, lm


def add_set(stage: Stage) -> None:
    """All of it, below one node: `--catcher set` names it."""
    room.add_room(stage)
    room.add_window(stage, DUSK)
    furniture.add_furniture(stage)
    papers.add_books(stage)
    papers.add_notebook(stage)
    papers.add_pencils(stage)
    things.add_mug(stage)
    things.add_plant(stage)
    things.add_apple(stage)
    add_view_camera(stage, on_desk(0.36, -0.20), -24)
    _add_lamp(stage)
    parts, stage.glb.roots = stage.glb.roots, []
    stage.glb.add_node("set", children=parts)


def add_camera(stage: Stage) -> None:
    """A normal lens at f/2.8, focused on the pawns."""
    camera = stage.glb.add_camera("camera", 50.0, 2.8, FOCUS)
    stage.glb.add_node("camera", camera=camera, translation=EYE, rotation=look(EYE, TARGET))


def _add_lamp(stage: Stage) -> None:
    """Paper over rings of wire, on a foot of brass."""
    radius, high, lumen = LAMP
    luminance = lumen / (2 * math.pi**2 * radius * high)  # paper gives pi L from each of its points
    paper = stage.matter(
        "paper lamp", stage.shine(WARM, luminance), baseColorFactor=[0.7, 0.66, 0.58, 1]
    )
    rings = 12
    t = np.linspace(0, 1, 8 * rings + 1)
    bulge = 0.86 + 0.14 * np.sin(math.pi * t) - 0.018 * np.abs(np.cos(math.pi * rings * t)) ** 6
    side = np.stack([radius * bulge, 0.045 + high * t], 1)
    lid = [(0.0, side[-1, 1])]
    shade = np.concatenate([[(0.0, side[0, 1])], side, lid])
    foot = [(0, 0), (0.052, 0), (0.054, 0.004), (0.050, 0.010), (0.014, 0.016), (0.010, 0.046)]
    parts = [
        (shapes.lathe(shade, 96), paper),
        (shapes.lathe([*foot, (0, 0.046)], 64), stage.brass),
    ]
    put(stage, "paper lamp", parts, translation=on_desk(0.61, -0.30))
