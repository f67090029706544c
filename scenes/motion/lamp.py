"""A bulb that swings over a still life and goes out five times a second: 0 s to 2 s, one period.

A long exposure sees the bulb write its way in dashes, and shadows sweep.
"""

from __future__ import annotations

import math

import numpy as np

from daguerre.exporters.gltf import Glb, Track
from extensions.studio import Studio
from kit import shapes, textures
from kit.moves import swinging

PERIOD_S, FLICKERS_PER_SECOND = 2.0, 5
PIVOT, DROP = (0, 1.25, -0.12), 0.8
LYING = (-math.sqrt(0.5), 0, 0, math.sqrt(0.5))


def make() -> Glb:
    """The scene."""
    studio = Studio("motion.py")
    _room(studio)
    _still_life(studio)
    studio.glb.add_animation("swing", _lamp(studio))
    studio.softbox((-1.5, 1.6, 1.5), (0, 0.2, 0), (1, 1), 0.25, (0.5, 0.65, 1.0))
    studio.camera((0.1, 0.42, 1.5), (0, 0.3, 0), 42, 8, (0, 0.1, 0))
    return studio.glb


def _room(studio: Studio) -> None:
    color, packed, bump = textures.wood(512, 4)
    glb = studio.glb
    maps = {"baseColorTexture": glb.add_picture("wood", textures.jpeg(color))}
    maps["metallicRoughnessTexture"] = glb.add_picture("wood_mr", textures.jpeg(packed))
    grain = glb.add_picture("wood_n", textures.png(bump))
    table = studio.matter("table", (1, 1, 1), 1, 1, pbr=maps, normalTexture=grain)
    studio.put("table", shapes.square(3, 1.5, (0, 0, 2, 1)), table, rotation=LYING)
    plaster = studio.matter("plaster", (0.55, 0.5, 0.45), 0.95)
    studio.put("wall", shapes.square(6, 4), plaster, (0, 1, -0.75))


def _still_life(studio: Studio) -> None:
    clay = studio.matter("clay", (0.55, 0.22, 0.12), 0.6)
    glaze = studio.matter("glaze", (0.1, 0.25, 0.4), 0.35)
    pear = studio.matter("pear", (0.6, 0.55, 0.1), 0.4)
    brass = studio.matter("brass", (0.85, 0.65, 0.3), 0.42, 1.0)
    jug = [(0, 0), (0.06, 0), (0.085, 0.05), (0.08, 0.12), (0.04, 0.2), (0.035, 0.25), (0.05, 0.28)]
    studio.put("jug", shapes.lathe(shapes.smooth_profile(jug), 64), clay, (-0.3, 0, -0.1))
    bottle = [(0, 0), (0.045, 0), (0.048, 0.02), (0.046, 0.19), (0.016, 0.25), (0.015, 0.33)]
    body = shapes.lathe(shapes.smooth_profile([*bottle, (0.019, 0.335), (0, 0.34)]), 64)
    studio.put("bottle", body, glaze, (0.27, 0, -0.2))
    fruit = [(0, 0), (0.03, 0.004), (0.043, 0.04), (0.03, 0.08), (0.018, 0.105), (0, 0.112)]
    shape = shapes.lathe(shapes.smooth_profile(fruit), 48, 180)
    for x, z, size in [(0.04, 0.1, 1), (0.14, 0.02, 0.92)]:
        studio.put("pear", shape, pear, (x, 0, z), scale=(size, size, size))
    bowl = [(0, 0), (0.04, 0), (0.045, 0.01), (0.09, 0.045), (0.105, 0.075), (0.1, 0.078)]
    cup = shapes.lathe(shapes.smooth_profile([*bowl, (0.085, 0.045), (0, 0.015)]), 64)
    studio.put("bowl", cup, brass, (-0.11, 0, 0.12))


def _lamp(studio: Studio) -> list[Track]:
    glb = studio.glb
    cord = studio.matter("cord", (0.05, 0.04, 0.035), 0.7)
    pivot = glb.add_node("pivot", translation=PIVOT)
    line = shapes.tube([(0, 0, 0), (0, -DROP / 2, 0), (0, -DROP + 0.06, 0)], 0.003, 8)
    studio.put("cord", line, cord, parent=pivot)
    socket = shapes.lathe([(0.016, 0.02), (0.016, 0.055), (0.006, 0.07), (0, 0.07)], 24)
    studio.put("socket", socket, cord, (0, -DROP, 0), parent=pivot)
    bulb = studio.shining("bulb", (1.0, 0.72, 0.42), 1300)
    studio.put("bulb", shapes.ico_ball(0.024, 2), bulb, (0, -DROP, 0), parent=pivot)
    full = glb.json["materials"][bulb]["extensions"]["KHR_materials_emissive_strength"]
    count = round(2 * FLICKERS_PER_SECOND * PERIOD_S)
    times = np.arange(count) * PERIOD_S / count
    levels = np.where(np.arange(count) % 2, 0.0, 1.0) * full["emissiveStrength"]
    pointer = f"/materials/{bulb}/extensions/KHR_materials_emissive_strength/emissiveStrength"
    flicker = Track.to(pointer, times, levels, "STEP")
    return [swinging(pivot, (0, 0, 1), 28, PERIOD_S), flicker]
