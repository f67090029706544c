"""The scene while it is being made: the file, and the materials that several things share."""

from __future__ import annotations

from typing import Any

from daguerre.exporters.gltf import Glb, Shape
from kit import shapes, textures
from kit.pose import Point

WARM, CANDLE, COOL = (1.0, 0.60, 0.26), (1.0, 0.55, 0.18), (0.55, 0.75, 1.0)
PALETTE = [WARM, (1.0, 0.78, 0.50), (1.0, 0.40, 0.14), COOL, (1.0, 0.20, 0.16), (0.30, 0.90, 0.75)]


class Stage:
    """A GLB in the making, with materials and placing in a few words."""

    def __init__(self, generator: str = "daguerre scenes/night_table.py") -> None:
        self.glb = Glb(generator)
        color, packed = textures.brass_patina()
        self.brass = self.matter(
            "brass",
            metallicFactor=1.0,
            baseColorTexture=self.glb.add_picture("brass", textures.png(color)),
            metallicRoughnessTexture=self.glb.add_picture("brass_mr", textures.png(packed)),
        )
        self.steel = self.matter(
            "steel", baseColorFactor=[0.72, 0.72, 0.74, 1], metallicFactor=1.0, roughnessFactor=0.06
        )
        self.wire = self.matter(
            "wire", baseColorFactor=[0.80, 0.45, 0.28, 1], metallicFactor=1.0, roughnessFactor=0.3
        )
        self.glass = self.clear("glass", (0.97, 0.99, 0.98), 0.25)
        self.lamp_meshes: dict[tuple[float, ...], int] = {}

    def matter(self, name: str, emissive: Point = (0, 0, 0), **pbr: object) -> int:
        """A metallic-roughness material; without metallicFactor it is no metal."""
        pbr = {"metallicFactor": 0.0} | pbr
        if max(emissive) == 0:
            return self.glb.add_material(name, pbrMetallicRoughness=pbr)
        return self.glb.add_material(name, pbrMetallicRoughness=pbr, **self.emission(emissive))

    @staticmethod
    def emission(rgb: Point) -> dict[str, object]:
        """Emission of linear Rec.709 `rgb` in cd/m2: a factor up to 1 and its strength."""
        peak = max(rgb)
        return {
            "emissiveFactor": [c / peak for c in rgb],
            "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": peak}},
        }

    def clear(self, name: str, color: Point, distance_m: float, ior: float = 1.5) -> int:
        """Clear matter that keeps `color` of white light over `distance_m`."""
        volume = {
            "thicknessFactor": 0.01,
            "attenuationColor": list(color),
            "attenuationDistance": distance_m,
        }
        return self.glb.add_material(
            name,
            pbrMetallicRoughness={"metallicFactor": 0.0, "roughnessFactor": 0.0},
            extensions={
                "KHR_materials_transmission": {"transmissionFactor": 1.0},
                "KHR_materials_ior": {"ior": ior},
                "KHR_materials_volume": volume,
            },
        )

    @staticmethod
    def shine(color: Point, luminance: float) -> list[float]:
        """Linear Rec.709 of this hue whose luminance is `luminance` cd/m2."""
        y = 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2]
        return [c / y * luminance for c in color]

    def put(self, name: str, shape: Shape, material: int, **node: Any) -> int:
        """A mesh and the one node that shows it."""
        return self.glb.add_node(name, mesh=self.glb.add_mesh(name, shape, material), **node)

    def lamp(
        self, at: Point, radius: float, color: Point, luminance: float, facing: bool = False
    ) -> None:
        """A small lamp: a ball, or a disc that faces +z. Lamps of one colour share a mesh."""
        key = (*color, luminance, facing)
        if key not in self.lamp_meshes:
            black = {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0.0}
            emission = self.emission(self.shine(color, luminance))
            number = len(self.lamp_meshes)
            matter = self.glb.add_material(f"lamp_{number}", pbrMetallicRoughness=black, **emission)
            unit = shapes.disc(1.0, 12) if facing else shapes.ico_ball(1.0, 1)
            self.lamp_meshes[key] = self.glb.add_mesh(f"lamp_{number}", unit, matter)
        self.glb.add_node("lamp", mesh=self.lamp_meshes[key], translation=at, scale=[radius] * 3)
