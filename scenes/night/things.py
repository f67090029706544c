"""Things on the table: glasses, candles, a book, cards, dice, marbles, ball bearings."""

from __future__ import annotations

import math

import numpy as np

from kit import shapes, textures
from kit.pose import turn_y
from night.stage import CANDLE, Stage


def add_glasses(stage: Stage) -> None:
    """A tumbler of whisky and a wine glass, turned on a lathe with their real thickness."""
    tumbler = [(0, 0), (0.034, 0), (0.0365, 0.0025), (0.0385, 0.045), (0.0400, 0.0885)]
    tumbler += [(0.0393, 0.0898), (0.0382, 0.0898), (0.0375, 0.0885), (0.0358, 0.045)]
    tumbler += [(0.0338, 0.015), (0.0318, 0.0125), (0, 0.0118)]
    at = [0.170, 0, 0.004]
    stage.put("tumbler", shapes.lathe(tumbler, 96, 50), stage.glass, translation=at)
    # It overlaps the tumbler by 0.2 mm, so that they share one boundary.
    drink = [
        (0, 0.0116),
        (0.0320, 0.0123),
        (0.0340, 0.0149),
        (0.0357, 0.0400),
        (0.0352, 0.0403),
        (0, 0.0403),
    ]
    whisky = stage.clear("whisky", (0.80, 0.36, 0.07), 0.035, 1.36)
    stage.put("whisky", shapes.lathe(drink, 96, 50), whisky, translation=at)
    outer = [
        (0.0362, 0.0012),
        (0.030, 0.0030),
        (0.012, 0.0058),
        (0.0045, 0.012),
        (0.0038, 0.03),
    ]
    outer += [(0.0038, 0.07), (0.0052, 0.082), (0.020, 0.093), (0.0345, 0.117), (0.0380, 0.140)]
    outer += [(0.0365, 0.165), (0.0325, 0.194)]
    inner = [
        (0.0314, 0.194),
        (0.0354, 0.165),
        (0.0369, 0.140),
        (0.0334, 0.1178),
        (0.0192, 0.0945),
    ]
    inner += [(0.006, 0.0885), (0, 0.0877)]
    profile = np.concatenate(
        [
            [(0, 0), (0.0355, 0)],
            shapes.smooth_profile(outer),
            [(0.03195, 0.1944)],
            shapes.smooth_profile(inner),
        ]
    )
    stage.put(
        "wine_glass", shapes.lathe(profile, 96, 60), stage.glass, translation=[-0.175, 0, -0.225]
    )


def add_candles(stage: Stage) -> None:
    """Tea lights on the table and the book, and a candle in a brass stick."""
    cup = [(0, 0), (0.0185, 0), (0.0192, 0.0008), (0.0192, 0.0150), (0.0196, 0.0152)]
    cup += [(0.0196, 0.0156), (0.0188, 0.0156), (0.0188, 0.0010), (0, 0.0010)]
    wax = stage.matter(
        "wax",
        stage.shine(CANDLE, 3.0),
        baseColorFactor=[0.85, 0.80, 0.70, 1],
        roughnessFactor=0.5,
    )
    wick = stage.matter("wick", baseColorFactor=[0.03, 0.03, 0.03, 1], roughnessFactor=0.9)
    flame = stage.matter("flame", stage.shine(CANDLE, 620), baseColorFactor=[0, 0, 0, 1])
    tongue = [
        (0, 0),
        (0.0022, 0.0018),
        (0.0036, 0.006),
        (0.0034, 0.010),
        (0.0020, 0.016),
        (0.0007, 0.021),
        (0, 0.0235),
    ]
    meshes = [
        stage.glb.add_mesh("tea_cup", shapes.lathe(cup, 64), stage.steel),
        stage.glb.add_mesh(
            "tea_wax", shapes.lathe([(0.0187, 0.009), (0.0180, 0.0105), (0, 0.0098)], 48), wax
        ),
        stage.glb.add_mesh(
            "wick",
            shapes.tube([(0, 0.009, 0), (0.0003, 0.013, 0), (0.001, 0.016, 0)], 0.0006),
            wick,
        ),
        stage.glb.add_mesh("flame", shapes.lathe(shapes.smooth_profile(tongue), 24, 180), flame),
    ]
    for x, y, z in [(-0.088, 0, -0.115), (0.085, 0, -0.30), (-0.315, 0.0335, -0.19)]:
        for mesh in meshes:
            lift = 0.0125 if mesh == meshes[3] else 0.0
            stage.glb.add_node("tea_light", mesh=mesh, translation=[x, y + lift, z])
    stick = [
        (0.046, 0),
        (0.047, 0.003),
        (0.040, 0.007),
        (0.018, 0.012),
        (0.009, 0.022),
        (0.0075, 0.040),
    ]
    stick += [(0.014, 0.052), (0.0075, 0.063), (0.0065, 0.090), (0.013, 0.106), (0.0145, 0.118)]
    profile = np.concatenate(
        [[(0, 0)], shapes.smooth_profile(stick), [(0.0115, 0.118), (0.0115, 0.110), (0, 0.110)]]
    )
    x, z = 0.295, -0.215
    stage.put("candle_stick", shapes.lathe(profile, 64), stage.brass, translation=[x, 0, z])
    candle = [(0.0108, 0.1105), (0.0108, 0.196), (0.0098, 0.199), (0.003, 0.197), (0, 0.1965)]
    stage.put("candle", shapes.lathe(candle, 48), wax, translation=[x, 0, z])
    stage.glb.add_node("candle_flame", mesh=meshes[3], translation=[x, 0.199, z], scale=[1.25] * 3)


