"""A garden path at evening: thousands of blades, leaves and poppies, lit from behind.

Uses EXT_mesh_gpu_instancing, EXT_texture_webp (leaves with an alpha mask), KHR_texture_basisu
(the mosaics), KHR_texture_transform, KHR_materials_diffuse_transmission, _emissive_strength
and EXT_camera_physical.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from daguerre.exporters.gltf import Glb
from extensions.plants import any_turn, blade, leaf, leafy, scatter, stones
from extensions.studio import Studio
from kit import ktx2, shapes, textures
from kit.pose import look

SUN_FROM = (-1.6, 1.3, -3.0)
LYING = (-math.sqrt(0.5), 0, 0, math.sqrt(0.5))  # a square that faced +z now faces +y


def make() -> Glb:
    """The scene."""
    studio = Studio()
    rng = np.random.default_rng(17)
    _sky_and_sun(studio)
    _ground(studio)
    _path(studio)
    _grass(studio, rng)
    _hedge(studio, rng)
    _poppies(studio, rng)
    studio.camera((0.1, 0.42, 2.1), (-0.02, 0.24, 0), 35, 4, (0, 0.1, 0.75))
    return studio.glb


def _sky_and_sun(studio: Studio) -> None:
    height = np.linspace(0, 1, 64)[:, None] ** 0.4 * np.ones((1, 8))
    glow = textures.ramp(height, [(0.98, 0.8, 0.6), (0.6, 0.7, 0.84), (0.4, 0.58, 0.88)])
    picture = studio.glb.add_picture("sky", textures.png(glow))
    sky = studio.shining("sky", (1, 1, 1), 0.8, emissiveTexture=picture)
    angle = np.linspace(math.pi / 2, 0, 9)  # downward, so that it faces inward
    dome = shapes.lathe(np.stack([np.cos(angle).clip(0), np.sin(angle)], 1), 24, 180)
    studio.put("sky", dome, sky, scale=(12, 12, 12))
    # A disc inside of the dome, 2.6 degrees wide; 7 lux where nothing is in its way.
    at, radius = np.multiply(SUN_FROM, 11 / np.linalg.norm(SUN_FROM)), 0.25
    glare = studio.shining("sun", (1, 0.8, 0.55), 7 * 11**2 / (math.pi * radius**2))
    turn = look((0, 0, 0), at.tolist())
    studio.put("sun", shapes.disc(radius, 16), glare, at.tolist(), rotation=turn)


def _ground(studio: Studio) -> None:
    crumbs = textures.noise((256, 256), (2, 2), 3) + 0.7 * textures.noise((256, 256), (9, 9), 4)
    soil = textures.ramp(
        np.clip(0.5 + 0.2 * crumbs, 0, 1), [(0.16, 0.11, 0.07), (0.33, 0.25, 0.16)]
    )
    picture = studio.glb.add_picture("soil", textures.jpeg(soil))
    repeat = {"KHR_texture_transform": {"scale": [30, 30], "rotation": 0.4}}
    studio.glb.use("KHR_texture_transform")
    matter = studio.matter(
        "soil", (1, 1, 1), 0.95, pbr={"baseColorTexture": {**picture, "extensions": repeat}}
    )
    studio.put("ground", shapes.square(24, 24), matter, rotation=LYING)


def _path(studio: Studio) -> None:
    for k in range(7):
        picture = studio.glb.add_picture(f"mosaic{k}", ktx2.mosaic(stones(k)))
        matter = studio.matter("mosaic", (1, 1, 1), 0.3, pbr={"baseColorTexture": picture})
        outline = [
            (0.21 * math.cos(a), -0.21 * math.sin(a)) for a in np.linspace(0, 6.2832, 25)[:-1]
        ]
        z = 1.35 - 0.5 * k
        studio.put("slab", shapes.slab(outline, 0.03), matter, (path_x(z), 0, z))


def path_x(z: ArrayLike) -> Any:
    """Where the path is at a depth."""
    return 0.1 * np.sin(1.7 * np.asarray(z) + 0.4)


def _grass(studio: Studio, rng: np.random.Generator) -> None:
    for k, color in enumerate([(0.09, 0.2, 0.03), (0.14, 0.24, 0.04), (0.2, 0.24, 0.06)]):
        matter = leafy(studio, "grass", color, (0.55, 0.8, 0.15))
        mesh = studio.glb.add_mesh("blade", blade(0.11, 0.007), matter)
        count = 9000
        z = 2.2 - 6.9 * rng.random(count) ** 1.5
        x = rng.uniform(-1, 1, count) * (0.5 + 0.6 * (2.4 - z))
        away = np.abs(x - path_x(z))
        keep = away > 0.2 + 0.05 * rng.random(count)
        places = np.stack([x, 0 * x, z], 1)[keep]
        sizes = (rng.uniform(0.45, 1.3, count) * np.clip(away / 0.4, 0.4, 1))[keep]
        scatter(studio, f"grass{k}", mesh, places, any_turn(rng, len(places), 0.25), sizes)


def _hedge(studio: Studio, rng: np.random.Generator) -> None:
    picture = studio.glb.add_picture("leaf", textures.webp(leaf(), 95))
    matter = leafy(
        studio,
        "leaf",
        (1, 1, 1),
        (0.5, 0.75, 0.15),
        pbr={"baseColorTexture": picture},
        alphaMode="MASK",
    )
    mesh = studio.glb.add_mesh("leaf", shapes.square(0.05, 0.1), matter)
    count = 5200
    side, along = rng.choice([-1.0, 1.0], count), rng.uniform(-3.4, 1.1, count)
    depth = rng.random(count) ** 0.5  # most leaves are near the outside of a bush
    angle, bump = rng.uniform(0, 2 * math.pi, count), 0.85 + 0.2 * np.sin(5 * along + side)
    x = side * (0.98 - 0.06 * along) + 0.34 * depth * bump * np.cos(angle)
    y = 0.3 + 0.34 * depth * bump * np.sin(angle)
    far = along < -2.5  # a row across the end of the path
    x = np.where(far, np.linspace(-2.4, 2.4, count), x)
    along = np.where(far, -4.2 + 0.3 * depth * np.cos(angle), along)
    places = np.stack([x, np.maximum(y, 0.01), along], 1)
    scatter(studio, "hedge", mesh, places, any_turn(rng, count, 0.7), rng.uniform(0.7, 1.3, count))


def _poppies(studio: Studio, rng: np.random.Generator) -> None:
    red = leafy(studio, "petal", (0.6, 0.03, 0.02), (1.0, 0.12, 0.04))
    stalk = leafy(studio, "stalk", (0.1, 0.2, 0.05), (0.4, 0.6, 0.1))
    heart = studio.matter("heart", (0.02, 0.02, 0.03), 0.6)
    cup = [(0.004, 0), (0.02, 0.006), (0.034, 0.02), (0.038, 0.036)]
    wave = shapes.lathe(shapes.smooth_profile(cup, 4), 32, 180)
    angle = np.arctan2(wave.positions[:, 2], wave.positions[:, 0])
    wave.positions[:, 1] *= 1 + 0.25 * np.cos(4 * angle)
    stem = shapes.tube([(0, -0.3, 0), (0.01, -0.15, 0), (0, 0, 0)], 0.0018, 6)
    count = 70
    z = rng.uniform(-2.2, 1.5, count)
    x = path_x(z) + rng.choice([-1, 1], count) * rng.uniform(0.3, 0.72, count)
    places = np.stack([x, rng.uniform(0.16, 0.3, count), z], 1)
    turns, sizes = any_turn(rng, count, 0.3), rng.uniform(0.7, 1.25, count)
    for name, shape, matter in [
        ("petals", wave, red),
        ("stems", stem, stalk),
        ("hearts", shapes.moved(shapes.ico_ball(0.009, 1), (0, 0.012, 0)), heart),
    ]:
        scatter(studio, name, studio.glb.add_mesh(name, shape, matter), places, turns, sizes)
