"""The table, the room behind it, the lights that hang in it, and the camera."""

from __future__ import annotations

import numpy as np

from kit import shapes, textures
from kit.pose import look, turn_y
from night.stage import COOL, PALETTE, WARM, Stage


def add_table(stage: Stage) -> None:
    """Walnut boards, 1.9 m wide, turned a little against the camera."""
    color, packed, normal = textures.wood()
    boards = stage.glb.add_material(
        "walnut",
        pbrMetallicRoughness={
            "metallicFactor": 0.0,
            "baseColorTexture": stage.glb.add_picture("walnut", textures.jpeg(color)),
            "metallicRoughnessTexture": stage.glb.add_picture("walnut_mr", textures.jpeg(packed)),
        },
        normalTexture=stage.glb.add_picture("walnut_normal", textures.png(normal)),
    )
    wide, deep, thick, tile = 1.9, 1.1, 0.03, 0.72  # the texture repeats every 0.72 m
    rect = (0, 0, wide / tile, deep / tile)
    edge = (0, 0, wide / tile, thick / tile)
    top = shapes.box((wide, thick, deep), [edge, edge, rect, rect, edge, edge])
    u_axis = {
        0: (0, 0, -1),
        4: (0, 0, 1),
        8: (1, 0, 0),
        12: (1, 0, 0),
        16: (1, 0, 0),
        20: (-1, 0, 0),
    }
    tangents = np.array([(*u_axis[k - k % 4], 1) for k in range(24)], np.float32)
    top.tangents = tangents
    stage.put("table", top, boards, translation=[0.05, -thick, -0.08], rotation=turn_y(-14))


