"""A scene while it is being made: matter, softboxes, a backdrop and a camera in a few words."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from daguerre.exporters.gltf import Glb, Shape
from kit import shapes
from kit.pose import Point, look


class Studio:
    """A GLB in the making, in metres, y up, luminances in cd/m2 of which 1 shows as white."""

    def __init__(self, script: str = "extensions.py") -> None:
        self.glb = Glb(f"daguerre scenes/{script}")

    def matter(
        self, name: str, color: Point, roughness: float = 0.5, metallic: float = 0.0, **more: Any
    ) -> int:
        """A material; `more` is glTF's own, extensions by their names without KHR_materials_."""
        extensions = more.pop("extensions", {})
        pbr = {"baseColorFactor": [*color, 1][:4], "roughnessFactor": roughness}
        pbr |= {"metallicFactor": metallic, **more.pop("pbr", {})}
        named = {f"KHR_materials_{key}": value for key, value in extensions.items()}
        if named:
            more["extensions"] = named
        return self.glb.add_material(name, pbrMetallicRoughness=pbr, **more)

    def shining(self, name: str, color: Point, luminance: float, **more: Any) -> int:
        """Black matter that emits `luminance` in linear Rec.709 `color`; a texture may follow."""
        y = 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2]
        peak = max(color)
        strength = {"emissive_strength": {"emissiveStrength": luminance * peak / y}}
        factor = [c / peak for c in color]
        return self.matter(name, (0, 0, 0), 1, emissiveFactor=factor, extensions=strength, **more)

    def put(
        self, name: str, shape: Shape, material: int, at: Point = (0, 0, 0), **node: Any
    ) -> int:
        """A mesh and the one node that shows it."""
        mesh = self.glb.add_mesh(name, shape, material)
        return self.glb.add_node(name, mesh=mesh, translation=at, **node)

    def softbox(
        self, at: Point, target: Point, size: Point, luminance: float, color: Point = (1, 1, 1)
    ) -> None:
        """A lit rectangle that faces `target`, dark behind."""
        matter = self.shining("softbox", color, luminance)
        self.put("softbox", shapes.square(*size), matter, at, rotation=look(target, at))

    def backdrop(self, material: int, width: float, depth: float, height: float) -> None:
        """A floor that bends up into a wall at z = -depth, as in a photographer's studio."""
        bend = min(depth, height) / 2
        angle = np.linspace(0, math.pi / 2, 24)
        z = np.concatenate([[2 * depth], -depth + bend * (1 - np.sin(angle)), [-depth]])
        y = np.concatenate([[0], bend * (1 - np.cos(angle)), [height]])
        x = np.linspace(-width / 2, width / 2, 2)
        grid = np.stack(np.broadcast_arrays(x, y[:, None], z[:, None]), -1)
        self.put("backdrop", shapes.surface(grid, (width, 2 * depth + height)), material)

    def camera(
        self, eye: Point, target: Point, focal_length_mm: float, f_stop: float, focus: Point
    ) -> None:
        """A camera whose sharp plane goes through the point `focus`."""
        forward = np.subtract(target, eye) / np.linalg.norm(np.subtract(target, eye))
        distance = round(float(np.dot(np.subtract(focus, eye), forward)), 4)
        camera = self.glb.add_camera("Camera", focal_length_mm, f_stop, distance)
        self.glb.add_node("Camera", camera=camera, translation=eye, rotation=look(eye, target))
