"""Small scenes that other renderers can draw, each with what its name says."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

import daguerre as dg

SIZE = (96, 64)
GREY = (0.5, 0.5, 0.5)


def placed(x: float = 0, y: float = 0, z: float = 0, scale: Any = 1.0) -> np.ndarray:
    """Moves by metres after a scale, one number or three."""
    made = np.eye(4)
    made[:3, :3] = np.diag(np.broadcast_to(np.asarray(scale, float), 3))
    made[:3, 3] = x, y, z
    return made


def turned(matrix: np.ndarray, axis: str, degrees: float) -> np.ndarray:
    """Turns about an axis through the origin, before a matrix."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    turn = np.eye(4)
    i, j = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    turn[i, i] = turn[j, j] = c
    turn[i, j], turn[j, i] = -s, s
    return matrix @ turn


def card(scene: dg.Scene, tiles: float = 1.0, offset: float = 0.0) -> int:
    """A square of 2 m in z = 0 that faces +z; its texture coordinates go from offset to + tiles."""
    corners = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]
    uv = np.array([(0, 1), (1, 1), (1, 0), (0, 0)]) * tiles + offset
    return scene.add_mesh(corners, [(0, 1, 2), (0, 2, 3)], uv=uv, name="card")


def ball(scene: dg.Scene, rows: int = 48) -> int:
    """A sphere of 1 m radius with smooth normals; u runs around +y, v down."""
    v, u = np.meshgrid(np.linspace(0, 1, rows + 1), np.linspace(0, 1, 2 * rows + 1), indexing="ij")
    theta, phi = math.pi * v, 2 * math.pi * u
    points = np.stack(
        [np.sin(theta) * np.sin(phi), np.cos(theta), np.sin(theta) * np.cos(phi)], axis=-1
    )
    index = np.arange(v.size).reshape(v.shape)
    a, b, c, d = index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]
    upper = np.stack([a, b, c], -1)[1:].reshape(-1, 3)  # the first row meets at the pole
    lower = np.stack([a, c, d], -1)[:-1].reshape(-1, 3)
    top = np.stack([a, b, c], -1)[:1].reshape(-1, 3)
    triangles = np.concatenate([top, upper, lower])
    flat = points.reshape(-1, 3)
    return scene.add_mesh(flat, triangles, flat, np.stack([u, v], -1).reshape(-1, 2), name="ball")


def letter(scene: dg.Scene) -> int:
    """A letter F of 5 squares that faces +z, which no turn takes to its mirror image."""
    cells = [(0, 0), (0, 1), (0, 2), (1, 2), (1, 1), (0, 3), (1, 3), (2, 3)]
    points, triangles = [], []
    for x, y in cells:
        first = len(points)
        points += [(x, y, 0), (x + 1, y, 0), (x + 1, y + 1, 0), (x, y + 1, 0)]
        triangles += [(first, first + 1, first + 2), (first, first + 2, first + 3)]
    return scene.add_mesh(np.array(points) * 0.4, triangles, name="letter")


def camera(**more: Any) -> dg.Camera:
    """A pinhole 5 m before the origin, 30 degrees wide."""
    given: dict[str, Any] = {
        "transform": dg.look_at((0, 0.6, 5), (0, 0, 0)), "lens": "pinhole", "focal_length": 65.0,
    }  # fmt: skip
    return dg.Camera(**(given | more))


def room(size: float = 0.3) -> dg.Scene:
    """A box that is open in front, with a lamp below its ceiling, of ``size`` times its width."""
    scene = dg.Scene()
    square = card(scene)
    grey = scene.add_material(dg.Diffuse((0.6, 0.6, 0.6)))
    sides = {"red": (0.6, 0.4, 0.35), "green": (0.4, 0.5, 0.4)}  # spectra are not RGB
    red, green = (scene.add_material(dg.Diffuse(color)) for color in sides.values())
    scene.add_instance(square, grey, placed(z=-1))
    scene.add_instance(square, grey, turned(placed(y=-1), "x", -90))
    scene.add_instance(square, grey, turned(placed(y=1), "x", 90))
    scene.add_instance(square, red, turned(placed(x=-1), "y", 90))
    scene.add_instance(square, green, turned(placed(x=1), "y", -90))
    lamp = scene.add_material(dg.Material(dg.Diffuse((0, 0, 0)), emission=(20, 18, 15)))
    scene.add_instance(square, lamp, turned(placed(y=0.98, scale=size), "x", 90))
    scene.add_camera("main", camera())
    return scene


