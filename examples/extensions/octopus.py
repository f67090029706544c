"""An octopus that moves: eight arms on a skin, a breathing head, colours that change, a blink.

Uses skins, morph targets, KHR_animation_pointer, KHR_node_visibility, KHR_materials_clearcoat,
_emissive_strength and EXT_camera_physical. Everything repeats after 4 s: see --time.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from extensions.studio import Studio
from kit import shapes, textures
from kit.glb import FLOAT, U8, Glb, Shape, Track
from kit.pose import turn_y

ARMS, JOINTS, LINK = 8, 7, 0.062  # arms, joints of each, and the way between two, m
START, HEIGHT = 0.05, 0.085  # where an arm begins: distance from the axis, and height
PERIOD_S, KEYS = 4.0, 9
#: What each joint bends, degrees: down to the sand, along it, and up into a spiral.
BEND = np.array([-26, 22, 14, 26, 42, 56, 60])


def make() -> Glb:
    """The scene."""
    studio = Studio()
    _sea(studio)
    skin, tracks = _skin_matter(studio)
    tracks += _arms(studio, skin)
    tracks += _head(studio, skin)
    tracks += _bubbles(studio)
    studio.glb.add_animation("life", tracks)
    studio.softbox((-0.9, 1.5, 0.9), (0, 0.1, 0), (1.0, 1.0), 11, (0.9, 1.0, 0.98))
    studio.softbox((1.3, 0.8, -0.3), (0, 0.1, 0), (0.5, 0.9), 9, (0.6, 0.85, 1))
    studio.camera((0.12, 0.42, 1.2), (0, 0.115, 0), 50, 4, (0, 0.2, 0.1))
    return studio.glb


def _sea(studio: Studio) -> None:
    ripples = textures.noise((256, 256), (3, 26), 8) + 0.6 * textures.noise((256, 256), (1, 1), 9)
    bump = studio.glb.add_picture("sand", textures.png(textures.normal_map(ripples, 0.1)))
    sand = studio.matter("sand", (0.42, 0.36, 0.25), 0.95, normalTexture=bump)
    floor = shapes.square(6, 6, (0, 0, 12, 12))
    studio.put("sand", floor, sand, rotation=(-math.sqrt(0.5), 0, 0, math.sqrt(0.5)))
    water = studio.shining("water", (0.02, 0.22, 0.3), 0.16)
    studio.put("water", shapes.square(9, 4), water, (0, 1, -2.2))


def _skin_matter(studio: Studio) -> tuple[int, list[Track]]:
    spots = textures.noise((256, 256), (5, 5), 12) + 0.5 * textures.noise((256, 256), (2, 2), 13)
    mottled = textures.ramp(np.clip(0.5 + 0.3 * spots, 0, 1), [(0.55,) * 3, (0.85,) * 3, (1,) * 3])
    picture = studio.glb.add_picture("mottled", textures.jpeg(mottled))
    wet = {"clearcoat": {"clearcoatFactor": 0.8, "clearcoatRoughnessFactor": 0.15}}
    matter = studio.matter(
        "skin", (0.8, 0.2, 0.07), 0.55, pbr={"baseColorTexture": picture}, extensions=wet
    )
    colors = [(0.8, 0.2, 0.07, 1), (0.5, 0.12, 0.4, 1), (0.75, 0.5, 0.3, 1), (0.8, 0.2, 0.07, 1)]
    pointer = f"/materials/{matter}/pbrMetallicRoughness/baseColorFactor"
    return matter, [Track.to(pointer, np.linspace(0, PERIOD_S, 4), colors)]


def _arm() -> tuple[Shape, NDArray[np.int64], NDArray[np.float64]]:
    """One arm along +x, with two joints and their weights for each vertex."""
    steps = np.linspace(0, JOINTS - 0.05, 64)
    path = np.stack([START + LINK * steps, HEIGHT + 0 * steps, 0 * steps], 1)
    radii = 0.034 * (1 - steps / JOINTS) ** 0.8 + 0.004 * np.cos(steps / JOINTS * math.pi / 2)
    arm = shapes.swept(path, np.append(radii[:-1], 0.0004), 24)
    along = np.clip((arm.positions[:, 0] - START) / LINK - 0.5, 0, JOINTS - 1.001)
    first = along.astype(int)
    share = along - first
    joints = np.stack([first, first + 1, 0 * first, 0 * first], 1)
    weights = np.stack([1 - share, share, 0 * share, 0 * share], 1)
    return arm, joints, weights * (weights > 1e-6)


def _arms(studio: Studio, matter: int) -> list[Track]:
    glb = studio.glb
    arm, joints, weights = _arm()
    parts, numbers, inverse, nodes, tracks = [], [], [], [], []
    for k in range(ARMS):
        degrees = 360 / ARMS * (k + 0.5)
        angle = math.radians(degrees)
        c, s = math.cos(angle), math.sin(angle)
        parts.append(shapes.turned(arm, [[c, 0, s], [0, 1, 0], [-s, 0, c]]))
        numbers.append(np.where(weights > 0, joints + JOINTS * k, 0))
        parent = glb.add_node("arm", rotation=turn_y(degrees), translation=(0, HEIGHT, 0))
        for j in range(JOINTS):
            x = START if j == 0 else LINK
            parent = glb.add_node("joint", parent, translation=(x, 0, 0))
            nodes.append(parent)
            inverse.append(
                [[c, 0, -s, -START - LINK * j], [0, 1, 0, -HEIGHT], [s, 0, c, 0], [0, 0, 0, 1]]
            )
            tracks.append(_bending(parent, j, k))
    columns = np.array(inverse, float).swapaxes(1, 2).reshape(-1, 16)  # stored by columns
    matrices = glb.add_accessor(columns, "MAT4", FLOAT)
    skin = glb.add("skins", {"joints": nodes, "inverseBindMatrices": matrices})
    more = {
        "JOINTS_0": glb.add_accessor(np.concatenate(numbers), "VEC4", U8, target=34962),
        "WEIGHTS_0": glb.add_accessor(np.tile(weights, (ARMS, 1)), "VEC4", FLOAT, target=34962),
    }
    mesh = glb.add_mesh("arms", shapes.join(*parts), matter, more)
    glb.add_node("arms", mesh=mesh, skin=skin)
    return tracks


def _bending(node: int, joint: int, arm: int) -> Track:
    """A joint's turns, up and aside, as a wave that runs outward along the arm."""
    times = np.linspace(0, PERIOD_S, KEYS)
    phase = 2 * math.pi * (times / PERIOD_S - joint / 9 + arm * 0.37)
    up = np.radians(
        BEND[joint] * (1 + 0.18 * np.sin(2.4 * arm)) + (2 + 2.5 * joint) * np.sin(phase)
    )
    aside = np.radians((3 + 2.0 * joint) * np.sin(phase + 1.3 * arm))
    keys = [
        (np.sin(a / 2) * np.sin(u / 2), np.sin(a / 2) * np.cos(u / 2), *_half(a, u))
        for a, u in zip(aside, up, strict=True)
    ]  # the product of a turn about y and one about z
    return Track({"node": node, "path": "rotation"}, times, keys)


