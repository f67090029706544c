"""Light of lamps by direction, for renderers with other falloffs."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from daguerre.files.notes import Notes
from daguerre.scene.light_profile import LightProfile
from daguerre.scene.lights import DirectionalLight, Light, PointLight, SphereLight, SpotLight

Array = NDArray[np.float64]
#: Steps of a profile's angle from its axis, degrees about it, and the share of light that is none.
_STEPS, _AROUND, _DARK = 3600, 5, 1e-6


def spot_factors(light: SpotLight, cosines: Array) -> Array:
    """Share of a spot light's intensity at an angle from its axis.

    Source: KHR_lights_punctual, the squared ramp in the cosine that its text recommends.

    Args:
        light: The light.
        cosines: Cosines of angles from the axis, any shape.
    """
    outer = math.cos(math.radians(light.outer_angle))
    inner = math.cos(math.radians(light.inner_angle))
    ramp = np.clip((cosines - outer) / max(1e-3, inner - outer), 0.0, 1.0)
    return np.asarray(ramp**2)


def reach_of(profile: LightProfile) -> float:
    """Half angle of the cone around -z, degrees, outside of which a profile gives no light."""
    theta = np.radians(np.linspace(0, 180, _STEPS + 1))[:, None]
    phi = np.radians(np.arange(0, 360, _AROUND))
    flat = np.sin(theta)
    ways = np.stack([flat * np.cos(phi), flat * np.sin(phi), -np.cos(theta) + 0 * phi], axis=-1)
    factors = profile.factors(ways.reshape(-1, 3)).reshape(len(theta), -1).max(axis=1)
    lit = np.flatnonzero(factors > _DARK * factors.max())
    last = int(lit[-1]) + 1 if len(lit) else 0
    return min(last, _STEPS) * 180 / _STEPS


def plain(light: Light, notes: Notes) -> Light:
    """Returns a light that pbrt and Mitsuba have; point lights with a radius become spheres."""
    if isinstance(light, PointLight | SpotLight) and not math.isinf(light.range):
        notes.add("range of a light is left out: it falls off with distance only")
        light = replace(light, range=math.inf)
    if isinstance(light, PointLight) and light.radius > 0:
        area = math.pi * light.radius**2
        red, green, blue = (c / area for c in light.intensity)
        light = SphereLight((red, green, blue), light.radius, light.name, light.profile)
    if isinstance(light, SphereLight) and light.profile is not None:
        notes.add("light profile of a sphere light is left out: it emits equally in all directions")
        light = replace(light, profile=None)
    if isinstance(light, DirectionalLight) and light.angle > 0:
        notes.add("angle of a directional light is left out: its shadows are sharp")
        light = replace(light, angle=0.0)
    return light


def turned(transform: Array, ahead: str) -> Array:
    """Rigid frame of a lamp that shines along -z, for a renderer in which it shines elsewhere.

    Args:
        transform: World from lamp, shape (4, 4).
        ahead: ``-z``, or ``+z``: then the frame is turned about its y axis by half a turn.

    Raises:
        InputError: Never; a lamp without a direction was refused before.
    """
    z = transform[:3, 2] / np.linalg.norm(transform[:3, 2])
    guess = transform[:3, 1]
    x = np.cross(guess, z)
    if np.linalg.norm(x) < 1e-9 * max(1.0, float(np.linalg.norm(guess))):
        x = np.cross((0, 0, 1) if abs(z[2]) < 0.9 else (1, 0, 0), z)
    x = x / np.linalg.norm(x)
    y = np.cross(z, x)
    made = np.eye(4)
    sign = 1 if ahead == "-z" else -1
    made[:3, 0], made[:3, 1], made[:3, 2] = sign * x, y, sign * z
    made[:3, 3] = transform[:3, 3]
    return made
