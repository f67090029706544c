"""An octopus that moves: eight arms on a skin, a breathing head, colours that change, a blink.

Uses skins, morph targets, KHR_animation_pointer, KHR_node_visibility, KHR_materials_clearcoat,
_emissive_strength and EXT_camera_physical. Everything repeats after 4 s: see --time.
"""

from __future__ import annotations

import math

import numpy as np

from daguerre.exporters.gltf import FLOAT, Glb, Track
from extensions.arms import add_arms
from extensions.studio import Studio
from kit import shapes, textures

PERIOD_S = 4.0


def make() -> Glb:
    """The scene."""
    studio = Studio()
    _sea(studio)
    skin, tracks = _skin_matter(studio)
    tracks += add_arms(studio, skin, PERIOD_S)
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