def _half(aside: float, up: float) -> tuple[float, float]:
    return math.cos(aside / 2) * math.sin(up / 2), math.cos(aside / 2) * math.cos(up / 2)


def _head(studio: Studio, matter: int) -> list[Track]:
    """A mantle with two morph targets, eyes, and lids that are seen for a moment."""
    glb = studio.glb
    bulb = [(0, 0.05), (0.05, 0.055), (0.07, 0.09), (0.06, 0.13), (0.085, 0.19), (0.1, 0.25)]
    bulb += [(0.085, 0.31), (0.04, 0.345), (0, 0.35)]
    head = shapes.lathe(shapes.smooth_profile(bulb, 6), 64, 180)
    p = head.positions.astype(float)
    high = np.clip((p[:, 1:2] - 0.12) / 0.2, 0, 1)
    breath = p * [0.22, 0, 0.22] * high
    lean = np.stack([0.03 * high[:, 0], 0 * high[:, 0], -0.09 * high[:, 0] ** 2], 1)
    targets = [{"POSITION": glb.add_accessor(d, "VEC3", FLOAT)} for d in (breath, lean)]
    mesh = glb.add_mesh("head", head, matter, targets=targets)
    node = glb.add_node("head", mesh=mesh)
    times = np.linspace(0, PERIOD_S, 5)
    weights = [(0, 0.8), (1, 1), (0.2, 0.7), (0.9, 0.9), (0, 0.8)]
    tracks = [Track({"node": node, "path": "weights"}, times, weights)]
    white = studio.matter("eye", (0.85, 0.8, 0.6), 0.15)
    black = studio.matter("pupil", (0.01, 0.01, 0.01), 0.08)
    for side in (-1, 1):
        at = np.array([0.05 * side, 0.165, 0.048])
        studio.put("eye", shapes.ball(0.026), white, at)
        pupil = shapes.ball(1.0, 16, 32)
        studio.put(
            "pupil", pupil, black, np.add(at, (0.004 * side, 0, 0.017)), scale=(0.015, 0.008, 0.011)
        )
        lid = studio.put("lid", shapes.ball(0.028), matter, at)
        hidden = {"KHR_node_visibility": {"visible": False}}
        glb.json["nodes"][lid]["extensions"] = hidden
        pointer = f"/nodes/{lid}/extensions/KHR_node_visibility/visible"
        tracks.append(Track.to(pointer, [0, 1.9, 2.1], [False, True, False], "STEP"))
    glb.use("KHR_node_visibility")
    return tracks


def _bubbles(studio: Studio) -> list[Track]:
    """Bubbles that rise; every other one comes and goes."""
    glb = studio.glb
    air = {"transmission": {"transmissionFactor": 1.0}}
    film = studio.matter("bubble", (1, 1, 1), 0, extensions=air)
    mesh, tracks = glb.add_mesh("bubble", shapes.ball(1.0, 24, 48), film), []
    for k, (x, y, radius) in enumerate(
        [(0.2, 0.3, 0.014), (0.23, 0.36, 0.02), (0.19, 0.43, 0.011), (0.25, 0.22, 0.008)]
    ):
        node = glb.add_node("bubble", mesh=mesh, translation=(x, y, 0.02), scale=[radius] * 3)
        keys = [(x, y, 0.02), (x + 0.03, y + 0.25, 0.02)]
        tracks.append(Track({"node": node, "path": "translation"}, [0, PERIOD_S], keys))
        if k % 2:
            glb.json["nodes"][node]["extensions"] = {"KHR_node_visibility": {"visible": True}}
            pointer = f"/nodes/{node}/extensions/KHR_node_visibility/visible"
            tracks.append(Track.to(pointer, [0, 2], [True, False], "STEP"))
    return tracks
