"""A racing car of the thirties on a country road, at 70 km/h, from 0 s to 1 s.

It passes the cameras at 0.5 s. Camera `still` stands, `pan` turns with the car, `slow` turns with
half its speed as Lartigue's did in 1912, `wheel` drives beside it. The wheels turn 129 degrees in a
24th of a second and have eight spokes: on film they seem to turn backwards, 6 degrees a frame.
"""

from __future__ import annotations

import math

import numpy as np

from daguerre.exporters.gltf import Glb, Track
from extensions.studio import Studio
from kit import shapes, textures
from kit.moves import following, going, spinning
from kit.pose import look
from motion.figures import roundel
from motion.wheels import RADIUS, add_wheel, matters

TURNS_PER_SECOND = 8.6
SPEED = TURNS_PER_SECOND * 2 * math.pi * RADIUS  # m/s
END_S = 1.0
LYING = (-math.sqrt(0.5), 0, 0, math.sqrt(0.5))
EYE = (0.0, 1.25, 8.2)
SUN_FROM = (5, 8, 9)


def make() -> Glb:
    """The scene."""
    studio = Studio("motion.py")
    _sky(studio)
    _country(studio)
    _roadside(studio)
    car, wheels = _car(studio)
    ends = [(SPEED * (t - 0.5), 0, 0) for t in (0, END_S)]
    tracks = [going(car, [0, END_S], ends)]
    tracks += [spinning(w, (0, 0, -1), TURNS_PER_SECOND, END_S, 20 * k) for k, w in wheels]
    studio.glb.add_animation("the race", tracks + _cameras(studio))
    return studio.glb


def _cameras(studio: Studio) -> list[Track]:
    glb = studio.glb

    def camera(name: str, eye, target, focal_mm: float, focus_m: float) -> int:
        number = glb.add_camera(name, focal_mm, 8, focus_m)
        return glb.add_node(name, camera=number, translation=eye, rotation=look(eye, target))

    times = np.linspace(0, END_S, 97)
    middle = np.array((0, 0.75, 0))
    camera("still", EYE, middle, 50, 8.2)
    tracks = []
    for name, share, focal_mm in (("pan", 1.0, 50), ("slow", 0.5, 75)):
        targets = [np.add(middle, (share * SPEED * (t - 0.5), 0, 0)) for t in times]
        node = camera(name, EYE, middle, focal_mm, 8.2)
        tracks.append(following(node, EYE, times, targets))
    beside = [(1.2 + SPEED * (t - 0.5), 0.55, 4.2) for t in (0, END_S)]
    wheel = camera("wheel", beside[0], np.subtract(beside[0], (0, 0.17, 4.2)), 125, 3.5)
    return [*tracks, going(wheel, [0, END_S], beside)]


def _sky(studio: Studio) -> None:
    height = np.linspace(0, 1, 64)[:, None] ** 0.6 * np.ones((1, 8))
    glow = textures.ramp(height, [(0.95, 0.9, 0.82), (0.55, 0.72, 0.92), (0.3, 0.5, 0.85)])
    picture = studio.glb.add_picture("sky", textures.png(glow))
    sky = studio.shining("sky", (1, 1, 1), 1.0, emissiveTexture=picture)
    angle = np.linspace(math.pi / 2, 0, 9)  # downward, so that it faces inward
    dome = shapes.lathe(np.stack([np.cos(angle).clip(0), np.sin(angle)], 1), 24, 180)
    studio.put("sky", dome, sky, scale=(150, 150, 150))
    # A disc inside of the dome, 1.7 degrees wide, of 5 lux.
    at, radius = np.multiply(SUN_FROM, 140 / np.linalg.norm(SUN_FROM)), 2.1
    glare = studio.shining("sun", (1.0, 0.86, 0.65), 5 * 140**2 / (math.pi * radius**2))
    turn = look((0, 0, 0), at.tolist())
    studio.put("sun", shapes.disc(radius, 16), glare, at.tolist(), rotation=turn)