def box() -> dg.Scene:
    """Diffuse box with an area light, and a ball in it."""
    scene = room()
    scene.add_instance(ball(scene), dg.Diffuse(GREY), placed(0.2, -0.55, -0.1, 0.45))
    return scene


def checks(rows: int = 8, columns: int = 8) -> np.ndarray:
    """An uneven pattern of colours, 8 bits."""
    rng = np.random.default_rng(3)
    made = rng.integers(40, 230, (rows, columns, 3))
    made[: rows // 4, : columns // 2] = 250, 20, 20
    return made.astype(np.uint8)


def textures() -> dg.Scene:
    """Cards with textures beyond their edges, in all ways, sharp and smooth, turned and scaled."""
    scene = dg.Scene()
    square = card(scene, 3.0, -1.0)
    ways = [
        ("repeat", "repeat"), ("mirror", "mirror"), ("clamp", "clamp"), ("mirror", "repeat"),
        ("repeat", "mirror"), ("repeat", "repeat"),
    ]  # fmt: skip
    for i, wrap in enumerate(ways):
        texture = scene.add_texture(
            checks(), srgb=i % 2 == 0, wrap=wrap, filter="nearest" if i == 1 else "linear",
            min_filter="linear",
        )  # fmt: skip
        transform = (0.5, 0.3, 0.1, -0.2, 0.7, 0.2) if i == 5 else (1, 0, 0, 0, 1, 0)
        slot = dg.TextureSlot(texture, transform=transform)
        factor = (0.5, 1.0, 1.0) if i == 2 else (1.0, 1.0, 1.0)
        unlit = dg.Gltf(base_color=factor, base_color_texture=slot, unlit=True)
        lit = dg.Gltf(base_color=factor, base_color_texture=slot, metallic=0.0)
        scene.add_instance(
            square, unlit if i % 3 == 0 else lit, placed(i % 3 - 1, 0.5 - i // 3, 0, 0.45)
        )
    scene.set_environment(color=(1, 1, 1))
    scene.add_camera("main", camera(transform=dg.look_at((0, 0, 5), (0, 0, 0))))
    return scene


def glass() -> dg.Scene:
    """Balls of smooth and of rough glass before coloured walls, and one that absorbs."""
    scene = room(0.9)
    smooth, rough = dg.Dielectric(1.5), dg.Dielectric(1.5, alpha=0.3)
    absorbing = dg.Gltf(
        metallic=0.0, roughness=0.0, transmission=1.0, thickness=0.5,
        attenuation_distance=0.4, attenuation_color=(0.8, 0.6, 0.55),
    )  # fmt: skip
    round_ = ball(scene)
    scene.add_instance(round_, smooth, placed(-0.5, -0.6, 0.2, 0.35))
    scene.add_instance(round_, rough, placed(0.45, -0.6, 0.2, 0.35))
    scene.add_instance(round_, absorbing, placed(0.0, 0.2, -0.3, 0.35))
    scene.set_environment(color=(0.5, 0.5, 0.6))
    return scene


def metals() -> dg.Scene:
    """Metals: a mirror, rough ones, one of glTF, and a glossy dielectric of glTF."""
    scene = room(0.9)
    round_ = ball(scene)
    kinds = [
        dg.Conductor((0.9, 0.9, 0.9), alpha=0.0),
        dg.Conductor((0.9, 0.6, 0.3), alpha=0.25),
        dg.Gltf(base_color=(0.9, 0.7, 0.4), metallic=1.0, roughness=0.5),
        dg.Gltf(base_color=(0.3, 0.5, 0.7), metallic=0.0, roughness=0.5),
        dg.Gltf(base_color=(0.6, 0.3, 0.2), metallic=0.5, roughness=0.6),
        dg.Gltf(base_color=(0.7, 0.7, 0.2), metallic=0.0, roughness=0.0),
    ]
    for i, kind in enumerate(kinds):
        scene.add_instance(round_, kind, placed(0.6 * (i % 3 - 1), -0.6 + 0.7 * (i // 3), 0, 0.28))
    return scene


def sky() -> dg.Scene:
    """Balls below an environment map that is turned: a mirror, a diffuse and a rough one."""
    scene = dg.Scene()
    rows, columns = np.mgrid[0:64, 0:128]
    image = np.stack(
        [
            1 + np.cos(2 * np.pi * columns / 128),
            1 + np.sin(2 * np.pi * columns / 128 + 0.5),
            2 * rows / 64,
        ],
        axis=-1,
    )
    image[8:20, 20:40] += 6
    round_ = ball(scene)
    kinds = [dg.Conductor((0.9, 0.9, 0.9), 0.0), dg.Diffuse((0.7, 0.6, 0.5)),
             dg.Conductor((1, 0.9, 0.7), 0.4)]  # fmt: skip
    for i, kind in enumerate(kinds):
        scene.add_instance(round_, kind, placed(0.95 * (i - 1), 0, 0, 0.45))
    scene.set_environment(image.astype(np.float32), scale=0.7, rotation=55)
    scene.add_camera("main", camera())
    return scene


def mirrored() -> dg.Scene:
    """Letters as instances, some mirrored, one of which shines from its front; a lit floor."""
    scene = dg.Scene()
    square, sign = card(scene), letter(scene)
    scene.add_instance(square, dg.Diffuse((0.6, 0.6, 0.6)), turned(placed(y=-1, scale=3), "x", -90))
    blue = scene.add_material(dg.Diffuse((0.2, 0.3, 0.7)))
    for place in (
        placed(-1.6, -0.9, 0),
        turned(placed(-0.3, -0.9, -0.5, (-1, 1, 1)), "y", 20),
        placed(1.2, -0.9, 0, (0.8, 1.2, -1)),
    ):
        scene.add_instance(sign, blue, place)
    lamp = scene.add_material(dg.Material(dg.Diffuse((0, 0, 0)), emission=(6, 5, 2)))
    scene.add_instance(sign, lamp, placed(0.5, 0.4, 0.3, (-0.5, 0.5, 0.5)))
    scene.add_instance(sign, lamp, placed(-0.5, 0.4, 0.3, (-0.5, 0.5, -0.5)))
    ring = ball(scene, 24)
    scene.add_instance(ring, dg.Diffuse((0.7, 0.2, 0.2)), placed(1.5, 0.5, -0.5, (-0.4, 0.3, 0.4)))
    scene.set_environment(color=(0.3, 0.3, 0.35))
    scene.add_camera("main", camera(focal_length=45.0))
    return scene


def depth() -> dg.Scene:
    """Bright cards at three distances through a thin lens that is wide open, shifted."""
    scene = dg.Scene()
    square = card(scene)
    for i, (x, z) in enumerate([(-1, 1.5), (0, 0), (1.2, -3)]):
        texture = scene.add_texture(checks(4, 4), srgb=True, filter="nearest", min_filter="nearest")
        bright = dg.Gltf(base_color_texture=dg.TextureSlot(texture), unlit=True)
        scene.add_instance(square, bright, placed(x, 0.1 * i, z, 0.55))
    scene.set_environment(color=(0.2, 0.2, 0.2))
    lens = {"lens": "thin", "focal_length": 85.0, "f_stop": 0.6, "focus_distance": 5.0}
    scene.add_camera("main", camera(shift=(3.0, -2.0), **lens))
    return scene


def lamps() -> dg.Scene:
    """A floor and a ball under a point, two spots, a directional light and a shining ball."""
    scene = dg.Scene()
    square = card(scene)
    grey = scene.add_material(dg.Diffuse((0.7, 0.7, 0.7)))
    scene.add_instance(square, grey, turned(placed(y=-1, scale=4), "x", -90))
    scene.add_instance(ball(scene), grey, placed(0.2, -0.6, 0, 0.4))
    down = turned(np.eye(4), "x", -90)
    at = placed(-1.2, 1.0, 0) @ down
    scene.add_light(dg.SpotLight((8, 6, 4), inner_angle=5, outer_angle=35), at)
    scene.add_light(dg.SpotLight((4, 6, 8), inner_angle=20, outer_angle=60),
                    turned(placed(1.4, 0.5, 0) @ down, "x", 20))  # fmt: skip
    scene.add_light(dg.PointLight((2, 2, 1)), placed(0, 0.4, 1.2))
    scene.add_light(dg.SphereLight((30, 30, 40), 0.1), placed(0.9, -0.3, 0.8))
    scene.add_light(
        dg.DirectionalLight((0.5, 0.5, 0.7)), turned(turned(np.eye(4), "y", 30), "x", -50)
    )
    scene.add_camera("main", camera())
    return scene


def layered() -> dg.Scene:
    """glTF: alpha masks and blends, roughness by a texture, a normal map, a sheet, emission."""
    scene = room(0.9)
    scene.set_environment(color=(2, 2, 2))
    square, round_ = card(scene), ball(scene)
    rng = np.random.default_rng(5)
    colors = scene.add_texture(
        np.concatenate([checks(), rng.integers(0, 2, (8, 8, 1)) * 255], -1).astype(np.uint8),
        srgb=True, filter="nearest", min_filter="nearest",
    )  # fmt: skip
    slot = dg.TextureSlot(colors)
    rough = scene.add_texture(
        np.stack([0 * rng.random((4, 4)), 0.4 + 0.5 * rng.random((4, 4)), rng.random((4, 4))], -1)
    )
    waves = np.sin(np.linspace(0, 6 * np.pi, 64))[None, :] * np.ones((64, 1)) * 0.1
    normals = np.stack([waves, 0.1 * np.ones_like(waves), np.sqrt(1 - waves**2 - 0.01)], -1)
    bumps = scene.add_texture((normals / 2 + 0.5).astype(np.float32), min_filter="linear")
    kinds = [
        dg.Gltf(base_color_texture=slot, alpha_mode="mask", metallic=0.0),
        dg.Gltf(base_color=(0.8, 0.2, 0.2), base_alpha=0.4, alpha_mode="blend", metallic=0.0),
        dg.Gltf(metallic=0.0, normal_texture=dg.TextureSlot(bumps), roughness=0.9),
        dg.Gltf(metallic=0.0, roughness=0.0, transmission=1.0, base_color=(0.7, 0.9, 0.7)),
        dg.Gltf(base_color=(0, 0, 0), metallic=0, emissive=(1, 1, 1), double_sided=True,
                emissive_texture=slot),
    ]  # fmt: skip
    for i, kind in enumerate(kinds):
        scene.add_instance(
            square, kind, placed(0.65 * (i % 3 - 1), 0.3 - 0.65 * (i // 3), 0.2, 0.28)
        )
    textured = dg.Gltf(metallic_roughness_texture=dg.TextureSlot(rough), base_color=(0.8, 0.7, 0.5))
    scene.add_instance(round_, textured, placed(0.65, -0.4, 0.2, 0.28))
    return scene


def coats() -> dg.Scene:
    """Coats on bases: smooth and rough, with and without saturation, and a lamp with a profile."""
    scene = room(0.9)
    round_ = ball(scene)
    for i, (alpha, nonlinear) in enumerate([(0.0, True), (0.1, True), (0.3, True), (0.1, False)]):
        base = dg.Diffuse((0.7, 0.5, 0.3))
        kind = dg.Coated(base, ior=1.5, alpha=alpha, nonlinear=nonlinear)
        scene.add_instance(round_, kind, placed(-0.75 + 0.5 * i, -0.7, 0, 0.24))
    theta, phi = np.linspace(0, 50, 11), np.arange(0, 360, 30)
    around = 1 + 0.8 * np.cos(np.radians(phi - 40))
    profile = dg.LightProfile.table(theta, np.linspace(1, 0, 11)[:, None] * around, phi)
    lamp = dg.PointLight((12.0, 10.0, 8.0), profile=profile)
    scene.add_light(lamp, dg.look_at((0.2, 0.3, 1.5), (0, -0.2, -1)))
    return scene
