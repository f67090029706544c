"""Where things stand, and how a thing of several materials becomes one node."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.exporters.gltf import Shape
from kit import shapes
from night.stage import Stage

TOP = 0.74  # of the desk, m
WIDE, DEEP = 1.80, 0.80  # its top
BACK = -0.46  # the wall behind it, z in m


def on_desk(x: float, z: float, lift: float = 0.0) -> tuple[float, float, float]:
    """A place on the desk, whose middle is x = z = 0."""
    return x, TOP + lift, z


def put(stage: Stage, name: str, parts: Sequence[tuple[Shape, int]], **node: Any) -> int:
    """A thing as one node."""
    return stage.glb.add_node(name, mesh=stage.glb.add_parts(name, shapes.by_matter(parts)), **node)


def translucent(
    stage: Stage,
    name: str,
    color: Sequence[float],
    roughness: float,
    share: float,
    tint: Sequence[float],
) -> int:
    """Something thin, a leaf or linen: a share of the light comes through, in its own tint."""
    return stage.glb.add_material(
        name,
        doubleSided=True,
        pbrMetallicRoughness={
            "baseColorFactor": [*color, 1],
            "metallicFactor": 0.0,
            "roughnessFactor": roughness,
        },
        extensions={
            "KHR_materials_diffuse_transmission": {
                "diffuseTransmissionFactor": share,
                "diffuseTransmissionColorFactor": [*tint],
            }
        },
    )


def about_x(degrees: float) -> NDArray[np.float64]:
    """A rotation matrix: y toward z."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return np.array(((1, 0, 0), (0, c, -s), (0, s, c)))


def about_y(degrees: float) -> NDArray[np.float64]:
    """A rotation matrix: z toward x."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return np.array(((c, 0, s), (0, 1, 0), (-s, 0, c)))


def about_z(degrees: float) -> NDArray[np.float64]:
    """A rotation matrix: x toward y."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return np.array(((c, -s, 0), (s, c, 0), (0, 0, 1)))


def rounded(wide: float, deep: float, radius: float) -> list[tuple[float, float]]:
    """Outline (x, z) of a rectangle with round corners, counter-clockwise from above."""
    outline = []
    for k, (sx, sz) in enumerate(((1, -1), (-1, -1), (-1, 1), (1, 1))):
        for step in range(7):
            angle = math.radians(90 * k + 15 * step)
            x = sx * (wide / 2 - radius) + radius * math.cos(angle)
            outline.append((x, sz * (deep / 2 - radius) - radius * math.sin(angle)))
    return outline
