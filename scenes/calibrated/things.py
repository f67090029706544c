"""A lamp, a mug, an apple, a fan that turns, and a plant."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from calibrated.place import about_x, about_y, about_z, on_desk, put, translucent
from daguerre.exporters.gltf import Shape
from kit import shapes
from kit.moves import spinning
from kit.pose import turn_y
from night.stage import WARM, Stage

TURNS_PER_SECOND, END_S = 45, 2.0  # of the fan
BULB = 0.030, 800.0  # radius of the bulb, m, and what it gives, lm


def add_things(stage: Stage) -> None:
    """All of them."""
    _add_lamp(stage)
    add_mug(stage)
    add_apple(stage)
    _add_fan(stage)
    add_plant(stage)


def _add_lamp(stage: Stage) -> None:
    """Two arms of brass and a shade of green enamel, white inside."""
    enamel = stage.matter("enamel", baseColorFactor=[0.02, 0.12, 0.09, 1], roughnessFactor=0.15)
    inside = stage.matter("shade inside", baseColorFactor=[0.85, 0.84, 0.80, 1])
    radius, lumen = BULB
    luminance = lumen / (4 * math.pi**2 * radius**2)  # a ball gives pi L from each of its points
    bulb = stage.matter("bulb", stage.shine(WARM, luminance), baseColorFactor=[0, 0, 0, 1])
    foot = [(0, 0), (0.085, 0), (0.088, 0.004), (0.084, 0.014), (0.030, 0.022), (0.012, 0.034)]
    foot += [(0.012, 0.05), (0, 0.05)]
    knee, head = np.array((0.08, 0.36, -0.02)), np.array((-0.14, 0.52, 0.10))
    arms = [
        shapes.tube([(0, 0.04, 0), knee], 0.006, 16),
        shapes.tube([knee, head], 0.006, 16),
        *(shapes.moved(shapes.ball(0.013, 16, 32), at) for at in (knee, head)),
    ]
    outer = [(0.092, -0.095), (0.078, -0.045), (0.045, -0.008), (0.022, 0.012), (0.018, 0.030)]
    outer += [(0, 0.032)]
    inner = [(0.016, 0.0), (0.043, -0.011), (0.076, -0.047), (0.0915, -0.095)]
    tilt = about_z(-18) @ about_x(10)
    parts = [(shapes.lathe(foot, 64), stage.brass), *((arm, stage.brass) for arm in arms)]
    for shape, matter in (
        (shapes.lathe(shapes.smooth_profile(outer), 96), enamel),
        (shapes.lathe(shapes.smooth_profile([(0, 0.0), *inner]), 96), inside),
        (shapes.moved(shapes.ico_ball(radius, 1), (0, -0.040, 0)), bulb),
    ):
        parts.append(
            (shapes.moved(shapes.turned(shape, tilt), np.subtract(head, (0, 0.035, 0))), matter)
        )
    put(stage, "lamp", parts, translation=on_desk(0.62, -0.30))


def add_mug(stage: Stage) -> None:
    """Stoneware, blue outside and white inside, with coffee."""
    blue = stage.matter("glaze", baseColorFactor=[0.03, 0.10, 0.24, 1], roughnessFactor=0.18)
    white = stage.matter("white glaze", baseColorFactor=[0.8, 0.79, 0.75, 1], roughnessFactor=0.2)
    coffee = stage.matter("coffee", baseColorFactor=[0.035, 0.014, 0.006, 1], roughnessFactor=0.05)
    outer = [(0, 0), (0.034, 0), (0.038, 0.003), (0.041, 0.012), (0.041, 0.088), (0.0400, 0.0925)]
    inner = [(0.0400, 0.0925), (0.0388, 0.0938), (0.0375, 0.0915), (0.0372, 0.012), (0, 0.008)]
    angle = np.linspace(-0.15, math.pi + 0.15, 33)
    arc = np.stack([0.038 + 0.026 * np.sin(angle), 0.048 - 0.030 * np.cos(angle), 0 * angle], 1)
    parts = [
        (shapes.lathe(outer, 96), blue),
        (shapes.lathe(inner, 96), white),
        (shapes.swept(arc, np.full(33, 0.0052), 20), blue),
        (shapes.lathe([(0.0374, 0.076), (0, 0.076)], 96), coffee),
    ]
    put(stage, "mug", parts, translation=on_desk(0.14, 0.01), rotation=turn_y(-35))


def add_apple(stage: Stage) -> None:
    """Red, with a stalk."""
    red = stage.matter("apple", baseColorFactor=[0.50, 0.05, 0.03, 1], roughnessFactor=0.3)
    bark = stage.matter("stalk", baseColorFactor=[0.10, 0.06, 0.03, 1], roughnessFactor=0.9)
    profile = [(0, 0.006), (0.010, 0.002), (0.020, 0.001), (0.034, 0.018), (0.039, 0.042)]
    profile += [(0.034, 0.062), (0.020, 0.071), (0.008, 0.066), (0, 0.058)]
    body = shapes.lathe(shapes.smooth_profile(profile, 8), 64, 180)
    stalk = shapes.tube([(0, 0.056, 0), (0.002, 0.072, 0.001), (0.008, 0.085, 0.003)], 0.0013, 8)
    put(stage, "apple", [(body, red), (stalk, bark)], translation=on_desk(-0.62, 0.04))


def _add_fan(stage: Stage) -> None:
    """A fan of the size of a hand. Its blades turn: a rolling shutter bends them."""
    paint = stage.matter("fan", baseColorFactor=[0.72, 0.70, 0.64, 1], roughnessFactor=0.3)
    hub = 0.185  # its height, m
    foot = [(0, 0), (0.062, 0), (0.064, 0.004), (0.050, 0.014), (0.012, 0.026), (0.010, 0.085)]
    stem = shapes.lathe([*foot, (0, 0.085)], 64)
    motor = [(0, -0.055), (0.026, -0.050), (0.032, -0.030), (0.030, -0.014), (0, -0.014)]
    laid = shapes.turned(shapes.lathe(motor, 48), about_x(90))
    bow = np.linspace(math.pi, 2 * math.pi, 33)
    fork = np.stack([0.106 * np.cos(bow), hub + 0.106 * np.sin(bow), 0 * bow - 0.02], 1)
    parts = [(stem, paint), (shapes.moved(laid, (0, hub, 0)), paint)]
    parts.append((shapes.tube(fork, 0.0045, 12), paint))
    parts += [(wire, stage.wire) for wire in _cage(hub)]
    place = {"translation": on_desk(-0.42, -0.26), "rotation": turn_y(24)}
    fan = put(stage, "fan", parts, **place)
    blue = stage.matter("blade", baseColorFactor=[0.03, 0.16, 0.24, 1], roughnessFactor=0.35)
    blades = [(_blade(2 * math.pi * k / 5), blue) for k in range(5)]
    nose = shapes.turned(
        shapes.lathe([(0.018, -0.01), (0.018, 0.008), (0, 0.016)], 48), about_x(90)
    )
    turning = put(stage, "fan", [*blades, (nose, paint)], parent=fan, translation=(0, hub, 0))
    turn = spinning(turning, (0, 0, 1), TURNS_PER_SECOND, END_S, 20)
    stage.glb.add_animation("fan", [turn])


def _cage(hub: float) -> list[Shape]:
    """Rings and spokes of wire before and behind the blades."""
    wires = []
    angle = np.linspace(0, 2 * math.pi, 65)
    for z in (-0.022, 0.026):
        for radius in (0.030, 0.064, 0.098):
            depth = z * (1 - 0.35 * (radius / 0.098) ** 2)
            ring = np.stack([radius * np.cos(angle), hub + radius * np.sin(angle), 0 * angle], 1)
            wires.append(shapes.tube(np.add(ring, (0, 0, depth)), 0.0009, 6))
        for k in range(16):
            r = np.linspace(0.0, 0.098, 9)
            a = 2 * math.pi * k / 16
            line = [r * math.cos(a), hub + r * math.sin(a), z * (1 - 0.35 * (r / 0.098) ** 2)]
            wires.append(shapes.tube(np.stack(line, 1), 0.0007, 6))
    return wires


def _blade(turned: float) -> Shape:
    """A sheet from the hub outward, twisted, with two sides."""
    r, t = np.linspace(0.015, 0.090, 13)[:, None], np.linspace(-0.5, 0.5, 11)[None]
    wide = 0.72 * (0.55 + 0.45 * np.sin(math.pi * np.clip((r - 0.0) / 0.1, 0, 1)))
    angle = turned + wide * t
    grid = np.stack([r * np.cos(angle), r * np.sin(angle), -0.016 * t * (r > 0)], -1)
    return shapes.join(shapes.surface(grid), shapes.surface(grid[::-1]))


def add_plant(stage: Stage) -> None:
    """A rubber plant in a pot of clay."""
    clay = stage.matter("clay", baseColorFactor=[0.50, 0.20, 0.11, 1], roughnessFactor=0.9)
    soil = stage.matter("soil", baseColorFactor=[0.03, 0.02, 0.014, 1], roughnessFactor=1.0)
    stalk = stage.matter("stem", baseColorFactor=[0.09, 0.12, 0.04, 1], roughnessFactor=0.7)
    pot = [(0, 0), (0.052, 0), (0.055, 0.003), (0.070, 0.105), (0.077, 0.107), (0.079, 0.132)]
    pot += [(0.076, 0.135), (0.070, 0.133), (0.068, 0.112)]
    parts = [(shapes.lathe(pot, 64), clay), (shapes.lathe([(0.069, 0.116), (0, 0.120)], 48), soil)]
    rng = np.random.default_rng(31)
    green = translucent(stage, "leaf", (0.035, 0.11, 0.03), 0.28, 0.3, (0.16, 0.30, 0.03))
    for lean, high in (((0.05, 0.02), 0.34), ((-0.07, 0.03), 0.27), ((0.01, -0.05), 0.40)):
        t = np.linspace(0, 1, 12)[:, None]
        stem = np.hstack([lean[0] * t**1.4, 0.115 + high * t, lean[1] * t**1.4])
        parts.append((shapes.tube(stem, 0.0032, 8), stalk))
        for k, at in enumerate(np.linspace(0.22, 1.0, 7)):
            foot = [np.interp(at, t[:, 0], stem[:, axis]) for axis in range(3)]
            heading = 137.5 * k + rng.uniform(-20, 20)
            rise = 15 + 50 * at + rng.uniform(-12, 12)
            leaf = _leaf(rng.uniform(0.10, 0.15) * (1.15 - 0.35 * at), rise)
            parts.append((shapes.moved(shapes.turned(leaf, about_y(heading)), foot), green))
    put(stage, "plant", parts, translation=on_desk(-0.74, -0.26))


def _leaf(long: float, rise_deg: float) -> Shape:
    """Along +x from its stalk, rising first and hanging over at its tip."""
    t = np.linspace(0, 1, 17)[:, None]
    s = np.linspace(-1, 1, 9)[None]
    half = 0.26 * long * np.sin(math.pi * np.clip((t - 0.14) / 0.86, 0, 1) ** 0.8) + 0.0012
    bend = np.radians(rise_deg) - 1.3 * t
    x = np.cumsum(np.cos(bend), axis=0) * long / 17
    y = np.cumsum(np.sin(bend), axis=0) * long / 17
    grid: NDArray[np.float64] = np.stack(
        np.broadcast_arrays(x, y + 0.22 * half * np.abs(s), -half * s), -1
    )
    return shapes.surface(grid)
