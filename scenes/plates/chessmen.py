"""Four pawns: of glass, of polished steel, and two that are painted."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from calibrated.place import on_desk
from kit import shapes
from night.stage import Stage

#: Where they stand on the desk: x and z, m.
PLACES = {
    "glass": (0.155, 0.150),
    "steel": (0.225, 0.040),
    "vermilion": (0.310, 0.135),
    "ochre": (0.190, -0.120),
}


def add_chessmen(stage: Stage) -> None:
    """All of them, below one node."""
    matters = {
        "glass": stage.clear("clear glass", (0.93, 0.98, 0.96), 0.05, 1.52),
        "steel": stage.matter(
            "mirror steel",
            baseColorFactor=[0.82, 0.82, 0.84, 1],
            metallicFactor=1.0,
            roughnessFactor=0.0,
        ),
        "vermilion": stage.matter(
            "vermilion", baseColorFactor=[0.66, 0.07, 0.03, 1], roughnessFactor=0.6
        ),
        "ochre": stage.matter("ochre", baseColorFactor=[0.62, 0.36, 0.05, 1], roughnessFactor=0.6),
    }
    shape = shapes.lathe(profile(), 160, 45)
    all_of_them = stage.glb.add_node("chessmen")
    for name, (x, z) in PLACES.items():
        mesh = stage.glb.add_mesh(name, shape, matters[name])
        at = on_desk(x, z, 0.0002)
        stage.glb.add_node(name, parent=all_of_them, mesh=mesh, translation=at)


def profile() -> NDArray[np.float64]:
    """A pawn 13 cm high: foot, waist, collar and head (radius, height), m."""
    foot = [(0.0, 0.0), (0.034, 0.0), (0.036, 0.002), (0.036, 0.009), (0.034, 0.011)]
    waist = [(0.034, 0.011), (0.030, 0.017), (0.031, 0.023), (0.0285, 0.027), (0.019, 0.042)]
    rise = shapes.smooth_profile([*waist, (0.0135, 0.062), (0.0125, 0.078)])
    collar = [(0.023, 0.084), (0.0235, 0.0865), (0.0225, 0.088)]
    turn = np.radians(np.linspace(-56, 90, 40))
    head = np.stack([0.0205 * np.cos(turn), 0.1075 + 0.0205 * np.sin(turn)], 1)
    head[-1, 0] = 0.0
    assert math.isclose(head[-1, 1], 0.128)
    return np.concatenate([foot, rise, collar, head])
