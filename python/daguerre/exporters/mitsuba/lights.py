"""Lamps and the environment as emitters of Mitsuba."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.exporters.outgoing.folder import OutgoingFolder
from daguerre.exporters.outgoing.lamps import plain, reach_of, spot_factors, turned
from daguerre.exporters.outgoing.picture_file import write_pixels
from daguerre.exporters.outgoing.pictures import BLACK
from daguerre.files.notes import Notes
from daguerre.scene.lights import DirectionalLight, Light, PointLight, SphereLight, SpotLight
from daguerre.scene.parts import Environment

from .scene_xml import Element, add, add_matrix, add_point, add_rgb, add_value

#: Widest half angle of a spot light, degrees: its falloff is a picture on a plane across its axis.
_WIDEST = 85.0
_NARROWEST = 0.05
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
        lamp = plain(light, notes)
        if isinstance(lamp, SphereLight):
            _add_ball(root, lamp, transform)
        elif isinstance(lamp, DirectionalLight):
            emitter = add(root, "emitter", type="directional")
            add_point(emitter, "vector", "direction", -turned(transform, "-z")[:3, 2])
            add_rgb(emitter, "irradiance", lamp.illuminance)
        elif isinstance(lamp, SpotLight):
            _add_spot(root, lamp, transform, folder, notes)
        else:
            _add_point_lamp(root, lamp, transform, folder, notes)


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


def _add_point_lamp(
    root: Element, light: PointLight, transform: Array, folder: OutgoingFolder, notes: Notes
) -> None:
    """Adds a point lamp; a profile within a cone becomes a spot light with a picture."""
    if light.profile is not None:
        outer = reach_of(light.profile)
        if outer <= _WIDEST:
            beam = _Beam(light.intensity, max(outer, _NARROWEST), transform)
            beam.add(root, light.profile.factors(beam.directions().reshape(-1, 3)), folder)
            return
        notes.add("light profile of a point light is left out: it emits equally in all directions")
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
    beam = _Beam(light.intensity, outer, transform)
    ways = beam.directions()
    cosines = -ways[..., 2] / np.linalg.norm(ways, axis=-1)
    beam.add(root, spot_factors(light, cosines).reshape(-1, 1), folder)


@dataclass(frozen=True)
class _Beam:
    """A spot light of Mitsuba with its falloff as a picture on a plane across its axis.

    Attributes:
        intensity: Intensity, cd, at a factor of 1.
        outer: Half angle of the cone around its light, degrees; the picture's edges touch it.
        transform: World from lamp, shape (4, 4).
    """

    intensity: tuple[float, float, float]
    outer: float
    transform: Array

    @property
    def _count(self) -> int:
        reach = math.tan(math.radians(self.outer))
        wanted = max(_TEXELS_PER_TANGENT, math.ceil(_TEXELS_PER_TANGENT * reach))
        return min(_MOST_TEXELS, wanted)

    def directions(self) -> Array:
        """Directions of the texels in the lamp's frame, of any length, shape (N, N, 3)."""
        count = self._count
        x = (2 * (np.arange(count) + 0.5) / count - 1) * math.tan(math.radians(self.outer))
        plane = np.stack([*np.meshgrid(x, x), np.ones((count, count))], axis=-1)
        lamp = self.transform[:3, :3] / np.linalg.norm(self.transform[:3, :3], axis=0)
        return np.asarray(plane @ turned(self.transform, "+z")[:3, :3].T @ lamp)

    def add(self, root: Element, factors: NDArray[Any], folder: OutgoingFolder) -> None:
        """Adds the light; ``factors`` on its intensity by texel, shape (N * N, 1 or 3)."""
        count = self._count
        emitter = add(root, "emitter", type="spot")
        add_matrix(emitter, "to_world", turned(self.transform, "+z"))
        add_rgb(emitter, "intensity", self.intensity)
        add_value(emitter, "float", "cutoff_angle", self.outer)
        add_value(emitter, "float", "beam_width", self.outer - _EDGE)
        texture = add(emitter, "texture", type="bitmap", name="texture")
        pixels = factors.astype(np.float32).reshape(count, count, -1)
        add_value(texture, "string", "filename", write_pixels(folder, "lamp", pixels))
        add_value(texture, "string", "wrap_mode", "clamp")
        add_value(texture, "boolean", "raw", True)