def _country(studio: Studio) -> None:
    def ground(name: str, size, stops, grain, repeat, at) -> None:
        noise = textures.noise((256, 256), grain, 3) + 0.6 * textures.noise((256, 256), (9, 9), 4)
        color = textures.ramp(np.clip(0.5 + 0.18 * noise, 0, 1), stops)
        picture = studio.glb.add_picture(name, textures.jpeg(color))
        matter = studio.matter(name, (1, 1, 1), 0.9, pbr={"baseColorTexture": picture})
        studio.put(name, shapes.square(*size, (0, 0, *repeat)), matter, at, rotation=LYING)

    grass = [(0.07, 0.13, 0.025), (0.17, 0.25, 0.05)]
    ground("grass", (300, 300), grass, (2, 2), (120, 120), (0, -0.002, 0))
    sand = [(0.36, 0.31, 0.25), (0.52, 0.47, 0.39)]
    ground("road", (300, 5.2), sand, (1.2, 1.2), (115, 2), (0, 0, 0))


def _roadside(studio: Studio) -> None:
    """Posts, a hoarding, poplars, a village and hills: what a pan smears, near and far."""
    rng = np.random.default_rng(30)
    white = studio.matter("post", (0.8, 0.78, 0.72), 0.6)
    red = studio.matter("red", (0.6, 0.04, 0.03), 0.5)
    wall = [studio.matter("wall", c, 0.9) for c in ((0.75, 0.68, 0.55), (0.62, 0.4, 0.3))]
    roof = studio.matter("roof", (0.4, 0.13, 0.08), 0.8)
    leaves = [studio.matter("leaf", c, 0.9) for c in ((0.06, 0.15, 0.03), (0.1, 0.2, 0.05))]
    hill = studio.matter("hill", (0.12, 0.2, 0.13), 1.0)
    post = studio.glb.add_mesh("post", shapes.box((0.14, 0.7, 0.14)), white)
    band = studio.glb.add_mesh("band", shapes.box((0.15, 0.16, 0.15)), red)
    for x in np.arange(-60, 61, 2.2):
        studio.glb.add_node("post", mesh=post, translation=(x, 0, -3.1))
        studio.glb.add_node("band", mesh=band, translation=(x, 0.5, -3.1))
    crown = shapes.lathe([(0, 0), (0.55, 0.6), (0.8, 2.2), (0.55, 5.0), (0, 7.2)], 12, 180)
    crowns = [studio.glb.add_mesh("crown", crown, m) for m in leaves]
    for x in np.arange(-80, 81, 3.4):
        at, size = (x + rng.uniform(-0.5, 0.5), 0.6, -10 - rng.uniform(0, 2)), rng.uniform(0.8, 1.1)
        mesh = crowns[int(rng.integers(2))]
        studio.glb.add_node("poplar", mesh=mesh, translation=at, scale=(size, size, size))
    for x in np.arange(-90, 91, 9.0):
        size = rng.uniform((4, 3.4, 4), (7, 5.5, 6))
        at = (x + rng.uniform(-2, 2), 0, -34 - rng.uniform(0, 8))
        studio.put("house", shapes.box(size), wall[int(rng.integers(2))], at)
        gable = shapes.slab([(-0.55 * size[0], 0), (0.55 * size[0], 0), (0, -size[0] * 0.42)], 6)
        up = (math.sqrt(0.5), 0, 0, math.sqrt(0.5))
        studio.put("roof", gable, roof, np.add(at, (0, size[1], 3)).tolist(), rotation=up)
    for k, x in enumerate((-70, -20, 45, 95)):
        studio.put("hill", shapes.ball(1, 16, 32), hill, (x, -8, -90), scale=(45, 18 + 3 * k, 20))