def add_room(stage: Stage) -> None:
    """A dark wall with a window, and the lights of a town outside, all far out of focus."""
    glow = textures.night_sky()
    sky = stage.glb.add_material(
        "night",
        pbrMetallicRoughness={"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0.0},
        emissiveTexture=stage.glb.add_picture("night", textures.png(glow)),
        emissiveFactor=[1, 1, 1],
        extensions={"KHR_materials_emissive_strength": {"emissiveStrength": 0.5}},
    )
    wall = stage.matter("wall", baseColorFactor=[0.16, 0.12, 0.10, 1], roughnessFactor=0.9)
    frame = stage.matter("frame", baseColorFactor=[0.10, 0.065, 0.045, 1], roughnessFactor=0.5)
    z = -4.55
    left, right, low, high = -1.05, 1.35, -0.55, 1.8
    pane = shapes.box((right - left, high - low, 0.02))
    stage.put("night_outside", pane, sky, translation=[(left + right) / 2, low, z - 0.4])
    for name, x, w, y, h in [
        ("wall_left", left - 2, 4, -0.75, 3.2),
        ("wall_right", right + 2, 4, -0.75, 3.2),
        ("wall_below", (left + right) / 2, right - left, -0.75, low + 0.75),
    ]:
        stage.put(name, shapes.box((w, h, 0.1)), wall, translation=[x, y, z])
    bar = shapes.box((0.05, high - low, 0.06))
    for x in (left, (left + right) / 2 + 0.1, right):
        stage.put("window_bar", bar, frame, translation=[x, low, z + 0.06])
    cross = shapes.box((right - left, 0.05, 0.06))
    for y in (low, 0.62):
        stage.put("window_bar", cross, frame, translation=[(left + right) / 2, y, z + 0.06])
    floor = stage.matter("floor", baseColorFactor=[0.10, 0.075, 0.06, 1], roughnessFactor=0.6)
    stage.put("floor", shapes.box((8, 0.05, 7)), floor, translation=[0, -0.80, -2.0])
    rng = np.random.default_rng(7)
    for _ in range(34):
        x, y = rng.uniform(left, right), -0.42 + 0.95 * rng.beta(1.3, 1.8)
        color = PALETTE[rng.choice(6, p=[0.34, 0.24, 0.16, 0.14, 0.07, 0.05])]
        stage.lamp(
            [x, y, z - 0.3],
            rng.uniform(0.022, 0.034),
            color,
            float(rng.choice([3.5, 6, 11])),
            True,
        )


def add_garlands(stage: Stage) -> None:
    """Bulbs on wires: hung across the room at 1.5 and 2.4 m, and one strewn over the table."""
    for z, y0, sag, radius, luminance, count, phase in [
        (-1.65, 0.46, 0.17, 0.010, 22, 13, 0.0),
        (-0.85, 0.37, 0.11, 0.0055, 30, 12, 0.4),
    ]:
        s = np.linspace(-1, 1, 49)
        x = s * (0.55 - 0.42 * z)
        y = y0 - sag * np.cos(1.5 * s + phase) + 0.02 * np.cos(9 * s)
        path = np.stack([x, y, z + 0.1 * np.sin(4 * s)], 1)
        stage.put("garland_wire", shapes.tube(path, 0.0015, 5), stage.wire)
        for k in range(count):
            p = path[4 * k] - (0, radius * 1.15, 0)
            stage.lamp(p, radius, PALETTE[[0, 1, 0, 2, 0, 3][k % 6]], luminance)
    t = np.linspace(0, 1, 240)
    x = -0.36 + 0.80 * t + 0.02 * np.sin(15 * t)
    z = 0.13 - 0.44 * t + 0.085 * np.sin(8.5 * t + 0.4)
    path = np.stack([x, 0.0018 + 0.0015 * np.sin(60 * t) ** 2, z], 1)
    path = path[np.hypot(path[:, 0], path[:, 2]) > 0.062]
    cuts = np.flatnonzero(np.linalg.norm(np.diff(path, axis=0), axis=1) > 0.02) + 1
    for part in np.split(path, cuts):
        stage.put("string_wire", shapes.tube(part, 0.0005, 6), stage.wire)
    for k, p in enumerate(path[3::6]):
        side = 0.004 * (-1) ** k
        stage.lamp([p[0], 0.0036, p[2] + side], 0.0026, WARM if k % 7 else COOL, 110)
    t = np.linspace(0, 1, 90)  # nearest of all, about half a metre from the lens
    path = np.stack([-0.27 + 0.60 * t, 0.0012 + 0 * t, 0.20 + 0.035 * np.sin(11 * t)], 1)
    stage.put("string_wire", shapes.tube(path, 0.0005, 6), stage.wire)
    for k, p in enumerate(path[4::9]):
        stage.lamp([p[0], 0.0036, p[2]], 0.0028, WARM if k % 4 else COOL, 14)


def add_camera(stage: Stage) -> None:
    """50 mm at f/2, focused on the sun's near side, as a photographer would frame it."""
    eye, target = (0.050, 0.172, 0.735), (0.022, 0.080, 0.0)
    forward = np.subtract(target, eye) / np.linalg.norm(np.subtract(target, eye))
    focus = float(np.dot(np.subtract((0.0, 0.1065, 0.0105), eye), forward))
    camera = stage.glb.add_camera("Camera", 50.0, 2.0, round(focus, 4))
    stage.glb.add_node("Camera", camera=camera, translation=eye, rotation=look(eye, target))


def add_lantern(stage: Stage) -> None:
    """A paper lantern beside the photographer, out of the picture: what models the objects."""
    stage.lamp([-0.50, 0.60, 0.50], 0.11, (1.0, 0.74, 0.46), 40)


def add_moonlight(stage: Stage) -> None:
    """A weak cool spot from behind: the rim on glass and metal that the lamps cannot give."""
    light = {
        "type": "spot",
        "name": "moonlight",
        "color": [0.55, 0.72, 1.0],
        "intensity": 0.9,
        "spot": {"innerConeAngle": 0.2, "outerConeAngle": 0.5},
    }
    stage.glb.use("KHR_lights_punctual")
    stage.glb.json["extensions"] = {"KHR_lights_punctual": {"lights": [light]}}
    eye = (-0.75, 1.15, -0.95)
    node = {"KHR_lights_punctual": {"light": 0}}
    stage.glb.add_node(
        "moonlight", translation=eye, rotation=look(eye, (0, 0.02, 0)), extensions=node
    )
