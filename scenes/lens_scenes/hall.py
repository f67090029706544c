"""The arcade: columns, beams and tiles run straight into the depth, a house front closes it."""

from __future__ import annotations

import numpy as np

from kit import shapes, textures
from kit.pose import look
from lens_scenes.table import FLOOR
from night.stage import Stage

END = -42.0  # of the arcade, m
HALF_WIDTH = 2.2  # from the middle to the columns
COLUMNS = np.arange(2.2, END, -2.6)
CAPITAL = 1.75  # height at which the beams lie


def add_hall(stage: Stage) -> None:
    """Floor, columns, beams and the house at the end, under a dusky sky."""
    _add_floor(stage)
    stone = stage.matter("column", baseColorFactor=[0.52, 0.47, 0.40, 1], roughnessFactor=0.8)
    profile = [(0.24, 0.0), (0.24, 0.10), (0.20, 0.12), (0.165, 0.16), (0.15, 1.5), (0.13, 2.95)]
    profile += [(0.16, 3.0), (0.22, 3.12), (0.22, CAPITAL - FLOOR)]
    column = stage.glb.add_mesh("column", shapes.lathe(profile, 40), stone)
    deep = COLUMNS[0] - END
    for side in (-1, 1):
        for z in COLUMNS:
            at = [side * HALF_WIDTH, FLOOR, z]
            stage.glb.add_node("column", mesh=column, translation=at)
        beam = shapes.box((0.30, 0.35, deep))
        at = [side * HALF_WIDTH, CAPITAL, END + deep / 2]
        stage.put("beam", beam, stone, translation=at)
    wood = stage.matter("rafter", baseColorFactor=[0.20, 0.12, 0.07, 1], roughnessFactor=0.7)
    rafter = stage.glb.add_mesh("rafter", shapes.box((2 * HALF_WIDTH, 0.16, 0.14)), wood)
    for z in COLUMNS:
        stage.glb.add_node("rafter", mesh=rafter, translation=[0, CAPITAL + 0.12, z])
    _add_house(stage)
    _add_light(stage)


def _add_floor(stage: Stage) -> None:
    """Tiles of half a metre, light and dark, to the end and far behind the camera."""
    tile = np.full((64, 64, 3), 0.62)
    tile[:32, :32] = tile[32:, 32:] = 0.16
    tile += 0.02 * textures.noise((64, 64), (2, 2), 5)[..., None]
    matter = stage.matter(
        "tiles",
        baseColorTexture=stage.glb.add_picture("tiles", textures.png(tile)),
        roughnessFactor=0.3,
    )
    wide, deep = 24.0, 140.0
    floor = shapes.square(wide, deep, (0, 0, wide, deep))
    stage.put(
        "floor", floor, matter, translation=[0, FLOOR, 20.0], rotation=[-(0.5**0.5), 0, 0, 0.5**0.5]
    )


def _add_house(stage: Stage) -> None:
    """A front of windows, four in five of them dark."""
    wall = stage.matter("wall", baseColorFactor=[0.22, 0.19, 0.17, 1], roughnessFactor=0.9)
    stage.put("house", shapes.box((40, 16, 0.5)), wall, translation=[0, FLOOR, END - 2])
    frame = stage.matter("window", baseColorFactor=[0.5, 0.48, 0.45, 1], roughnessFactor=0.6)
    lit = stage.matter("lit", stage.shine((1.0, 0.72, 0.40), 1.2), baseColorFactor=[0, 0, 0, 1])
    pane, rim = shapes.square(0.62, 0.95), shapes.box((0.78, 1.1, 0.06))
    lit_mesh = stage.glb.add_mesh("pane", pane, lit)
    rim_mesh = stage.glb.add_mesh("rim", rim, frame)
    dark = stage.matter("dark", baseColorFactor=[0.01, 0.012, 0.02, 1], roughnessFactor=0.05)
    dark_mesh = stage.glb.add_mesh("dark", pane, dark)
    rng = np.random.default_rng(11)
    for x in np.arange(-17.6, 17.7, 1.6):
        for y in np.arange(-0.9, 11.5, 2.0):
            z = END - 1.74
            stage.glb.add_node("rim", mesh=rim_mesh, translation=[x, y - 0.55, z])
            mesh = lit_mesh if rng.random() < 0.22 else dark_mesh
            stage.glb.add_node("pane", mesh=mesh, translation=[x, y, z + 0.035])


def _add_light(stage: Stage) -> None:
    """A window of soft light from the left, a lamp from behind on the right, and the sky."""
    soft = stage.matter("soft", stage.shine((1.0, 0.86, 0.70), 12.0), baseColorFactor=[0, 0, 0, 1])
    eye = np.array([-1.5, 0.95, 1.6])
    away = look(eye, 2 * eye - (0.05, -0.05, 0))  # a square faces its +z
    stage.put("soft", shapes.square(0.9, 0.9), soft, translation=eye, rotation=away)
    stage.lamp([0.85, 0.55, -0.75], 0.07, (1.0, 0.62, 0.30), 14)
    sky = stage.matter("sky", [0.010, 0.016, 0.034], baseColorFactor=[0, 0, 0, 1])
    dome = shapes.ball(150, 12, 24)
    dome.indices = dome.indices[:, ::-1]
    dome.normals = -dome.normals
    stage.put("sky", dome, sky)