def _car(studio: Studio) -> tuple[int, list[tuple[int, int]]]:
    """A node that drives toward +x, and its wheels, numbered."""
    glb = studio.glb
    coat = {"clearcoat": {"clearcoatFactor": 1.0, "clearcoatRoughnessFactor": 0.03}}
    green = studio.matter("body", (0.02, 0.13, 0.07), 0.4, extensions=coat)
    steel = studio.matter("steel", (0.7, 0.7, 0.72), 0.2, 1.0)
    leather = studio.matter("leather", (0.25, 0.1, 0.04), 0.5)
    skin = studio.matter("face", (0.6, 0.38, 0.27), 0.5)
    black = studio.matter("grille", (0.02, 0.02, 0.02), 0.4)
    car = glb.add_node("car")
    along = [[0, 1, 0], [-1, 0, 0], [0, 0, 1]]  # the axis of a lathe, y, becomes x
    cigar = [(0, -1.95), (0.12, -1.85), (0.27, -1.4), (0.38, -0.7), (0.4, 0), (0.36, 0.8)]
    hull = shapes.lathe(shapes.smooth_profile([*cigar, (0.29, 1.45), (0.24, 1.62)]), 64, 60)
    body = shapes.turned(hull, along)
    studio.put("body", body, green, (0, 0.58, 0), parent=car, scale=(1, 0.95, 0.95))
    nose = shapes.turned(shapes.lathe([(0.23, 1.62), (0.2, 1.66), (0, 1.68)], 48), along)
    studio.put("grille", nose, black, (0, 0.58, 0), parent=car)
    ring = np.linspace(0, 2 * math.pi, 49)
    bow = np.stack([0 * ring, np.cos(ring), np.sin(ring)], 1) * 0.235 + (1.63, 0.57, 0)
    studio.put("bow", shapes.swept(bow, np.full(49, 0.022), 12, closed=True), steel, parent=car)
    for side in (-1, 1):
        pipe = [(0.9, 0.5, 0.36), (0.5, 0.42, 0.42), (-0.2, 0.4, 0.44), (-1.9, 0.42, 0.4)]
        path = np.array(pipe) * (1, 1, side)
        tube = shapes.swept(path, np.full(4, 0.045), 16)
        studio.put("pipe", tube, steel, parent=car)
        picture = glb.add_picture("seven", textures.png(roundel("7")))
        paper = studio.matter("seven", (1, 1, 1), 0.5, pbr={"baseColorTexture": picture})
        turn = (0, 0, 0, 1) if side > 0 else (0, 1, 0, 0)
        at = (-0.62, 0.66, 0.385 * side)
        studio.put("seven", shapes.disc(0.2, 40), paper, at, parent=car, rotation=turn)
    axles = [(-1.2, 0.36), (1.2, 0.36)]
    for x, y in axles:
        bar = shapes.swept([(x, y, -0.7), (x, y, 0), (x, y, 0.7)], np.full(3, 0.035), 12)
        studio.put("axle", bar, steel, parent=car)
    _driver(studio, car, leather, skin, steel, black)
    matter = matters(studio)
    places = [(x, y, z) for x, y in axles for z in (-0.72, 0.72)]
    return car, [(k, add_wheel(studio, matter, car, at)) for k, at in enumerate(places)]


def _driver(studio: Studio, car: int, leather: int, skin: int, steel: int, black: int) -> None:
    chest = shapes.lathe([(0, -0.3), (0.2, -0.2), (0.22, 0), (0.12, 0.17), (0, 0.2)], 32, 180)
    studio.put("chest", chest, leather, (-0.42, 1.0, 0), parent=car, scale=(0.8, 1, 1.1))
    studio.put("head", shapes.ball(0.115), skin, (-0.38, 1.3, 0), parent=car)
    cap = shapes.lathe([(0.128, -0.02), (0.128, 0.03), (0.1, 0.085), (0, 0.13)], 32, 180)
    studio.put("cap", cap, leather, (-0.39, 1.31, 0), parent=car)
    for side in (-1, 1):
        at = (-0.285, 1.31, 0.045 * side)
        studio.put("goggle", shapes.ball(0.037, 12, 24), black, at, parent=car, scale=(0.6, 1, 1))
        arm = [(-0.42, 1.08, 0.22 * side), (-0.2, 0.97, 0.27 * side), (0.08, 1.06, 0.13 * side)]
        studio.put("arm", shapes.swept(arm, [0.07, 0.06, 0.045], 16), leather, parent=car)
    ring = np.linspace(0, 2 * math.pi, 41)
    lean, rise = 0.12 + 0.05 * np.cos(ring), 1.03 + 0.15 * np.cos(ring)
    wheel = np.stack([lean, rise, 0.16 * np.sin(ring)], 1)
    steering = shapes.swept(wheel, np.full(41, 0.014), 8, closed=True)
    studio.put("steering", steering, black, parent=car)
    bow = [(0.2, 0.95, -0.2), (0.2, 1.1, 0), (0.2, 0.95, 0.2)]
    screen = shapes.swept(bow, np.full(3, 0.012), 8)
    studio.put("screen", screen, steel, parent=car)
