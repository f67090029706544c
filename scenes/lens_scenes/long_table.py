"""A long table seen from its end: what a tilted lens renders sharply from the first to the last."""

from __future__ import annotations

import numpy as np

from daguerre.exporters.gltf import Glb
from kit import shapes, textures
from kit.pose import look
from lens_scenes.table import add_men
from night.stage import PALETTE, Stage

NEAR, FAR = -1.35, -5.2  # of the table top, m; the camera stands over the origin
HEIGHT = 0.7  # of the lens over the table top


def make() -> Glb:
    """Table, men, cups and candles, a lamp, and the camera, which looks 14 degrees down."""
    stage = Stage("daguerre scenes/lens_scenes.py")
    camera = stage.glb.add_camera("Camera", 90.0, 2.8, 2.8)
    rotation = look((0, HEIGHT, 0), (0, 0, -2.8))
    stage.glb.add_node("Camera", camera=camera, translation=[0, HEIGHT, 0], rotation=rotation)
    _add_top(stage)
    _add_things(stage)
    soft = stage.matter("soft", stage.shine((1.0, 0.84, 0.64), 24.0), baseColorFactor=[0, 0, 0, 1])
    for z in (-1.6, -3.4, -5.2):
        eye = np.array([-1.5, 1.5, z])
        turn = look(eye, 2 * eye - (0, 0, z - 0.4))  # a square faces its +z
        stage.put("soft", shapes.square(0.7, 0.7), soft, translation=eye, rotation=turn)
    rng = np.random.default_rng(3)
    for _ in range(40):
        at = [rng.normal(0, 2.2), 0.1 + abs(rng.normal(0, 0.5)), -9 - 5 * rng.random()]
        color = PALETTE[rng.integers(4)]
        stage.lamp(at, rng.uniform(0.03, 0.06), color, float(rng.choice([3, 6])))
    return stage.glb


def _add_top(stage: Stage) -> None:
    color, packed, normal = textures.wood()
    del normal
    wood = stage.matter(
        "walnut",
        baseColorTexture=stage.glb.add_picture("walnut", textures.jpeg(color)),
        metallicRoughnessTexture=stage.glb.add_picture("walnut_mr", textures.jpeg(packed)),
    )
    wide, deep, tile = 0.95, NEAR - FAR, 0.72
    rect = (0, 0, wide / tile, deep / tile)
    top = shapes.box((wide, 0.04, deep), [rect] * 6)
    stage.put("table", top, wood, translation=[0, -0.04, (NEAR + FAR) / 2])
    floor = stage.matter("floor", baseColorFactor=[0.10, 0.09, 0.08, 1], roughnessFactor=0.7)
    stage.put("floor", shapes.box((30, 0.1, 40)), floor, translation=[0, -0.9, -10])


def _add_things(stage: Stage) -> None:
    """Two rows of men like a street, a ruler of brass between them, cups at the sides."""
    men = add_men(stage)
    porcelain = stage.matter("porcelain", baseColorFactor=[0.8, 0.8, 0.82, 1], roughnessFactor=0.1)
    profile = [(0.0, 0.004), (0.028, 0.0), (0.030, 0.01), (0.038, 0.06), (0.040, 0.075)]
    profile += [(0.037, 0.075), (0.033, 0.05), (0.024, 0.01), (0.0, 0.008)]
    cup = stage.glb.add_mesh("cup", shapes.lathe(profile, 48), porcelain)
    mark = stage.glb.add_mesh("mark", shapes.box((0.14, 0.004, 0.012)), stage.brass)
    wax = stage.matter("wax", baseColorFactor=[0.85, 0.78, 0.62, 1], roughnessFactor=0.5)
    candle = stage.glb.add_mesh("candle", shapes.lathe([(0.014, 0), (0.014, 0.13), (0, 0.13)]), wax)
    for k, z in enumerate(np.arange(NEAR - 0.12, FAR, -0.22)):
        for side in (-1, 1):
            stage.glb.add_node("man", mesh=men[(k + side) % 2], translation=[0.17 * side, 0, z])
        stage.glb.add_node("mark", mesh=mark, translation=[0, 0, z])
        if k % 2:
            stage.glb.add_node("cup", mesh=cup, translation=[0.30 * (-1) ** (k // 2), 0, z])
        if k % 4 == 2:
            at = 0.33 * (-1) ** (k // 4)
            stage.glb.add_node("candle", mesh=candle, translation=[at, 0, z - 0.05])
            stage.lamp([at, 0.146, z - 0.05], 0.008, (1.0, 0.55, 0.18), 25)
