"""The scenes. Parameters are what a test may plant a fault in; the references hold the defaults."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from .description import (
    Array,
    Description,
    Lamp,
    Surface,
    View,
    ball,
    floor,
    rectangle,
    ring,
)

GROUND = Surface("diffuse", 0.5)


def metals(*, lamp: float = 4.0, alpha: float = 0.25, reflectance: float = 0.8) -> Description:
    """Diffuse, rough metal and mirror under an area light and an even sky, through a pinhole."""
    scene = Description(View((0, 1.6, 4.2), (0, 0.45, 0), 50), sky=0.3)
    scene.parts = [
        (floor(), GROUND),
        (ball((-1.05, 0.5, 0), 0.5), Surface("diffuse", 0.7)),
        (ball((0, 0.5, -0.3), 0.5), Surface("conductor", reflectance, alpha)),
        (ball((1.05, 0.5, 0), 0.5), Surface("conductor", 0.9)),
        (rectangle((-1.0, 3, 1), (1.5, 0, 0), (0, 0, 1.5)), Surface("lamp", lamp)),
    ]
    return scene


def glass(*, ior: float = 1.5, alpha: float = 0.3, sky: float = 0.5) -> Description:
    """A clear and a frosted ball before a striped wall, under an area light and an even sky."""
    scene = Description(View((0, 1.2, 4), (0, 0.6, 0), 50), sky=sky)
    scene.parts = [
        (floor(), GROUND),
        (ball((-0.7, 0.6, 0), 0.6), Surface("dielectric", ior)),
        (ball((0.7, 0.6, 0), 0.6), Surface("dielectric", ior, alpha)),
        (rectangle((0, 3.5, 0.5), (1.5, 0, 0), (0, 0, 1.5)), Surface("lamp", 2.0)),
    ]
    for i in range(-3, 4):
        wall = rectangle((0.8 * i, 1, -1.5), (0.2, 0, 0), (0, 1, 0))
        scene.parts.append((wall, Surface("diffuse", 0.8)))
    return scene


def bulbs(*, luminance: float = 30.0, radius: float = 0.25) -> Description:
    """Two spheres of light, seen directly and in a rough metal, over a diffuse floor."""
    scene = Description(View((0, 1.8, 4), (0, 0.6, 0), 45))
    scene.parts = [
        (floor(), GROUND),
        (ball((0.9, 0.5, -0.2), 0.5), Surface("conductor", 0.7, 0.15)),
        (ball((-0.1, 0.3, 0.6), 0.3), Surface("diffuse", 0.6)),
    ]
    scene.lamps = [
        Lamp("sphere", luminance, (-0.9, 0.9, 0), radius=radius),
        Lamp("sphere", 400, (0.4, 2.2, 1), radius=0.05),
    ]
    return scene


def defocus(*, focus: float = 3.0, aperture: float = 600.0) -> Description:
    """A 50 mm lens opened to f/0.08: small lamps and balls far before and behind its focus."""
    scene = Description(View((0, 0.6, 3), (0, 0.6, 0), 50, aperture, focus), sky=0.2)
    scene.parts = [
        (floor(), GROUND),
        (ball((0.1, 0.6, 0), 0.35), Surface("diffuse", 0.8)),
        (ball((-0.25, 0.75, 1.5), 0.12), Surface("conductor", 0.9, 0.3)),
        (ball((1.2, 0.9, -3), 0.5), Surface("diffuse", 0.2)),
        (rectangle((-1.2, 1.2, -3), (0.3, 0, 0), (0, 0.3, 0)), Surface("lamp", 4)),
        (rectangle((0.22, 0.4, 1.5), (0.05, 0, 0), (0, 0.05, 0)), Surface("lamp", 6)),
        (rectangle((0.7, 1.1, 0), (0.1, 0, 0), (0, 0.1, 0)), Surface("lamp", 4)),
    ]
    return scene


def sun_sky(
    turn: float = 0.0, peak: float = 40.0, mirrored: bool = False
) -> Callable[[Array], Array]:
    """A smooth sky: brighter above, a hot spot to the left, a dim one to the right, below."""

    def luminance(direction: Array) -> Array:
        x, y, z = np.moveaxis(direction, -1, 0)
        c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))
        d = np.stack([(-1 if mirrored else 1) * (c * x + s * z), y, c * z - s * x], -1)
        hot, dim = np.array([-0.65, 0.25, -0.72]), np.array([0.6, -0.2, -0.8])
        out = 0.3 + 0.25 * d[..., 1]
        for axis, width, height in ((hot, 0.12, peak), (dim, 0.25, 1.5)):
            cosine = d @ (axis / np.linalg.norm(axis))
            out = out + height * np.exp((cosine - 1) / width**2)
        return out

    return luminance


def environment(*, turn: float = 0.0, peak: float = 40.0, mirrored: bool = False) -> Description:
    """A picture for a sky, with the sun in the frame."""
    scene = Description(View((0, 0.9, 4), (0, 0.7, 0), 24), sky=sun_sky(turn, peak, mirrored))
    scene.parts = [
        (rectangle((0, 0, 0), (1.6, 0, 0), (0, 0, -1.6)), GROUND),
        (ball((-0.6, 0.5, 0), 0.5), Surface("diffuse", 0.7)),
        (ball((0.6, 0.5, 0), 0.5), Surface("conductor", 0.8, 0.2)),
    ]
    return scene


def punctual(*, point: float = 6.0, outer: float = 30.0, sun: float = 0.8) -> Description:
    """A point, a spot with KHR_lights_punctual's soft edge and a sun."""
    scene = Description(View((0, 2.2, 4), (0, 0.3, 0), 45))
    scene.parts = [
        (floor(), GROUND),
        (ball((0.2, 0.45, -0.4), 0.45), Surface("diffuse", 0.8)),
        (ball((-1.1, 0.35, 0.2), 0.35), Surface("conductor", 0.8, 0.35)),
    ]
    aim = np.array([-0.3, -2.2, 0.1]) / np.linalg.norm([-0.3, -2.2, 0.1])
    direction = (float(aim[0]), float(aim[1]), float(aim[2]))
    scene.lamps = [
        Lamp("point", point, (-0.6, 1.2, 1.0)),
        Lamp("spot", 25, (1.2, 2.2, 0.3), direction, inner=10, outer=outer),
        Lamp("directional", sun, direction=(0.48, -0.6, -0.64)),
    ]
    return scene


def caustic(*, lamp: float = 4.0, radius: float = 0.9, reflectance: float = 0.9) -> Description:
    """An area light that a concave mirror throws on the floor as a bright curve."""
    scene = Description(View((0, 4, 1.8), (0, 0, 0), 60))
    scene.parts = [
        (floor(), GROUND),
        (ring((0, 0, 0), radius, 0.5, 3.6), Surface("conductor", reflectance)),
        (rectangle((0.5, 1.2, 3.2), (1.2, 0, 0), (0, -0.7, 0.2)), Surface("lamp", lamp)),
    ]
    return scene


ALL: dict[str, Callable[..., Description]] = {
    f.__name__: f for f in (metals, glass, bulbs, defocus, environment, punctual, caustic)
}
