"""Six things on a shelf, one material extension each, and three choices of colour.

Uses KHR_materials_clearcoat, _sheen, _anisotropy, _iridescence, _specular,
_pbrSpecularGlossiness, _variants (--variant "at sea", "in the woods"), _emissive_strength and
EXT_camera_physical.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from daguerre.exporters.gltf import Glb
from extensions.studio import Studio
from kit import shapes, textures
from kit.pose import Point

VARIANTS = ("at sea", "in the woods")
VASE = [(0, 0), (0.05, 0), (0.085, 0.06), (0.095, 0.12), (0.06, 0.2), (0.032, 0.25), (0.048, 0.29)]
INSIDE = [(0.04, 0.285), (0.026, 0.25), (0.05, 0.2)]
POT = [(0, 0), (0.085, 0), (0.09, 0.006), (0.09, 0.17), (0.096, 0.176), (0.086, 0.176), (0.086, 0)]
BELL = [(0.1, 0), (0.088, 0.03), (0.07, 0.1), (0.045, 0.16), (0.012, 0.18), (0.01, 0.2), (0, 0.21)]
LEFT, RIGHT, UPPER, LOWER = -0.34, 0.34, 0.42, 0.02


def make() -> Glb:
    """The scene."""
    studio = Studio()
    studio.glb.json["extensions"] = {
        "KHR_materials_variants": {"variants": [{"name": name} for name in VARIANTS]}
    }
    studio.glb.use("KHR_materials_variants")
    _furniture(studio)
    _upper_board(studio)
    _lower_board(studio)
    studio.softbox((-1.5, 1.6, 1.5), (0, 0.4, 0), (1.1, 1.3), 9, (1, 0.95, 0.88))
    studio.softbox((1.7, 0.7, 1.0), (0, 0.4, 0), (0.5, 1.5), 8, (0.86, 0.93, 1))
    studio.softbox((0.3, 0.9, 3.2), (0, 0.4, 0), (2.5, 1.5), 0.9)
    studio.camera((0.1, 0.5, 2.1), (0, 0.375, 0), 58, 5.6, (0, 0.5, 0.08))
    return studio.glb


def _furniture(studio: Studio) -> None:
    color, packed, normal = textures.wood(512)
    add = studio.glb.add_picture
    pbr = {
        "baseColorTexture": add("wood", textures.jpeg(color)),
        "metallicRoughnessTexture": add("wood_mr", textures.jpeg(packed)),
    }
    bump = add("wood_normal", textures.png(normal))
    wood = studio.matter("wood", (1, 1, 1), 1, pbr=pbr, normalTexture=bump)
    plaster = studio.matter("plaster", (0.42, 0.47, 0.45), 0.9)
    long, side = (0, 0, 2, 0.4), (0, 0, 0.5, 0.03)
    board = shapes.box((1.3, 0.028, 0.32), [side, side, long, long, side, side])
    for y in (UPPER, LOWER):
        studio.put("board", board, wood, (0, y - 0.028, 0))
    wall = shapes.square(4, 3)
    studio.put("wall", wall, plaster, (0, 0.6, -0.17))


def _painted(studio: Studio, name: str, colors: list[Point], **look: Any) -> dict[str, Any]:
    """A primitive's material in three colours: as the file stands, and for each variant."""
    first, *others = [studio.matter(name, color, **look) for color in colors]
    mappings = [{"material": m, "variants": [k]} for k, m in enumerate(others)]
    return {"material": first, "extensions": {"KHR_materials_variants": {"mappings": mappings}}}


