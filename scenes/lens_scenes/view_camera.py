"""A wooden field camera of the plate days: bed, standards, bellows and a lens in brass."""

from __future__ import annotations

import numpy as np

from daguerre.exporters.gltf import Shape
from kit import shapes, textures
from kit.pose import turn_y
from night.stage import Stage

BACK, FRONT = (0.190, 0.205), (0.120, 0.150)  # m: width and height of the standards
DRAW, RISE = 0.165, 0.024  # from one to the other; of both over the table
Parts = list[tuple[Shape, int]]
LAID = np.array(((1, 0, 0), (0, 0, -1), (0, 1, 0)))  # what stands, laid toward the viewer


def add_view_camera(stage: Stage, at: tuple[float, float, float], degrees: float) -> None:
    """The camera on its bed; `at` is under its front standard, which faces +z turned."""
    wood = stage.matter(
        "mahogany",
        baseColorTexture=stage.glb.add_picture("mahogany", textures.jpeg(_mahogany())),
        roughnessFactor=0.45,
    )
    leather = stage.matter("bellows", baseColorFactor=[0.20, 0.03, 0.02, 1], roughnessFactor=0.6)
    parts: Parts = []

    def part(shape: Shape, matter: int, *place: float) -> None:
        parts.append((shapes.moved(shape, place), matter))

    part(shapes.box((0.150, 0.016, 0.300)), wood, 0, 0.006, -0.085)
    for x in (-0.068, 0.068):
        part(shapes.box((0.008, 0.008, 0.290)), stage.brass, x, 0.020, -0.085)
    for z in (-DRAW, 0.0):
        for shape in _frame(*(BACK if z else FRONT)):
            part(shape, wood, 0, RISE, z)
    part(_bellows(), leather, 0, RISE, 0)
    part(shapes.box((0.086, 0.086, 0.006)), wood, 0, RISE + FRONT[1] / 2 - 0.043, 0.010)
    parts += _lens(stage)
    knob = shapes.lathe([(0.009, 0), (0.009, 0.008), (0.006, 0.0095), (0, 0.0095)], 32)
    for side in (-1, 1):
        aside = shapes.turned(knob, ((0, side, 0), (-side, 0, 0), (0, 0, 1)))
        for z in (-0.12, -0.02):
            part(aside, stage.brass, 0.075 * side, 0.014, z)
        part(aside, stage.brass, 0.5 * FRONT[0] * side, RISE + FRONT[1] / 2, 0)
    mesh = stage.glb.add_parts("view_camera", shapes.by_matter(parts))
    stage.glb.add_node("view_camera", mesh=mesh, translation=at, rotation=turn_y(degrees))


def _mahogany() -> textures.Picture:
    color, _, _ = textures.wood(512, 1)
    return np.asarray(color * (1.0, 0.62, 0.5))


def _frame(wide: float, high: float) -> list[Shape]:
    """Four bars, 18 mm wide and 16 mm thick."""
    bar, thick = 0.018, 0.016
    upright = shapes.box((bar, high, thick))
    across = shapes.box((wide - 2 * bar, bar, thick))
    x = (wide - bar) / 2
    return [
        shapes.moved(upright, (-x, 0, 0)),
        shapes.moved(upright, (x, 0, 0)),
        shapes.moved(across, (0, 0, 0)),
        shapes.moved(across, (0, high - bar, 0)),
    ]


def _bellows(folds: int = 13) -> Shape:
    """Pleats between the standards, square and tapered."""
    s = np.linspace(0, 1, 2 * folds + 1)
    fold = 0.0055 * (-1.0) ** np.arange(len(s))
    wide = (BACK[0] / 2 - 0.022) * (1 - s) + (FRONT[0] / 2 - 0.022) * s + fold
    high = (BACK[1] / 2 - 0.022) * (1 - s) + (FRONT[1] / 2 - 0.022) * s + fold
    middle = (BACK[1] * (1 - s) + FRONT[1] * s) / 2
    z = -DRAW * (1 - s)
    corners = ((1, -1), (1, 1), (-1, 1), (-1, -1), (1, -1))
    rings = [np.stack([x * wide, middle + y * high, z], 1) for x, y in corners]
    return shapes.faceted(shapes.surface(np.stack(rings, 1)))


def _lens(stage: Stage) -> Parts:
    """Its barrel and its front glass."""
    coated = stage.matter("coated", baseColorFactor=[0.01, 0.008, 0.03, 1], roughnessFactor=0.08)
    barrel = [(0, 0), (0.034, 0), (0.034, 0.004), (0.028, 0.006), (0.028, 0.026), (0.0295, 0.027)]
    barrel += [(0.0295, 0.033), (0.028, 0.034), (0.028, 0.052), (0.031, 0.054), (0.031, 0.060)]
    barrel += [(0.029, 0.060), (0.025, 0.050)]
    front = [(0.0255, 0.0505), (0.019, 0.0540), (0.010, 0.0560), (0, 0.0566)]
    place = (0, RISE + FRONT[1] / 2, 0.013)
    return [
        (shapes.moved(shapes.turned(shapes.lathe(profile, 96, 35), LAID), place), matter)
        for profile, matter in ((barrel, stage.brass), (front, coated))
    ]
