"""A laptop, and a mouse on its mat."""

from __future__ import annotations

import numpy as np

from calibrated import pictures
from calibrated.place import about_x, on_desk, put, rounded
from daguerre.exporters.gltf import Shape
from kit import shapes, textures
from kit.pose import turn_y
from night.stage import Stage

WIDE, DEEP, THICK = 0.325, 0.225, 0.014  # m
SHINES = 260  # white of the screen, cd/m2


def add_computer(stage: Stage) -> None:
    """On the desk's middle, turned a little."""
    metal = stage.matter(
        "aluminium", baseColorFactor=[0.56, 0.57, 0.58, 1], metallicFactor=1.0, roughnessFactor=0.38
    )
    black = stage.matter("keys", baseColorFactor=[0.018, 0.018, 0.02, 1], roughnessFactor=0.45)
    shown = stage.glb.add_picture("editor", textures.png(pictures.screen()))
    light = stage.glb.add_material(
        "screen",
        pbrMetallicRoughness={"baseColorFactor": [0.01, 0.01, 0.01, 1], "roughnessFactor": 0.15}
        | {"metallicFactor": 0.0},
        emissiveTexture=shown,
        **stage.emission([SHINES] * 3),
    )
    base = shapes.slab(rounded(WIDE, DEEP, 0.014), THICK)
    pad = shapes.moved(shapes.slab(rounded(0.115, 0.072, 0.004), 0.0005), (0, THICK, 0.065))
    parts = [(base, metal), (pad, metal), (_keys(), black)]
    parts += [(_lid(shape), matter) for shape, matter in _screen(metal, black, light)]
    put(stage, "laptop", parts, translation=on_desk(-0.12, -0.10), rotation=turn_y(9))
    _add_mouse(stage)


def _keys() -> Shape:
    """Five rows; the lowest has the long one."""
    keys = []
    for row in range(5):
        widths = [1.0] * 13 if row < 4 else [1, 1, 1, 1.25, 5.5, 1.25, 1, 1]
        x, pitch = -0.1345, 0.0207
        for width in widths:
            key = shapes.box((pitch * width - 0.0030, 0.0016, 0.0170))
            z = -0.075 + 0.0200 * row
            keys.append(shapes.moved(key, (x + pitch * width / 2, THICK, z)))
            x += pitch * width
    return shapes.join(*keys)


def _screen(metal: int, black: int, light: int) -> list[tuple[Shape, int]]:
    """The lid as it stands upright: back, bezel, and what shines."""
    high = DEEP - 0.004
    back = shapes.box((WIDE, high, 0.005))
    bezel = shapes.moved(shapes.square(WIDE - 0.004, high - 0.004), (0, high / 2, 0.0028))
    screen = shapes.square(0.306, 0.306 * 0.625)
    return [
        (back, metal),
        (bezel, black),
        (shapes.moved(screen, (0, high / 2 + 0.003, 0.0030)), light),
    ]


def _lid(shape: Shape) -> Shape:
    """Open by 110 degrees."""
    return shapes.moved(shapes.turned(shape, about_x(-20)), (0, THICK, -DEEP / 2 + 0.004))


def _add_mouse(stage: Stage) -> None:
    felt = stage.matter("felt", baseColorFactor=[0.10, 0.11, 0.12, 1], roughnessFactor=1.0)
    mat = shapes.slab(rounded(0.24, 0.20, 0.012), 0.003)
    put(stage, "mouse mat", [(mat, felt)], translation=on_desk(0.20, 0.17), rotation=turn_y(4))
    shell = stage.matter("mouse", baseColorFactor=[0.78, 0.77, 0.75, 1], roughnessFactor=0.3)
    dark = stage.matter("wheel", baseColorFactor=[0.05, 0.05, 0.05, 1], roughnessFactor=0.6)
    ball = shapes.ball(1.0, 24, 48)
    body = Shape(
        ball.positions * np.float32([0.029, 0.023, 0.053]), ball.normals, ball.uv, ball.indices
    )
    body.normals = _unit(ball.normals / np.float32([0.029, 0.023, 0.053]))
    wheel = shapes.moved(shapes.box((0.006, 0.010, 0.016)), (0, 0.0135, -0.030))
    at = on_desk(0.21, 0.17, 0.003)
    put(stage, "mouse", [(_upper(body), shell), (wheel, dark)], translation=at, rotation=turn_y(-8))


def _upper(shape: Shape) -> Shape:
    """Part of a shape above y = 0."""
    above = (shape.positions[shape.indices][:, :, 1] >= -1e-6).all(axis=1)
    return Shape(shape.positions, shape.normals, shape.uv, shape.indices[above])


def _unit(
    vectors: np.ndarray[tuple[int, ...], np.dtype[np.float32]],
) -> np.ndarray[tuple[int, ...], np.dtype[np.float32]]:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=1, keepdims=True), np.float32)