def _upper_board(studio: Studio) -> None:
    glb = studio.glb
    vase = shapes.lathe(shapes.smooth_profile(VASE, 8).tolist() + INSIDE, 96)
    coat = {"clearcoat": {"clearcoatFactor": 1.0, "clearcoatRoughnessFactor": 0.03}}
    paint = _painted(
        studio,
        "car paint",
        [(0.55, 0.02, 0.03), (0.03, 0.1, 0.42), (0.04, 0.22, 0.08)],
        roughness=0.45,
        metallic=0.6,
        extensions=coat,
    )
    mesh = glb.add_mesh("vase", vase, **paint)
    glb.add_node("clearcoat", mesh=mesh, translation=(LEFT, UPPER, 0))

    weave = textures.noise((128, 128), (1.2, 1.2), 5)
    bump = glb.add_picture("weave", textures.png(textures.normal_map(weave, 0.12)))
    bump["extensions"] = {"KHR_texture_transform": {"scale": [6, 3]}}
    glb.use("KHR_texture_transform")
    velvet = _painted(
        studio,
        "velvet",
        [(0.16, 0.015, 0.07), (0.01, 0.09, 0.14), (0.12, 0.07, 0.01)],
        roughness=0.9,
        normalTexture=bump,
        extensions={"sheen": {"sheenColorFactor": [0.9, 0.55, 0.7], "sheenRoughnessFactor": 0.35}},
    )
    mesh = glb.add_mesh("cushion", _cushion(), **velvet)
    glb.add_node("sheen", mesh=mesh, translation=(0, UPPER + 0.062, 0))

    brushed = {"anisotropy": {"anisotropyStrength": 0.9, "anisotropyRotation": 0.0}}
    steel = studio.matter("steel", (0.78, 0.76, 0.74), 0.22, 1.0, extensions=brushed)
    studio.put("anisotropy", shapes.lathe(POT, 96), steel, (RIGHT, UPPER, 0))


def _cushion() -> shapes.Shape:
    """A square pillow: a sphere pulled to its corners."""
    v, u = np.meshgrid(
        np.linspace(-1, 1, 49) * np.pi / 2, np.linspace(0, 2 * np.pi, 97), indexing="ij"
    )
    round_x, round_z = np.cos(v) * np.cos(u), -np.cos(v) * np.sin(u)
    power = np.maximum(np.abs(np.cos(u)), np.abs(np.sin(u))) ** -0.7
    height = np.sin(v) * (1 - 0.35 * np.cos(v) ** 4)
    grid = np.stack([0.105 * round_x * power, 0.062 * height, 0.105 * round_z * power], -1)
    return shapes.turned(shapes.surface(grid), [[0.8, 0, 0.6], [0, 1, 0], [-0.6, 0, 0.8]])


def _lower_board(studio: Studio) -> None:
    film = {"iridescenceFactor": 1.0, "iridescenceIor": 1.6}
    film |= {"iridescenceThicknessMinimum": 100.0, "iridescenceThicknessMaximum": 620.0}
    rows = np.linspace(1, 0, 64)[:, None] * np.ones((1, 8))
    ramp = studio.glb.add_picture("thickness", textures.png(np.stack([rows] * 3, -1)))
    film["iridescenceThicknessTexture"] = ramp
    beetle = studio.matter("beetle", (0.35, 0.35, 0.38), 0.2, 1.0, extensions={"iridescence": film})
    studio.put("iridescence", shapes.ball(0.11, 48, 96), beetle, (LEFT, LOWER + 0.11, 0))

    tint = {"specularFactor": 1.0, "specularColorFactor": [0.25, 1.0, 0.75]}
    jade = studio.matter(
        "jade", (0.005, 0.02, 0.018), 0.18, extensions={"specular": tint, "ior": {"ior": 2.2}}
    )
    vase = shapes.lathe(shapes.smooth_profile(VASE, 8).tolist() + INSIDE, 96)
    studio.put("specular", vase, jade, (0, LOWER, 0), scale=(1.15, 0.95, 1.15))

    gold = {"specularFactor": [1.0, 0.72, 0.32], "glossinessFactor": 0.8}
    gold |= {"diffuseFactor": [0.02, 0.012, 0.004, 1]}
    bell = studio.glb.add_material(
        "gold", doubleSided=True, extensions={"KHR_materials_pbrSpecularGlossiness": gold}
    )
    profile = shapes.smooth_profile(BELL, 8)
    studio.put("specular-glossiness", shapes.lathe(profile, 96), bell, (RIGHT, LOWER, 0))
