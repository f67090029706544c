"""Eight arms: a tube each, bent by joints."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from daguerre.exporters.gltf import FLOAT, U8, Shape, Track
from extensions.studio import Studio
from kit import shapes
from kit.pose import turn_y

ARMS, JOINTS, LINK = 8, 7, 0.062  # arms, joints of each, and the way between two, m
START, HEIGHT = 0.05, 0.085  # where an arm begins: distance from the axis, and height
KEYS = 9
#: Bend of each joint, degrees: down to the sand, along it, and up into a spiral.
BEND = np.array([-26, 22, 14, 26, 42, 56, 60])


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


def add_arms(studio: Studio, matter: int, period_s: float) -> list[Track]:
    """One mesh for all arms, on a skin of all their joints; returns what moves them."""
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
            tracks.append(_bending(parent, j, k, period_s))
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


def _bending(node: int, joint: int, arm: int, period_s: float) -> Track:
    """A joint's turns, up and aside, as a wave that runs outward along the arm."""
    times = np.linspace(0, period_s, KEYS)
    phase = 2 * math.pi * (times / period_s - joint / 9 + arm * 0.37)
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
