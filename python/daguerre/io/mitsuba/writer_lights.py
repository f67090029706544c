"""Lamps and the environment as emitters of Mitsuba."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from daguerre.files.notes import Notes
from daguerre.io.outgoing.folder import OutgoingFolder
from daguerre.io.outgoing.lamps import plain, spot_factors, turned
from daguerre.io.outgoing.picture_file import write_pixels
from daguerre.io.outgoing.pictures import BLACK
from daguerre.scene.lights import DirectionalLight, Light, PointLight, SphereLight, SpotLight
from daguerre.scene.parts import Environment

from .writer_xml import Element, add, add_matrix, add_point, add_rgb, add_value

#: Widest half angle of a spot light, degrees: its falloff is a picture on a plane across its axis.
_WIDEST = 85.0
#: Difference of the angles between which Mitsuba's own falloff goes to 0, degrees.
_EDGE = 1e-3
_MOST_TEXELS = 2048
_TEXELS_PER_TANGENT = 512

Array = NDArray[np.float64]


def add_lights(
    root: Element, lights: list[tuple[Light, Array]], folder: OutgoingFolder, notes: Notes
) -> None:
    """Adds all lamps."""
    for light, transform in lights:
        one = plain(light, notes)
        if isinstance(one, SphereLight):
            _add_ball(root, one, transform)
        elif isinstance(one, DirectionalLight):
            emitter = add(root, "emitter", type="directional")
            add_point(emitter, "vector", "direction", -turned(transform, "-z")[:3, 2])
            add_rgb(emitter, "irradiance", one.illuminance)
        elif isinstance(one, SpotLight):
            _add_spot(root, one, transform, folder, notes)
        else:
            if one.profile is not None:
                notes.add("light profile of a point lamp is left out: it shines evenly")
            _add_point_lamp(root, one, transform)


def add_environment(root: Element, environment: Environment | None, folder: OutgoingFolder) -> None:
    """Adds the light from infinity."""
    if environment is None:
        return
    if environment.image is None:
        emitter = add(root, "emitter", type="constant")
        color = environment.color or BLACK
        add_rgb(emitter, "radiance", [c * environment.scale for c in color])
        return
    emitter = add(root, "emitter", type="envmap")
    path = write_pixels(folder, "environment", environment.image)
    add_value(emitter, "string", "filename", path)
    add_value(emitter, "float", "scale", float(environment.scale))
    # The middle of its picture is at +z, of ours at -z.
    angle = math.radians(environment.rotation + 180)
    turn = np.eye(4)
    turn[0, 0] = turn[2, 2] = math.cos(angle)
    turn[0, 2], turn[2, 0] = math.sin(angle), -math.sin(angle)
    add_matrix(emitter, "to_world", turn)


def _add_point_lamp(root: Element, light: PointLight, transform: Array) -> None:
    emitter = add(root, "emitter", type="point")
    add_point(emitter, "point", "position", transform[:3, 3])
    add_rgb(emitter, "intensity", light.intensity)


def _add_ball(root: Element, light: SphereLight, transform: Array) -> None:
    shape = add(root, "shape", type="sphere")
    add_point(shape, "point", "center", transform[:3, 3])
    add_value(shape, "float", "radius", float(light.radius))
    add_rgb(add(shape, "bsdf", type="diffuse"), "reflectance", BLACK)
    add_rgb(add(shape, "emitter", type="area"), "radiance", light.luminance)


def _add_spot(
    root: Element, light: SpotLight, transform: Array, folder: OutgoingFolder, notes: Notes
) -> None:
    """Adds a spot light with its falloff as a picture, as Mitsuba's own is linear in the angle."""
    outer = float(light.outer_angle)
    if outer > _WIDEST:
        notes.add(f"spot light wider than {_WIDEST:g} degrees is cut off there")
        outer = _WIDEST
    emitter = add(root, "emitter", type="spot")
    add_matrix(emitter, "to_world", turned(transform, "+z"))
    add_rgb(emitter, "intensity", light.intensity)
    add_value(emitter, "float", "cutoff_angle", outer)
    add_value(emitter, "float", "beam_width", outer - _EDGE)
    texture = add(emitter, "texture", type="bitmap", name="texture")
    path = write_pixels(folder, "lamp", _falloff(light, outer))
    add_value(texture, "string", "filename", path)
    add_value(texture, "string", "wrap_mode", "clamp")
    add_value(texture, "boolean", "raw", True)


def _falloff(light: SpotLight, outer: float) -> NDArray[np.float32]:
    """Factors on a plane across the axis, whose edges touch the cone."""
    reach = math.tan(math.radians(outer))
    count = min(_MOST_TEXELS, max(_TEXELS_PER_TANGENT, math.ceil(_TEXELS_PER_TANGENT * reach)))
    x = (2 * (np.arange(count) + 0.5) / count - 1) * reach
    cosines = 1 / np.sqrt(1 + x[:, None] ** 2 + x[None, :] ** 2)
    return spot_factors(light, cosines).astype(np.float32)[:, :, None]
