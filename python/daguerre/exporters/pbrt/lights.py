"""Lamps and the environment as lights of pbrt."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from daguerre.exporters.outgoing.folder import OutgoingFolder
from daguerre.exporters.outgoing.lamps import plain, spot_factors, turned
from daguerre.exporters.outgoing.picture_file import write_pixels
from daguerre.exporters.outgoing.pictures import BLACK
from daguerre.files.notes import Notes
from daguerre.scene.light_profile import LightProfile
from daguerre.scene.lights import DirectionalLight, Light, SphereLight, SpotLight
from daguerre.scene.parts import Environment

from .octahedral import directions, resampled
from .text import Text, floats, point, rgb, string

#: Rows of the picture of a lamp's falloff; pbrt takes the nearest pixel.
_LAMP_ROWS = 1024
_ORIGIN = (0.0, 0.0, 0.0)

Array = NDArray[np.float64]


def add_lights(
    text: Text, lights: list[tuple[Light, Array]], folder: OutgoingFolder, notes: Notes
) -> None:
    """Adds all lamps."""
    for light, transform in lights:
        lamp = plain(light, notes)
        with text.block("Attribute"):
            _add_light(text, lamp, transform, folder, notes)


def _add_light(
    text: Text, light: Light, transform: Array, folder: OutgoingFolder, notes: Notes
) -> None:
    if isinstance(light, DirectionalLight):
        ahead = -turned(transform, "-z")[:3, 2]
        text.directive(
            "LightSource", "distant", rgb("L", light.illuminance), point("from", _ORIGIN),
            point("to", ahead.tolist()),
        )  # fmt: skip
    elif isinstance(light, SphereLight):
        text.transform(_at(transform))
        text.directive("Material", "diffuse", rgb("reflectance", BLACK))
        text.directive("AreaLightSource", "diffuse", rgb("L", light.luminance))
        text.directive("Shape", "sphere", floats("radius", light.radius))
    elif isinstance(light, SpotLight):
        text.transform(turned(transform, "-z"))
        factors = spot_factors(light, -_lamp_directions()[..., 2])
        notes.add("spot light is written with its falloff as a picture, in steps of 0.2 degrees")
        _add_goniometric(text, light.intensity, factors, folder)
    elif light.profile is not None:
        text.transform(_axes(transform))
        factors = _profile(light.profile, notes)
        notes.add("light profile is written as a picture, in steps of 0.2 degrees")
        _add_goniometric(text, light.intensity, factors, folder)
    else:
        text.transform(_at(transform))
        text.directive("LightSource", "point", rgb("I", light.intensity))


def add_environment(
    text: Text, environment: Environment | None, folder: OutgoingFolder, notes: Notes
) -> None:
    """Adds the light from infinity."""
    if environment is None:
        return
    scale = float(environment.scale)
    if environment.image is None:
        color = [c * scale for c in environment.color or BLACK]
        text.directive("LightSource", "infinite", rgb("L", color))
        return
    notes.add("environment map is resampled to pbrt's equal-area octahedron")
    path = write_pixels(folder, "environment", resampled(environment.image))
    angle = math.radians(environment.rotation)
    turn = np.eye(4)
    turn[0, 0] = turn[2, 2] = math.cos(angle)
    turn[0, 2], turn[2, 0] = math.sin(angle), -math.sin(angle)
    with text.block("Attribute"):
        text.transform(turn @ UPRIGHT)
        text.directive("LightSource", "infinite", string("filename", path), floats("scale", scale))


#: World from the octahedron: its axis +z becomes +y.
UPRIGHT = np.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]], np.float64)


def _add_goniometric(
    text: Text, intensity: tuple[float, float, float], factors: Array, folder: OutgoingFolder
) -> None:
    path = write_pixels(folder, "lamp", factors.astype(np.float32)[:, :, None])
    text.directive("LightSource", "goniometric", rgb("I", intensity), string("filename", path))


def _lamp_directions() -> Array:
    """Directions of a goniometric picture in the lamp's frame: pbrt exchanges y and z."""
    return np.asarray(directions(_LAMP_ROWS)[..., [0, 2, 1]])


def _profile(profile: LightProfile, notes: Notes) -> Array:
    found = profile.factors(_lamp_directions().reshape(-1, 3)).astype(np.float64)
    if not np.allclose(found, found[:, :1], rtol=1e-4, atol=1e-6 * max(found.max(), 1e-30)):
        notes.add("colours of a light profile are left out")
    return np.asarray(found.mean(axis=1).reshape(_LAMP_ROWS, _LAMP_ROWS))


def _at(transform: Array) -> Array:
    moved = np.eye(4)
    moved[:3, 3] = transform[:3, 3]
    return moved


def _axes(transform: Array) -> Array:
    """Frame of a lamp without scale; a mirrored frame stays mirrored."""
    made = _at(transform)
    made[:3, :3] = transform[:3, :3] / np.linalg.norm(transform[:3, :3], axis=0)
    return made
