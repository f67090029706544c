"""Small worlds that move, from arrays; each fills the frame with what blur changes.

Most things glow with a coarse pattern of colours, so that every pixel tells where they are and the
light on them adds no noise.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

import daguerre as dg
from daguerre.scene.materials import Gltf, TextureSlot
from tests.support.pictures.blur import Case, case
from tests.support.scene import scenes

Matrix = NDArray[np.float64]
OPEN = 0.4  # s
TIME = 1.0  # of the frames, s


def move(x: float = 0, y: float = 0, z: float = 0) -> Matrix:
    """A translation."""
    return scenes.at(x, y, z)


def turn(degrees: float, axis: tuple[float, float, float] = (0, 0, 1)) -> Matrix:
    """A rotation about an axis through the origin (Rodrigues)."""
    a = np.asarray(axis, float) / np.linalg.norm(axis)
    k = np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])
    angle = math.radians(degrees)
    out = np.eye(4)
    out[:3, :3] += math.sin(angle) * k + (1 - math.cos(angle)) * k @ k
    return out


def pinhole(**values: Any) -> dg.Camera:
    """35 mm on a full frame: 36 x 24 at 35."""
    return dg.Camera(**({"lens": "pinhole", "focal_length": 35.0} | values))


def sky(scale: Any = 1.0, rotation: Any = 0.0, time: float = TIME) -> dg.Scene:
    """A coloured sky, brighter above, and nothing else."""
    rows = np.linspace(1.5, 0.2, 8)[:, None, None]
    hues = 0.4 + 0.4 * np.cos(np.arange(16)[None, :, None] * math.pi / 8 + np.array([0, 2, 4]))
    scene = dg.Scene(time=time)
    scene.set_environment((rows * hues).astype(np.float32), scale=scale, rotation=rotation)
    return scene


def dark() -> dg.Scene:
    """Nothing at all."""
    return dg.Scene(time=TIME)


def pattern(seed: int = 0, size: int = 4) -> NDArray[np.float32]:
    """Random colours, hard edges."""
    return np.random.default_rng(seed).uniform(0.05, 1, (size, size, 3)).astype(np.float32)


def glowing(scene: dg.Scene, seed: int = 0) -> int:
    """A material that shines with a pattern, to both sides."""
    texture = scene.add_texture(pattern(seed), filter="nearest", min_filter="nearest")
    return scene.add_material(Gltf(base_color_texture=TextureSlot(texture), unlit=True))


def card_mesh(scene: dg.Scene, size: float = 0.5) -> int:
    """A square with texture coordinates, facing +z."""
    points, faces = scenes.quad(size)
    uv = [(0, 1), (1, 1), (1, 0), (0, 0)]
    return scene.add_mesh(points, faces, uv=uv)


def card(scene: dg.Scene, transform: Any, *, size: float = 0.5, **values: Any) -> int:
    """A square that glows with a pattern."""
    return scene.add_instance(card_mesh(scene, size), glowing(scene), transform, **values)


def ball(scene: dg.Scene, material: Any, transform: Any, radius: float = 0.5, **values: Any) -> int:
    """A sphere of triangles with normals."""
    points, faces, normals = scenes.sphere(12, radius)
    return scene.add_instance(scene.add_mesh(points, faces, normals), material, transform, **values)


def floor(scene: dg.Scene, material: Any = None, y: float = -0.8, size: float = 4) -> int:
    """A grey square below, seen from above."""
    points, faces = scenes.quad(size)
    flat = move(0, y, -3) @ turn(-90, (1, 0, 0))
    kind = dg.Diffuse((0.7, 0.7, 0.7)) if material is None else material
    return scene.add_instance(scene.add_mesh(points, faces), kind, flat)


def across(*matrices: Matrix, **how: Any) -> dg.Keys:
    """Keys at uneven times, the first before the shutter opens and the last after it closes."""
    times = {2: (0.75, 1.25), 3: (0.75, 0.9, 1.25)}[len(matrices)]
    return dg.keys(list(zip(times, matrices, strict=True)), **how)


# Objects ---------------------------------------------------------------------------------------


def translation() -> Case:
    """There and back, not at one speed, and nearer."""
    scene = sky()
    card(scene, across(move(-0.8, 0, -3), move(0.9, 0.3, -3), move(0.2, -0.5, -2)))
    return case(scene, pinhole(), OPEN)


def half_turn() -> Case:
    """170 degrees about a slanted axis, on a way across the frame."""
    scene = sky()
    path = across(move(-0.7, 0, -3), move(0.7, 0.2, -3) @ turn(170, (0.2, 0.3, 1)))
    card(scene, path)
    return case(scene, pinhole(), OPEN)


def turns_by(interpolation: str) -> Callable[[], Case]:
    """100 degrees, by one of the interpolations."""

    def make() -> Case:
        scene = sky()
        end = move(0.6, 0, -2.5) @ turn(100, (1, 0.5, 2))
        card(scene, across(move(-0.6, 0, -3), end, interpolation=interpolation), size=0.6)
        return case(scene, pinhole(), OPEN)

    return make


def mirrored() -> Case:
    """Left and right handed matrices, turned about a pivot."""
    scene = sky()
    flip = np.diag([-1.0, 1, 1, 1])
    path = across(move(0, 0, -3) @ flip, move(0.3, 0, -3) @ turn(80) @ flip, pivot=(0.5, 0, 0))
    card(scene, path)
    return case(scene, pinhole(), OPEN)


def sheared() -> Case:
    """Shear, stretch and turn at once."""
    scene = sky()
    shear = np.eye(4)
    shear[0, 1], shear[1, 1] = 0.8, 1.5
    card(scene, across(move(-0.4, 0, -3) @ shear, move(0.4, 0, -3) @ turn(70) @ shear.T))
    return case(scene, pinhole(), OPEN)


def propeller() -> Case:
    """Almost three turns on a way that is keyed itself."""
    scene = sky()
    way = across(move(-0.5, 0, -3), move(0.5, 0, -3) @ turn(30, (1, 0, 0)))
    points, faces = scenes.quad(0.6)
    blade = scene.add_mesh(points * (1, 0.2, 1), faces, uv=[(0, 1), (1, 1), (1, 0), (0, 0)])
    scene.add_instance(blade, glowing(scene), dg.spin((0, 0, 1), 7.3, (0.3, 0, 0), way))
    return case(scene, pinhole(), OPEN)


def reflections() -> Case:
    """A mirror, glass and frosted metal that move between lamps and walls that do not."""
    scene = sky()
    card(scene, move(0, 0.6, -4), size=1.5)
    floor(scene, dg.Conductor((0.9, 0.9, 0.9), 0.0))
    ball(scene, dg.Dielectric(), across(move(-0.9, 0, -2.6), move(-0.1, 0.1, -2.6)), 0.4)
    ball(scene, dg.Conductor((0.9, 0.6, 0.3), 0.3), across(move(0.9, 0, -3), move(0.3, 0, -2)), 0.4)
    return case(scene, pinhole(), OPEN, max_depth=8)


def shadow() -> Case:
    """A still floor on which a shadow runs, of a card with holes."""
    scene = dark()
    floor(scene)
    holes = np.ones((4, 4, 4), np.float32)
    holes[1::2, ::2, 3] = 0
    image = scene.add_texture(holes, filter="nearest", min_filter="nearest")
    cut = Gltf(base_color_texture=TextureSlot(image), alpha_mode="mask", metallic=0.0)
    path = across(move(-0.9, 0.2, -2.6), move(0.7, 0.3, -3) @ turn(60, (1, 0, 0)))
    scene.add_instance(card_mesh(scene, 0.4), scene.add_material(cut), path)
    scene.add_light(dg.PointLight((20, 20, 20)), move(0, 2, -2))
    scene.add_light(dg.DirectionalLight((2, 1, 1)), turn(-60, (1, 0.3, 0)))
    return case(scene, pinhole(), OPEN)


def appearing() -> Case:
    """There for 30 % of the exposure; a glowing one lights the floor as well."""
    scene = dark()
    there = dg.keys([(0.0, False), (0.9, True), (1.02, False)])
    floor(scene)
    lamp = dg.Material(dg.Diffuse((0, 0, 0)), emission=(4, 3, 2), two_sided_emission=True)
    points, faces = scenes.quad(0.4)
    tilted = move(-0.4, 0.1, -2.5) @ turn(40, (1, 0, 0))
    scene.add_instance(scene.add_mesh(points, faces), lamp, tilted, shown=there)
    card(scene, move(0.6, 0, -3), size=0.4, shown=there)
    return case(scene, pinhole(), OPEN)


# Vertices --------------------------------------------------------------------------------------


def _waves(t: float, n: int = 8) -> NDArray[np.float32]:
    """A sheet whose waves run; shape ((n + 1)^2, 3)."""
    u, v = np.meshgrid(np.linspace(-1, 1, n + 1), np.linspace(-1, 1, n + 1))
    height = 0.3 * np.sin(3 * u + 25 * (t - TIME))
    return np.stack([u + 0.4 * height, v * (1 + 0.5 * height), height], -1).reshape(-1, 3)


def _sheet(n: int = 8) -> NDArray[np.int64]:
    a = (np.arange(n)[:, None] * (n + 1) + np.arange(n)[None, :]).ravel()
    return np.concatenate(
        [np.stack([a, a + 1, a + n + 2], 1), np.stack([a, a + n + 2, a + n + 1], 1)]
    )


def _cached(scene: dg.Scene) -> int:
    """The waves as a point cache of many steps, smooth."""
    u, v = np.meshgrid(np.linspace(0, 1, 9), np.linspace(1, 0, 9))
    times = np.linspace(0.7, 1.3, 13)
    normals = np.tile((0.0, 0.0, 1.0), (81, 1))
    uv = np.stack([u, v], -1).reshape(-1, 2)
    frames = np.stack([_waves(t) for t in times])
    return scene.add_mesh(_waves(TIME), _sheet(), normals, uv, steps=(times, frames))


def cloth() -> Case:
    """A point cache on an instance that moves too, lit and glowing."""
    scene = sky()
    mesh = _cached(scene)
    scene.add_instance(mesh, glowing(scene), move(-0.7, 0, -3.5) @ turn(20, (0, 1, 0)))
    lit = dg.Diffuse((0.8, 0.8, 0.8))
    scene.add_instance(
        mesh, lit, across(move(0.6, 0, -3), move(1.0, 0.3, -3) @ turn(40, (1, 0, 0)))
    )
    return case(scene, pinhole(), OPEN)


def glowing_cloth() -> Case:
    """A lamp that changes its shape lights a floor."""
    scene = dark()
    floor(scene)
    lamp = dg.Material(dg.Diffuse((0, 0, 0)), emission=(3, 4, 5), two_sided_emission=True)
    scene.add_instance(_cached(scene), lamp, move(0, 0.6, -3.5) @ turn(50, (1, 0, 0)))
    return case(scene, pinhole(), OPEN)


def crowd() -> Case:
    """One mesh, many ways: still, moving, spinning, mirrored, hidden for a while, with shadows."""
    scene = sky()
    floor(scene)
    points, faces, normals = scenes.sphere(6, 0.2)
    mesh = scene.add_mesh(points, faces, normals)
    blink = dg.keys([(0.0, True), (0.95, False), (1.1, True)])
    squashed = move(0.9, -0.4, -3) @ np.diag([-1.0, 0.4, 1, 1])
    ways: list[tuple[Any, Any]] = [
        (move(-0.9, -0.4, -3), True),
        (across(move(-0.6, -0.5, -2.5), move(-0.4, 0.2, -2.5)), True),
        (dg.spin((0, 1, 0), 4.7, (0.3, 0, 0), move(0, -0.4, -2.8)), True),
        (across(squashed, squashed @ turn(120)), True),
        (move(0.4, -0.5, -2.2), blink),
    ]
    for way, shown in ways:
        scene.add_instance(mesh, dg.Diffuse((0.8, 0.6, 0.4)), way, shown=shown)
    scene.add_light(dg.DirectionalLight((2, 2, 1)), turn(-60, (1, 0.3, 0)))
    return case(scene, pinhole(), OPEN)


def smoked_glass() -> Case:
    """A body that colours light runs before a bright wall, and its paint thins."""
    scene = sky()
    card(scene, move(0, 0, -4), size=2.0)
    body = Gltf(
        transmission=1.0,
        roughness=0.0,
        metallic=0.0,
        thickness=1.0,
        attenuation_color=(0.2, 0.5, 0.9),
        attenuation_distance=dg.keys([(0.75, 0.2), (1.25, 2.0)]),
    )
    ball(scene, body, across(move(-0.9, 0, -3), move(0.7, 0.2, -2.5)), 0.5)
    return case(scene, pinhole(), OPEN, max_depth=8)


def thin_air() -> Case:
    """A pane that is there by chance, less and less, and a cut-out whose edge eats into it."""
    scene = sky()
    points, faces = scenes.quad(0.5)
    fades = Gltf(
        base_color=(0.9, 0.2, 0.1),
        base_alpha=dg.keys([(0.75, 1.0), (1.25, 0.1)]),
        alpha_mode="blend",
        metallic=0.0,
    )
    scene.add_instance(
        scene.add_mesh(points, faces), fades, across(move(-0.8, 0, -3), move(-0.2, 0, -3))
    )
    ramp = np.ones((1, 32, 4), np.float32)
    ramp[..., 3] = np.linspace(0, 1, 32)
    image = scene.add_texture(ramp)
    eaten = Gltf(
        base_color_texture=TextureSlot(image),
        alpha_mode="mask",
        alpha_cutoff=dg.keys([(0.75, 0.1), (1.25, 0.9)]),
        metallic=0.0,
    )
    scene.add_instance(card_mesh(scene, 0.4), eaten, move(0.8, 0.2, -3) @ turn(20))
    floor(scene)
    scene.add_light(dg.PointLight((10, 10, 10)), move(0, 1.5, -2))
    return case(scene, pinhole(), OPEN)


# Cameras ---------------------------------------------------------------------------------------


def _seen(camera: dg.Camera, exposure: Callable[[dg.Camera], float] = lambda camera: 1.0) -> Case:
    """Three still cards, near and far.

    ``exposure`` is what a camera lets through: still frames are in units of their own lens, the
    blurred one in those of mid-shutter.
    """
    scene = sky()
    for z, x, y in ((-2, -0.4, 0.2), (-3, 0.5, -0.3), (-5, 0.2, 0.8)):
        card(scene, move(x, y, z), size=0.12 * -z)
    middle = exposure(camera.frozen_at(TIME))
    return case(scene, camera, OPEN, lambda t: exposure(camera.frozen_at(t)) / middle)


def pan() -> Case:
    """A pan of 25 degrees."""
    return _seen(pinhole(transform=across(turn(-10, (0, 1, 0)), turn(15, (0, 1, 0.2)))))


def dolly() -> Case:
    """Forward, aside and a roll."""
    return _seen(pinhole(transform=across(move(), move(0.2, 0, -0.8) @ turn(25))))


def zoom() -> Case:
    """24 to 60 mm: a burst."""
    return _seen(pinhole(focal_length=dg.keys([(0.75, 24.0), (1.1, 50.0), (1.25, 60.0)])))


def zoom_thin() -> Case:
    """The same, with an iris of fixed size."""
    camera = pinhole(
        lens="thin",
        focal_length=dg.keys([(0.75, 24.0), (1.25, 60.0)]),
        aperture_diameter=20.0,
        focus_distance=3.0,
    )
    return _seen(camera, lambda now: 1 / (now.focal_length or 0.0) ** 2)


def sensor_shift() -> Case:
    """The film moves."""
    return _seen(pinhole(shift=dg.keys([(0.75, (-6.0, 0.0)), (1.25, (4.0, 5.0))])))


def focus_pull() -> Case:
    """From near to far through a wide thin lens."""
    pull = dg.keys([(0.75, 1.2), (1.1, 2.0), (1.25, 9.0)])
    return _seen(pinhole(lens="thin", focal_length=35.0, f_stop=0.1, focus_distance=pull))


def iris_closing() -> Case:
    """A triangle that turns and closes, ten times as wide as any real one."""
    camera = pinhole(
        lens="thin",
        focal_length=35.0,
        f_stop=dg.keys([(0.75, 0.06), (1.25, 0.5)]),
        blades=3,
        blade_rotation=dg.keys([(0.75, 0.0), (1.25, 90.0)]),
        focus_distance=1.2,
    )
    return _seen(camera, lambda now: 1 / (now.f_stop or 0.0) ** 2)


def _calibrated(focal: float, at: tuple[float, float], k: tuple[float, ...]) -> dg.Projection:
    return dg.Projection("opencv", (24, 16), (focal, 1.05 * focal), at, k)


def zoom_calibrated() -> Case:
    """A calibration all of whose numbers change, and keys that have not as many of them."""
    track = dg.keys(
        [
            (0.75, _calibrated(16.0, (11.0, 8.0), (-0.1, 0.02))),
            (1.1, _calibrated(28.0, (12.5, 7.0), (-0.25, 0.1, 0.01, -0.01))),
            (1.25, _calibrated(34.0, (12.0, 7.5), (-0.1,))),
        ]
    )
    return _seen(dg.Camera(projection=track))


def pull_calibrated() -> Case:
    """Focus, iris and focal length of a calibration, ten times as wide as any real one."""
    near, far = (dg.Projection("equidistant", (24, 16), (f, f)) for f in (20.0, 30.0))
    camera = dg.Camera(
        projection=dg.keys([(0.75, near), (1.25, far)]),
        f_stop=dg.keys([(0.75, 0.06), (1.25, 0.12)]),
        focus_distance=dg.keys([(0.75, 1.2), (1.25, 4.0)]),
        blades=5,
    )
    return _seen(camera, lambda now: 1 / (now.f_stop or 0.0) ** 2)


def exact_pull() -> Case:
    """Focus and iris of a real lens; the frame is in units of mid-shutter all the way."""
    camera = dg.Camera(
        lens="double-gauss-50mm-f2",
        sensor_size=(5.4, 3.6),
        focus_distance=dg.keys([(0.75, 0.8), (1.25, 4.0)]),
        f_stop=dg.keys([(0.75, 2.0), (1.25, 4.0)]),
    )

    def exposure(now: dg.Camera) -> float:
        return float(dg.Session(dark(), now, resolution=(24, 16)).metadata["h0"])

    return _seen(camera, exposure)


# Light -----------------------------------------------------------------------------------------


def area_light() -> Case:
    """A square lamp travels and turns above a floor."""
    scene = dark()
    floor(scene)
    ball(scene, dg.Diffuse((0.5, 0.6, 0.7)), move(0, -0.4, -2.5), 0.4)
    points, faces = scenes.quad(0.25)
    lamp = dg.Material(dg.Diffuse((0, 0, 0)), emission=(12, 11, 9))
    down = turn(90, (1, 0, 0))
    path = across(move(-1.2, 0.4, -2.5) @ down, move(1.2, 0.8, -3) @ turn(80) @ down)
    scene.add_instance(scene.add_mesh(points, faces), lamp, path)
    return case(scene, pinhole(), OPEN)


def lamp_over_metal() -> Case:
    """Lamps come down to a frosted floor, where light and floor both know where to look."""
    scene = dark()
    floor(scene, dg.Conductor((0.9, 0.8, 0.7), 0.35))
    points, faces = scenes.quad(0.4)
    lamp = dg.Material(dg.Diffuse((0, 0, 0)), emission=(3, 3, 2), two_sided_emission=True)
    path = across(move(-1.5, 1.5, -4), move(0.6, -0.4, -2.8) @ turn(70, (1, 0, 0.4)))
    scene.add_instance(scene.add_mesh(points, faces), lamp, path)
    scene.add_light(
        dg.SphereLight((4, 5, 6), 0.3), across(move(1.5, 1, -4), move(-0.5, -0.4, -2.5))
    )
    return case(scene, pinhole(), OPEN)


def _lit(*lights: tuple[Any, Any]) -> Case:
    """A floor and a ball under lights."""
    scene = dark()
    floor(scene)
    ball(scene, dg.Diffuse((0.5, 0.6, 0.7)), move(0, -0.4, -2.5), 0.4)
    for light, transform in lights:
        scene.add_light(light, transform)
    return case(scene, pinhole(), OPEN)


def point_light() -> Case:
    """A lamp that moves and dims, and one that is switched off at 40 %."""
    dims = dg.keys([(0.75, (9.0, 6.0, 3.0)), (1.1, (1.0, 0.0, 0.0))])
    switched = dg.keys([(0.0, (0.0, 3.0, 6.0)), (0.96, (0.0, 0.0, 0.0))], "step")
    return _lit(
        (dg.PointLight(dims), across(move(-1.5, 0.5, -2), move(1.5, 0.5, -2))),
        (dg.PointLight(switched, range=dg.keys([(0.75, 1.5), (1.25, 4.0)])), move(0, 1, -1.5)),
    )


def sphere_light() -> Case:
    """A glowing ball moves, grows and dims."""
    grows = dg.keys([(0.75, 0.1), (1.25, 0.4)])
    dims = dg.keys([(0.75, (20.0, 15.0, 15.0)), (1.25, (3.0, 5.0, 2.0))])
    path = across(move(-1.0, 0.3, -2.5), move(0.5, 0.5, -3), move(1.0, -0.2, -2.5))
    return _lit((dg.SphereLight(dims, grows), path))


def shaped_lamps() -> Case:
    """A lamp and a card with profiles, which turn about an axis that is none of their own."""
    theta, phi = np.arange(0, 91, 10.0), np.arange(0, 361, 30.0)
    lobe = 1 + np.cos(np.radians(phi)) * np.sin(np.radians(theta))[:, None]
    profile = dg.LightProfile.table(theta, lobe, phi) * dg.LightProfile.cone(50, 0.5)
    down = turn(-60, (1, 0, 0))
    turns = across(*(move(0, 1, -2) @ turn(a, (1, 2, 0.5)) @ down for a in (-30, 80)))
    made = _lit((dg.PointLight((6.0, 6.0, 3.0), profile=profile), turns))
    card = dg.Material(dg.Diffuse((0, 0, 0)), "", (30, 10, 20), True, profile)
    points, faces = scenes.quad(0.2)
    way = across(*(move(0.4, 0.9, -2.5) @ turn(a, (1, 0, 1)) @ down for a in (-40, 60)))
    made.scene.add_instance(made.scene.add_mesh(points, faces), card, way)
    return made


def spot_light() -> Case:
    """A spot that swings and opens, and the sun going round."""
    opens = dg.keys([(0.75, 15.0), (1.25, 35.0)])
    down = turn(-90, (1, 0, 0))
    swing = across(move(-0.5, 1, -2.5) @ turn(-40) @ down, move(0.5, 1, -2.5) @ turn(40) @ down)
    sun = across(turn(-30, (1, 0, 0)), turn(-80, (1, 0.5, 0)))
    return _lit(
        (dg.SpotLight((12, 12, 8), 5.0, opens), swing), (dg.DirectionalLight((0.3, 0.5, 0.8)), sun)
    )


def turning_sky() -> Case:
    """A panorama turns and dims, seen itself and on a ball."""
    scene = sky(dg.keys([(0.75, 1.5), (1.25, 0.5)]), dg.keys([(0.75, 0.0), (1.25, 120.0)]))
    ball(scene, dg.Diffuse((0.8, 0.8, 0.8)), move(0, 0, -2), 0.5)
    ball(scene, dg.Conductor((0.9, 0.9, 0.9), 0.0), move(0.9, 0, -2.5), 0.4)
    return case(scene, pinhole(), OPEN)


# Materials -------------------------------------------------------------------------------------


def paint() -> Case:
    """Base colour, roughness, texture transform and emission change; so does glass."""
    scene = sky()
    image = scene.add_texture(pattern(), filter="nearest", min_filter="nearest")
    straight, moved = (1, 0, 0, 0, 1, 0), (0.6, 0.8, 0.4, -0.8, 0.6, 0.3)
    slides = TextureSlot(image, transform=dg.keys([(0.75, straight), (1.25, moved)]))
    color = dg.keys([(0.75, (0.9, 0.1, 0.1)), (1.0, (0.1, 0.1, 0.9)), (1.25, (0.1, 0.1, 0.9))])
    rough = dg.keys([(0.75, 0.1), (1.25, 0.9)])
    mesh = card_mesh(scene, 0.4)
    for x, kind in (
        (-0.9, Gltf(base_color=color, base_color_texture=slides, unlit=True)),
        (0.0, Gltf(base_color=color, metallic=rough, roughness=rough)),
    ):
        scene.add_instance(mesh, kind, move(x, 0.4, -2.5))
    glass = dg.Dielectric(ior=dg.keys([(0.75, 1.1), (1.25, 1.9)]))
    ball(scene, glass, move(0.8, -0.1, -2.2), 0.3)
    glow = dg.Material(dg.Diffuse(color), emission=dg.keys([(0.75, (0, 0, 0)), (1.25, (2, 2, 1))]))
    scene.add_instance(mesh, glow, move(-0.4, -0.5, -2.5))
    floor(scene)
    return case(scene, pinhole(), OPEN, max_depth=6)


# Shutters --------------------------------------------------------------------------------------


def _running(camera: dg.Camera) -> tuple[dg.Scene, dg.Camera]:
    scene = sky()
    card(scene, across(move(-1.0, 0, -3), move(1.0, 0.2, -3) @ turn(60)), size=0.7)
    return scene, camera


def rolling(order: str) -> Callable[[], Case]:
    """Lines in turn: each is the mean of the stills within its own window."""

    def make() -> Case:
        exposure, line = 0.1, 0.01
        roll = dg.RollingShutter(order, line_time=line)
        camera = pinhole(shutter_time=exposure, rolling_shutter=roll)
        scene, camera = _running(camera)
        width, height = 24, 16
        lines = height if order in ("top", "bottom") else width
        duration = exposure + (lines - 1) * line
        begin = TIME - 0.5 * duration
        index = np.arange(lines) if order in ("top", "left") else np.arange(lines)[::-1]
        opens = begin + index * line

        def window(t: float) -> Any:
            there = ((t >= opens) & (t < opens + exposure)) * (duration / exposure)
            return there[:, None] if order in ("top", "bottom") else there[None, :]

        made = case(scene, camera, exposure, window)
        still = made.still
        return replace(
            made,
            camera=camera,
            interval=(begin, begin + duration),
            still=lambda t: (still(t)[0], still(t)[1].with_(rolling_shutter=None)),
        )

    return make


def curve() -> Case:
    """Measured points: late and uneven."""
    points = [(0.0, 0.0), (0.3, 0.5), (0.5, 0.1), (0.9, 1.0), (1.0, 0.0)]
    scene, camera = _running(pinhole(shutter_curve=points))
    begin = TIME - 0.5 * OPEN
    fractions, values = np.array(points).T

    def window(t: float) -> float:
        return float(np.interp((t - begin) / OPEN, fractions, values))

    made = case(scene, camera, OPEN, window)
    still = made.still
    return replace(made, still=lambda t: (still(t)[0], still(t)[1].with_(shutter_curve=None)))


def leaf() -> Case:
    """The iris is the shutter: at each moment a lens of that stop, and that little light."""
    ramp = [(0.0, 0.0), (0.4, 1.0), (0.7, 1.0), (1.0, 0.0)]
    wide = 0.1
    camera = dg.Camera(
        lens="thin",
        focal_length=35.0,
        f_stop=wide,
        focus_distance=1.2,
        shutter_type="leaf",
        shutter_curve=ramp,
    )
    scene, camera = _running(camera)
    begin = TIME - 0.5 * OPEN

    def radius(t: float) -> float:
        return max(float(np.interp((t - begin) / OPEN, *np.array(ramp).T)), 1e-6)

    made = case(scene, camera, OPEN, lambda t: radius(t) ** 2)
    still = made.still

    def stopped(t: float) -> tuple[dg.Scene, dg.Camera]:
        now, eye = still(t)
        return now, eye.with_(f_stop=wide / radius(t), shutter_type=None, shutter_curve=None)

    return replace(made, still=stopped)


def through(shutter: Callable[[], Case]) -> Callable[[], Case]:
    """The same through a real lens; what is written for the thin one holds for it."""

    def make() -> Case:
        made = shutter()
        still = made.still

        def real(camera: dg.Camera) -> dg.Camera:
            lens = {"lens": "double-gauss-50mm-f2", "f_stop": 2.0, "focus_distance": 1.2}
            return replace(camera, focal_length=None, **lens)

        return replace(
            made, camera=real(made.camera), still=lambda t: (still(t)[0], real(still(t)[1]))
        )

    return make


ALL: dict[str, Callable[[], Case]] = {
    "translation": translation,
    "170 degrees on the way": half_turn,
    **{name: turns_by(name) for name in ("linear", "twist", "slerp", "decomposed")},
    "mirrored": mirrored,
    "sheared": sheared,
    "propeller": propeller,
    "reflections": reflections,
    "shadow": shadow,
    "appearing": appearing,
    "cloth": cloth,
    "glowing cloth": glowing_cloth,
    "pan": pan,
    "dolly": dolly,
    "crowd": crowd,
    "smoked glass": smoked_glass,
    "thin air": thin_air,
    "area light": area_light,
    "lamp over metal": lamp_over_metal,
    **{f"rolling {order}": rolling(order) for order in ("top", "bottom", "left", "right")},
    "curve": curve,
    "leaf": leaf,
    "point light": point_light,
    "sphere light": sphere_light,
    "spot light": spot_light,
    "shaped lamps": shaped_lamps,
    "turning sky": turning_sky,
    "paint": paint,
    "zoom": zoom,
    "zoom of a thin lens": zoom_thin,
    "sensor shift": sensor_shift,
    "focus pull": focus_pull,
    "iris": iris_closing,
    "zoom of a calibration": zoom_calibrated,
    "focus pull of a calibration": pull_calibrated,
}
#: of what takes longer
SLOW: dict[str, Callable[[], Case]] = {
    "exact": exact_pull,
    "exact, translation": through(translation),
    "exact, pan": through(pan),
    "exact, rolling": through(rolling("top")),
    "exact, curve": through(curve),
}
