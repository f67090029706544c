"""The orrery: the thing that moves, a sun and planets on nested turning nodes."""

from __future__ import annotations

import math

import numpy as np

from kit import shapes, textures
from kit.pose import turn_y
from night.stage import Stage


def add_orrery(stage: Stage) -> dict[int, int]:
    """Brass base, a bulb for the sun, planets on arms. Returns the turning nodes and turns."""
    g = stage.glb
    root = g.add_node("orrery", translation=[0, 0, 0])
    base = [(0, 0), (0.054, 0), (0.056, 0.002), (0.056, 0.005), (0.052, 0.007), (0.050, 0.011)]
    base += [(0.0485, 0.0125)]
    stage.put("base", shapes.lathe([*base, (0.047, 0.0125)], 96), stage.brass, parent=root)
    color, packed = textures.dial()
    engraved = stage.matter(
        "dial",
        metallicFactor=1.0,
        baseColorTexture=g.add_picture("dial", textures.png(color)),
        metallicRoughnessTexture=g.add_picture("dial_mr", textures.png(packed)),
    )
    a = np.linspace(0, 2 * math.pi, 96, endpoint=False)
    plate = shapes.slab(0.0475 * np.stack([np.cos(a), -np.sin(a)], 1), 0.001)
    stage.put("dial", plate, engraved, parent=root, translation=[0, 0.0118, 0])
    column = [(0.013, 0.0126), (0.012, 0.016), (0.006, 0.020), (0.0042, 0.030), (0.0075, 0.037)]
    column += [
        (0.0042, 0.044),
        (0.0035, 0.056),
        (0.0035, 0.088),
        (0.0058, 0.0935),
        (0.0052, 0.097),
    ]
    profile = np.concatenate([shapes.smooth_profile(column), [(0, 0.097)]])
    stage.put("column", shapes.lathe(profile, 48), stage.brass, parent=root)
    bulb = stage.matter("sun", stage.shine((1.0, 0.72, 0.40), 180), baseColorFactor=[0, 0, 0, 1])
    stage.put("sun", shapes.ico_ball(0.0105, 3), bulb, parent=root, translation=[0, 0.1065, 0])

    def stone(name: str, picture: textures.Picture, roughness: float) -> int:
        texture = g.add_picture(name, textures.png(picture))
        return stage.matter(name, baseColorTexture=texture, roughnessFactor=roughness)

    jupiter = stone("jupiter", textures.planet_bands(), 0.22)
    earth = stone("earth", textures.planet_seas(), 0.12)
    copper = stage.wire
    pearl = stage.matter("pearl", baseColorFactor=[0.83, 0.76, 0.66, 1], roughnessFactor=0.25)
    turns: dict[int, int] = {}
    planets = {}
    for name, reach, hub, radius, angle, count, matter in [
        ("mercury", 0.029, 0.083, 0.0038, 205, 12, copper),
        ("venus", 0.044, 0.078, 0.0062, 118, 7, pearl),
        ("earth", 0.068, 0.073, 0.0080, -27, 4, earth),
        ("jupiter", 0.100, 0.067, 0.0150, 196, 2, jupiter),
        ("saturn", 0.134, 0.061, 0.0105, 21, 1, pearl),
    ]:
        pose = g.add_node(f"{name}_start", root, rotation=turn_y(angle))
        arm = g.add_node(f"{name}_arm", pose)
        turns[arm] = count
        sun_height = 0.1065
        bend = np.array([(0, hub, 0), (reach - 0.004, hub, 0), (reach, hub + 0.004, 0)])
        rod = np.array([(reach, hub + 0.004, 0), (reach, sun_height - radius * 0.98, 0)])
        smooth = np.concatenate([np.linspace(bend[0], bend[1], 4), bend[2:]])
        ring = shapes.lathe(
            [
                (0.0036, hub - 0.0018),
                (0.0062, hub - 0.0018),
                (0.0062, hub + 0.0018),
                (0.0036, hub + 0.0018),
            ],
            32,
        )
        wires = shapes.join(ring, shapes.tube(smooth, 0.0011), shapes.tube(rod, 0.0007))
        stage.put(f"{name}_rod", wires, stage.brass, parent=arm)
        globe = shapes.ball(radius, 32, 64)
        planets[name] = stage.put(
            name,
            globe,
            matter,
            parent=arm,
            translation=[reach, sun_height, 0],
            rotation=turn_y(40),
        )
    add_moon(stage, planets["earth"], turns)
    add_ring(stage, planets["saturn"])
    return turns


def add_moon(stage: Stage, earth: int, turns: dict[int, int]) -> None:
    """A moon on an arm of its own, a child of the earth: two turns on top of one another."""
    arm = stage.glb.add_node("moon_arm", earth)
    turns[arm] = 24
    texture = stage.glb.add_picture("moon", textures.png(textures.moon()))
    matter = stage.matter("moon", baseColorTexture=texture, roughnessFactor=0.8)
    wire = shapes.tube(
        [(0, -0.0085, 0), (0.012, -0.0085, 0), (0.0155, -0.005, 0), (0.016, -0.0015, 0)], 0.0005
    )
    stage.put("moon_rod", wire, stage.brass, parent=arm)
    stage.put("moon", shapes.ball(0.0026, 16, 32), matter, parent=arm, translation=[0.016, 0, 0])


def add_ring(stage: Stage, saturn: int) -> None:
    """Saturn's ring: a flat square with an alpha mask."""
    g = stage.glb
    matter = g.add_material(
        "ring",
        pbrMetallicRoughness={
            "metallicFactor": 0.0,
            "roughnessFactor": 0.4,
            "baseColorTexture": g.add_picture("ring", textures.png(textures.ring_bands())),
        },
        alphaMode="MASK",
        doubleSided=True,
    )
    tilt = math.radians(24) / 2
    corners = [(-1, 1), (1, 1), (1, -1), (-1, -1)]
    flat = shapes.slab(0.0235 * np.array(corners), 0.0)
    flat.indices = flat.indices[:2]  # the top face alone
    stage.put("ring", flat, matter, parent=saturn, rotation=[math.sin(tilt), 0, 0, math.cos(tilt)])
