"""The room: panelled wall, floor, ceiling, a window on the left and what hangs on the wall."""

from __future__ import annotations

import math

import numpy as np

from calibrated import pictures
from calibrated.place import BACK, about_x, about_y, about_z, put, translucent
from kit import shapes, textures
from night.stage import Stage

LEFT, RIGHT, FRONT, HIGH = -1.75, 2.0, 3.2, 2.5  # of the room, m
WINDOW = (-0.15, 1.25, 0.92, 2.2)  # in the left wall: z and y, m
DAY = 2600  # cd/m2, of a white sky
RAIL = 1.22  # top of the panels, m


def add_room(stage: Stage) -> None:
    """Walls, floor and ceiling as one thing each, and a rug."""
    plaster = stage.matter("plaster", baseColorFactor=[0.74, 0.71, 0.65, 1], roughnessFactor=0.95)
    white = stage.matter("ceiling", baseColorFactor=[0.82, 0.82, 0.80, 1], roughnessFactor=0.95)
    deep, wide = FRONT - BACK, RIGHT - LEFT
    middle = ((LEFT + RIGHT) / 2, (BACK + FRONT) / 2)
    front = shapes.turned(shapes.square(wide, HIGH), about_y(180))
    right = shapes.turned(shapes.square(deep, HIGH), about_y(-90))
    walls = [
        (shapes.moved(shapes.square(wide, HIGH), (middle[0], HIGH / 2, BACK)), plaster),
        (shapes.moved(front, (middle[0], HIGH / 2, FRONT)), plaster),
        (shapes.moved(right, (RIGHT, HIGH / 2, middle[1])), plaster),
        *((shape, plaster) for shape in _around_the_window()),
    ]
    put(stage, "wall", walls)
    ceiling = shapes.turned(shapes.square(wide, deep), about_x(90))
    put(stage, "ceiling", [(ceiling, white)], translation=[middle[0], HIGH, middle[1]])
    boards = textures.wood(512, 8)[0]
    oak = np.clip(boards * (1.45, 1.35, 1.2), 0, 1)
    floor = stage.matter(
        "floor",
        baseColorTexture=stage.glb.add_picture("floor", textures.jpeg(oak, 85)),
        roughnessFactor=0.5,
    )
    ground = shapes.turned(shapes.square(deep, wide, (0, 0, deep / 1.2, wide / 1.2)), about_x(-90))
    ground = shapes.turned(ground, about_y(90))
    put(stage, "floor", [(ground, floor)], translation=[middle[0], 0, middle[1]])
    _add_panels(stage)
    _add_prints(stage)
    _add_rug(stage)


def _around_the_window() -> list[shapes.Shape]:
    """The left wall: four rectangles that leave the window open."""
    z0, z1, y0, y1 = WINDOW
    parts = []
    for a, b, low, high in (
        (BACK, z0, 0, HIGH),
        (z1, FRONT, 0, HIGH),
        (z0, z1, 0, y0),
        (z0, z1, y1, HIGH),
    ):
        part = shapes.turned(shapes.square(b - a, high - low), about_y(90))
        parts.append(shapes.moved(part, (LEFT, (low + high) / 2, (a + b) / 2)))
    return parts