def add_small_things(stage: Stage) -> None:
    """A book, cards, dice, marbles and ball bearings."""
    g = stage.glb
    color, packed = textures.book_cover()
    cloth = stage.matter(
        "cloth",
        metallicFactor=1.0,
        baseColorTexture=g.add_picture("cloth", textures.png(color)),
        metallicRoughnessTexture=g.add_picture("cloth_mr", textures.png(packed)),
    )
    paper_picture = g.add_picture("pages", textures.png(textures.pages()))
    paper = stage.matter("paper", baseColorTexture=paper_picture, roughnessFactor=0.9)
    book = g.add_node("book", translation=[-0.315, 0, -0.20], rotation=turn_y(28))
    plain = (0.02, 0.02, 0.03, 0.03)
    cover = shapes.box(
        (0.145, 0.0025, 0.215), [plain, plain, (0, 0, 1, 1), (0, 0, 1, 1), plain, plain]
    )
    spine = shapes.moved(shapes.box((0.0025, 0.0330, 0.215), [plain] * 6), (-0.0725, 0.0002, 0))
    covers = shapes.join(cover, shapes.moved(cover, (0, 0.0309, 0)), spine)
    stage.put("covers", covers, cloth, parent=book)
    stage.put(
        "leaves",
        shapes.box((0.139, 0.0282, 0.207)),
        paper,
        parent=book,
        translation=[-0.001, 0.0026, 0],
    )

    a = np.linspace(0, math.pi / 2, 5)
    corner = 0.0035 * np.stack([np.cos(a), np.sin(a)], 1)
    w, h = 0.0315 - 0.0035, 0.044 - 0.0035
    rounded = np.concatenate(
        [
            np.add(corner, (w, h)),
            corner[::-1] * (-1, 1) + (-w, h),
            -corner - (w, h),
            corner[::-1] * (1, -1) + (w, -h),
        ]
    )
    outline = rounded[::-1]  # counter-clockwise from above: z points at the viewer
    for k, (rank, suit) in enumerate([("4", "diamond"), ("7", "heart"), ("A", "spade")]):
        face = g.add_picture(f"card_{rank}", textures.png(textures.card(rank, suit)))
        matter = stage.matter(f"card_{rank}", baseColorTexture=face, roughnessFactor=0.35)
        place = [-0.142 + 0.016 * k, 0.0003 + 0.0004 * k, 0.083 + 0.004 * k]
        stage.put(
            f"card_{rank}",
            shapes.slab(outline, 0.0003),
            matter,
            translation=place,
            rotation=turn_y(34 - 19 * k),
        )

    rects = [(k / 6, 0, (k + 1) / 6, 1) for k in range(6)]
    spots = stage.matter(
        "die",
        baseColorTexture=g.add_picture("die", textures.png(textures.die())),
        roughnessFactor=0.15,
    )
    die = g.add_mesh("die", shapes.box((0.014, 0.014, 0.014), rects), spots)
    g.add_node("die", mesh=die, translation=[0.070, 0, 0.118], rotation=turn_y(25))
    g.add_node("die", mesh=die, translation=[0.094, 0, 0.103], rotation=[0, 0.26, 0, 0.966])

    cobalt = stage.clear("cobalt_glass", (0.10, 0.28, 0.90), 0.012)
    amber = stage.clear("amber_glass", (0.95, 0.45, 0.08), 0.012)
    for name, x, z, radius, matter in [
        ("marble", -0.032, 0.128, 0.0085, cobalt),
        ("marble", 0.218, 0.085, 0.0090, amber),
        ("bearing", 0.006, 0.098, 0.0065, stage.steel),
        ("bearing", 0.024, 0.086, 0.0045, stage.steel),
        ("bearing", 0.020, 0.112, 0.0045, stage.steel),
        ("bearing", -0.225, 0.030, 0.0120, stage.steel),
    ]:
        stage.put(name, shapes.ball(radius, 40, 64), matter, translation=[x, radius, z])
