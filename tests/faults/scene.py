"""A small scene of two cameras: a wall, a lamp that both see, and a ball that flies past."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from tests.support.formats.make_gltf import Builder


def write_scene(path: Path, strength: float = 1.0) -> Path:
    """Writes it as .glb; ``strength``: emission of the lamp."""
    made = Builder()
    grey = {"pbrMetallicRoughness": {"metallicFactor": 0, "baseColorFactor": [0.5, 0.3, 0.1, 1]}}
    made.node(mesh=_square(made, 2.0, made.add("materials", grey)), translation=[0, 0, -3])
    lamp = {"pbrMetallicRoughness": {"metallicFactor": 0}, "emissiveFactor": [1, 1, 1]}
    if strength != 1:
        name = "KHR_materials_emissive_strength"
        lamp["extensions"] = {name: {"emissiveStrength": strength}}
    made.node(mesh=_square(made, 0.05, made.add("materials", lamp)), translation=[0.2, 0.3, -2.9])
    flier = made.node(mesh=_square(made, 0.2, 0), name="Flier", translation=[-1, 0, -2])
    moments, places = [0.0, 1.0], [[-1, 0, -2], [1, 0.5, -2]]
    ends: dict[str, Any] = {"min": [0.0], "max": [1.0]}
    sampler = {
        "input": made.accessor(moments, **ends),
        "output": made.accessor(np.array(places, np.float32)),
    }
    target = {"node": flier, "path": "translation"}
    made.add(
        "animations",
        {"samplers": [sampler], "channels": [{"sampler": 0, "target": target}]},
    )
    made.add("cameras", {"type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.01}})
    for name, x in (("left", -0.1), ("right", 0.1)):
        made.node(camera=0, name=name, translation=[x, 0, 0])
    return made.glb(path)


def _square(made: Builder, size: float, material: int) -> int:
    corners = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float32) * size
    ends: dict[str, Any] = {"min": corners.min(0).tolist(), "max": corners.max(0).tolist()}
    normals = made.accessor(np.tile(np.float32([0, 0, 1]), (4, 1)))
    attributes = {"POSITION": made.accessor(corners, **ends), "NORMAL": normals}
    return made.mesh(
        attributes, indices=made.accessor(np.array([0, 1, 2, 0, 2, 3]), "u2"), material=material
    )