def add_window(stage: Stage, sky: float = DAY) -> None:
    """A frame of four panes, a sill, and the day outside; `sky` is its luminance, cd/m2."""
    z0, z1, y0, y1 = WINDOW
    paint = stage.matter("window paint", baseColorFactor=[0.8, 0.8, 0.78, 1], roughnessFactor=0.35)
    wide, high, depth = z1 - z0, y1 - y0, 0.14
    parts = [shapes.moved(shapes.box((depth + 0.10, 0.03, wide + 0.12)), (0.03, -0.03, 0))]
    for z in (-wide / 2, wide / 2):
        parts.append(shapes.moved(shapes.box((depth, high, 0.02)), (0, 0, z)))
    for y in (0.0, high - 0.02):
        parts.append(shapes.moved(shapes.box((depth, 0.02, wide)), (0, y, 0)))
    for z in (-wide / 2 + 0.035, 0, wide / 2 - 0.035):
        parts.append(shapes.moved(shapes.box((0.05, high, 0.06)), (-0.03, 0, z)))
    for y in (0.0, high * 0.62, high - 0.06):
        parts.append(shapes.moved(shapes.box((0.05, 0.06, wide)), (-0.03, y, 0)))
    at = [LEFT - depth / 2, y0, (z0 + z1) / 2]
    put(stage, "window", [(part, paint) for part in parts], translation=at)
    view = stage.glb.add_picture("outside", textures.jpeg(pictures.outside()))
    day = stage.glb.add_material(
        "day",
        pbrMetallicRoughness={"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0.0},
        emissiveTexture=view,
        **stage.emission([sky, sky, sky]),
    )
    outside = shapes.turned(shapes.square(wide, high), about_y(90))
    put(stage, "outside", [(outside, day)], translation=[LEFT - depth, (y0 + y1) / 2, at[2]])
    _add_curtains(stage)


def _add_curtains(stage: Stage) -> None:
    """Linen at both sides, through which a part of the light comes."""
    linen = translucent(stage, "linen", (0.80, 0.74, 0.62), 0.95, 0.45, (0.80, 0.70, 0.55))
    z0, z1, _, y1 = WINDOW
    t, y = np.meshgrid(np.linspace(0, 1, 73), np.linspace(0, 1, 13))
    for z, sign in ((z0 - 0.02, 1), (z1 + 0.02, -1)):
        fold = 0.028 * np.sin(2 * math.pi * 6 * t) * (0.6 + 0.4 * (1 - y))
        fold += 0.008 * np.sin(2 * math.pi * 2.3 * t + 1.3)
        grid = np.stack([fold, 0.08 + (y1 - 0.0) * (1 - y), sign * 0.26 * (t - 0.62)], -1)
        at = [LEFT + 0.10, 0, z]
        put(stage, "curtain", [(shapes.surface(grid), linen)], translation=at)
    rod = shapes.tube([(0, 0, z0 - 0.3), (0, 0, z1 + 0.3)], 0.010, 16)
    put(stage, "curtain rod", [(rod, stage.brass)], translation=[LEFT + 0.10, y1 + 0.09, 0])


def _add_panels(stage: Stage) -> None:
    """Painted boards up to the rail: what is straight shows how a lens bends."""
    sage = stage.matter("sage", baseColorFactor=[0.20, 0.27, 0.22, 1], roughnessFactor=0.55)
    board, gap = 0.118, 0.006
    count = int((RIGHT - LEFT) / (board + gap)) + 1
    plank = shapes.box((board, RAIL, 0.014))
    parts = [shapes.moved(plank, (k * (board + gap), 0, 0)) for k in range(count)]
    wide = count * (board + gap)
    across = (wide / 2 - board / 2, 0, 0)
    for y, high, thick in ((RAIL, 0.025, 0.045), (RAIL - 0.07, 0.07, 0.024), (0, 0.12, 0.026)):
        bar = shapes.box((wide, high, thick))
        parts.append(shapes.moved(bar, np.add(across, (0, y, 0))))
    at = [LEFT + board / 2, 0, BACK + 0.007]
    put(stage, "wainscot", [(part, sage) for part in parts], translation=at)


def _add_prints(stage: Stage) -> None:
    """Framed prints over the desk, and a clock."""
    walnut = stage.matter("frame", baseColorFactor=[0.09, 0.05, 0.03, 1], roughnessFactor=0.4)
    mat = stage.matter("mat", baseColorFactor=[0.82, 0.81, 0.78, 1], roughnessFactor=0.9)
    prints = (
        ("ridges", pictures.ridges(), -0.62, 1.66, 0.48, 0.34),
        ("eclipse", pictures.eclipse(), -0.10, 1.66, 0.34, 0.34),
        ("dunes", pictures.dunes(), 0.42, 1.66, 0.48, 0.34),
    )
    for name, picture, x, y, wide, high in prints:
        shown = stage.glb.add_picture(name, textures.jpeg(picture, 88))
        matter = stage.matter(name, baseColorTexture=shown, roughnessFactor=0.5)
        parts = [(shapes.moved(shapes.square(wide, high), (0, 0, 0.006)), mat)]
        image = shapes.square(wide - 0.08, high - 0.08)
        parts.append((shapes.moved(image, (0, 0, 0.0065)), matter))
        for side in (-1, 1):
            upright = shapes.box((0.018, high + 0.036, 0.024))
            parts.append(
                (
                    shapes.moved(upright, (side * (wide + 0.018) / 2, -high / 2 - 0.018, 0.012)),
                    walnut,
                )
            )
            bar = shapes.box((wide, 0.018, 0.024))
            low = side * (high + 0.018) / 2 - 0.009
            parts.append((shapes.moved(bar, (0, low, 0.012)), walnut))
        put(stage, "picture", parts, translation=[x, y, BACK])
    face = stage.glb.add_picture("clock", textures.png(pictures.clock()))
    dial = stage.matter("dial", baseColorTexture=face, roughnessFactor=0.4)
    ring = [(0.13, 0), (0.14, 0.004), (0.14, 0.03), (0.132, 0.034), (0.13, 0.02)]
    rim = shapes.turned(shapes.lathe(ring, 96), about_x(90))
    hands = [_hand(0.065, 0.008, -310), _hand(0.10, 0.005, -54)]  # eight minutes past ten
    parts = [(shapes.moved(shapes.disc(0.131, 96), (0, 0, 0.02)), dial), (rim, stage.brass)]
    parts += [(shapes.moved(hand, (0, 0, 0.023)), walnut) for hand in hands]
    put(stage, "clock", parts, translation=[0.98, 1.70, BACK])


def _hand(long: float, wide: float, degrees: float) -> shapes.Shape:
    """Hand of a clock: up, then turned."""
    hand = shapes.moved(shapes.box((wide, long + 0.02, 0.002)), (0, -0.02, 0))
    return shapes.turned(hand, about_z(degrees))


def _add_rug(stage: Stage) -> None:
    weave = stage.glb.add_picture("rug", textures.jpeg(pictures.rug(), 85))
    wool = stage.matter("rug", baseColorTexture=weave, roughnessFactor=1.0)
    rug = shapes.turned(shapes.square(2.2, 1.5), about_x(-90))
    put(stage, "rug", [(rug, wool)], translation=[0.1, 0.006, 1.15])
