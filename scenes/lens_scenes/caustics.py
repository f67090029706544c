"""Light that glass has gathered: a ball, a glass of wine and a ring of brass under one small lamp.

The lamp is a ball of 6 mm radius; what glass and brass do with its light on the table are caustics,
which a path from the lens meets by chance alone: it would have to hit the lamp through the glass.
Light paths (``--light-paths``) start at the lamp. Metres, y up; the lamp has 44 lm, and a grey
card beyond the frame throws a little of it back.
"""

from __future__ import annotations

import numpy as np

from daguerre.exporters.gltf import Glb
from kit import shapes, textures
from kit.pose import look, turn_y
from night.stage import WARM, Stage

EYE, SUBJECT = (0.06, 0.30, 0.62), (0.0, 0.028, 0.0)
WINE = (0.055, 0.0001, -0.015)
LAMP, LAMP_RADIUS, INTENSITY = (-0.42, 0.36, -0.34), 0.006, 3.5  # m, m, cd


def make() -> Glb:
    """Everything: table, glass, brass, lamp and card."""
    stage = Stage("daguerre scenes/lens_scenes.py")
    focus = float(np.linalg.norm(np.subtract(EYE, SUBJECT)))
    camera = stage.glb.add_camera("Camera", 50.0, 2.8, focus)
    stage.glb.add_node("Camera", camera=camera, translation=EYE, rotation=look(EYE, SUBJECT))
    _add_room(stage)
    clear = stage.clear("crystal", (0.99, 0.995, 0.99), 0.2, 1.52)
    stage.put("ball", shapes.ball(0.038, 64, 128), clear, translation=[-0.105, 0.0381, 0.03])
    _add_wine(stage, clear)
    _add_ring(stage)
    stage.lamp(LAMP, LAMP_RADIUS, WARM, round(INTENSITY / (np.pi * LAMP_RADIUS**2)))
    return stage.glb


def _add_room(stage: Stage) -> None:
    """A light table, and a card that brightens the shadows."""
    color, _, _ = textures.wood()
    picture = stage.glb.add_picture("boards", textures.jpeg(np.clip(color * 0.5 + 0.42, 0, 1)))
    boards = stage.matter("boards", baseColorTexture=picture, roughnessFactor=0.9)
    top = shapes.box((1.6, 0.03, 1.2), [(0, 0, 1.3, 1.0)] * 6)
    stage.put("table", top, boards, translation=[0, -0.03, -0.1], rotation=turn_y(-12))
    card = stage.matter("card", baseColorFactor=[0.6, 0.6, 0.62, 1], roughnessFactor=1.0)
    stage.put(
        "card",
        shapes.box((1.2, 0.7, 0.01)),
        card,
        translation=[0.75, 0.3, 0.35],
        rotation=turn_y(-70),
    )


def _add_wine(stage: Stage, clear: int) -> None:
    """A glass of red wine: the wine fills it to just within the glass."""
    outer = [(0.029, 0.0016), (0.010, 0.0040), (0.0040, 0.010), (0.0035, 0.045), (0.0050, 0.057)]
    outer += [(0.022, 0.072), (0.0335, 0.094), (0.0340, 0.115), (0.0290, 0.140)]
    inner = [(0.0278, 0.140), (0.0328, 0.115), (0.0323, 0.094), (0.0208, 0.0730), (0.006, 0.0625)]
    profile = [[(0, 0), (0.029, 0)], shapes.smooth_profile(outer), [(0.0284, 0.1404)]]
    profile += [shapes.smooth_profile([*inner, (0, 0.0617)])]
    glass = shapes.lathe(np.concatenate(profile), 128, 60)
    stage.put("wine_glass", glass, clear, translation=WINE)
    wine = stage.clear("wine", (0.55, 0.02, 0.05), 0.02, 1.34)
    side = shapes.smooth_profile([(0.0056, 0.0629), (0.0204, 0.0734), (0.0319, 0.0942)])
    body = np.concatenate([[(0, 0.0622)], side, [(0, 0.0942)]])
    stage.put("wine", shapes.lathe(body, 128, 60), wine, translation=WINE)


def _add_ring(stage: Stage) -> None:
    """A ring of polished brass: the curve that light draws in a cup."""
    brass = stage.matter(
        "polished_brass",
        baseColorFactor=[0.92, 0.68, 0.32, 1],
        metallicFactor=1.0,
        roughnessFactor=0.08,
    )
    profile = [(0.034, 0.0), (0.034, 0.022), (0.0325, 0.022), (0.0325, 0.0)]
    stage.put("ring", shapes.lathe(profile, 160, 40), brass, translation=[-0.005, 0, 0.12])
