"""Lights without a shape, and the sky: points, spots, directions, constants, panoramas.

Source: Mitsuba 3, documentation of emitters. Its lights shine along +z, ours along -z.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import asked_by
from daguerre.pictures.light import read_environment
from daguerre.scene.light_profile import LightProfile
from daguerre.scene.lights import Color, DirectionalLight, PointLight
from daguerre.shading.channels import Texel, Value

from .context import Context
from .node import Node, leave_out
from .panorama import panorama
from .projections import Shine, lamps, looked_up
from .sensors import field_of_view
from .spectra import PLUGINS, emitted_rgb
from .textures import Textures
from .transforms import TURN, frame, mirrors, orthogonal

Array = NDArray[np.float64]
Matrix = Array


class Emitters:
    """Lights of a scene file.

    Args:
        context: File, scene, unit and notes.
        textures: Reads colours.
    """

    def __init__(self, context: Context, textures: Textures) -> None:
        self._context, self._textures = context, textures
        self._document, self._scene = context.document, context.scene
        self._world, self._notes = context.world, context.notes
        self._metres = context.unit_m

    def add(self, node: Node) -> None:
        """Adds a light, or notes that it is left out."""
        read = _PLUGINS.get(node.plugin)
        if read is None:
            leave_out(node, self._notes, f"an emitter {node.plugin[:40]!r} is left out")
            return
        node.use()
        node.skip("sampling_weight")
        read(self, node)

    def _intensity(self, node: Node, name: str, per: float = 1.0) -> Color:
        """Light of a property; ``per``: area of a unit of the scene, for intensities."""
        r, g, b = emitted_rgb(self._textures.color(node, name, 1.0))
        return r * per, g * per, b * per

    def _point(self, node: Node) -> None:
        place = self._world @ node.transform()
        if node.has("position"):
            if node.has("to_world"):
                node.fail("set either position or to_world, not both")
            place = self._world.copy()
            place[:3, 3] = self._world[:3, :3] @ node.vector("position", (0, 0, 0))
        pose = np.eye(4)
        pose[:3, 3] = place[:3, 3]
        light = PointLight(self._intensity(node, "intensity", self._metres**2), name=node.id)
        self._scene.add_light(light, pose)

    def _spot(self, node: Node) -> None:
        """Even within the beam; falls off linearly by angle to the cutoff."""
        cutoff = node.number("cutoff_angle", 20.0, above=0)
        beam = node.number("beam_width", 0.75 * cutoff, 0.0)
        if not beam <= cutoff < 90:
            node.fail(f"wanted beam_width <= cutoff_angle < 90 degrees, got {beam:g}, {cutoff:g}")
        intensity = self._intensity(node, "intensity", self._metres**2)
        picture = self._picture(node, "texture")
        if picture is None:
            light = PointLight(intensity, name=node.id, profile=_cone(beam, cutoff))
            self._scene.add_light(light, self._pose(node)[0])
            return
        self._project(node, _spotlight(picture, intensity, beam, cutoff), math.radians(cutoff))

    def _projector(self, node: Node) -> None:
        """Irradiance of a plane that faces it, at a distance of 1."""
        picture = self._picture(node, "irradiance")
        aspect = 1.0
        if picture is None:
            picture = emitted_rgb(self._textures.color(node, "irradiance", 1.0))
        elif isinstance(picture[0], Texel):
            rows, columns = picture[0].plane.pixels.shape
            aspect = columns / rows
        half = math.tan(field_of_view(node, aspect) / 2)
        scale = node.number("scale", 1.0, 0.0) * math.pi * self._metres**2
        widest = math.atan(half * math.hypot(1, 1 / aspect))
        self._project(node, _slide(picture, scale, half, aspect), widest)

    def _picture(self, node: Node, name: str) -> Value | None:
        """Channels of a texture that is projected; None: no texture."""
        found = node.find(name)
        if found is None or not isinstance(found.value, Node) or found.value.plugin in PLUGINS:
            return None
        found.take()
        return self._textures.texture_of(found.value)

    def _project(self, node: Node, shine: Shine, widest: float) -> None:
        """Adds lamps that project a picture."""
        pose, mirrored = self._pose(node)
        projected = _mirror_image(shine) if mirrored else shine
        for intensity, profile in lamps(projected, widest):
            light = PointLight(intensity, name=node.id, profile=profile)
            self._scene.add_light(light, pose)
        self._notes.add("edges of a projected picture are softened by 1/640 of its angle")

    def _directional(self, node: Node) -> None:
        if node.has("direction"):
            direction = node.vector("direction", (0, 0, 1))
            length = float(np.linalg.norm(direction))
            if not 0 < length < math.inf:
                node.fail("the direction must not have zero length")
            pose = np.eye(4)
            pose[:3, :3] = frame(-self._axes() @ direction / length)
        else:
            pose, _ = self._pose(node)
            pose[:3, 3] = 0
        light = DirectionalLight(self._intensity(node, "irradiance"), name=node.id)
        self._scene.add_light(light, pose)

    def _pose(self, node: Node) -> tuple[Matrix, bool]:
        """Scene from a lamp, rigid, and whether it mirrored the lamp's picture before."""
        made = orthogonal(self._world @ node.transform(), node)
        mirrored = mirrors(made)
        if mirrored:
            made[:3, 0] *= -1
        return made @ TURN, mirrored

    def _axes(self) -> Matrix:
        """Directions in the scene from directions in the file, orthogonal, shape (3, 3)."""
        return self._world[:3, :3] / self._metres

    # The sky --------------------------------------------------------------------------------------

    def _constant(self, node: Node) -> None:
        self._check_only(node)
        self._scene.set_environment(color=self._intensity(node, "radiance"))

    def _envmap(self, node: Node) -> None:
        self._check_only(node)
        file = self._document.files_of(node).find(node.text("filename"), node.entry)
        node.skip("mis_compensation", "gamma", "cache")
        scale = node.number("scale", 1.0, 0.0)
        turn = orthogonal(self._world @ node.transform(), node)[:3, :3]
        if file is None:
            missing = "an environment whose picture is missing is left out"
            self._notes.add(missing, name=node.text("filename"))
            return
        with asked_by(node.entry):
            picture = read_environment(file, self._notes)
        pixels, rotation = panorama(picture, turn)
        self._scene.set_environment(pixels, scale=scale, rotation=rotation)

    def _check_only(self, node: Node) -> None:
        if self._scene.environment is not None:
            node.fail("a second environment: only one is allowed")


def _mirror_image(shine: Shine) -> Shine:
    """The same with left and right exchanged."""
    return lambda x, y, z: shine(-x, y, z)


def _cone(beam: float, cutoff: float) -> LightProfile:
    """Profile of a spot light."""
    if beam == cutoff:
        return LightProfile.table([0.0, cutoff], [1.0, 1.0])
    if beam == 0:
        return LightProfile.table([0.0, cutoff], [1.0, 0.0])
    return LightProfile.table([0.0, beam, cutoff], [1.0, 1.0, 0.0])


def _spotlight(picture: Value, intensity: Color, beam: float, cutoff: float) -> Shine:
    """Intensity of a spot light that projects a picture."""
    reach = math.tan(math.radians(cutoff))

    def shine(x: Array, y: Array, z: Array) -> Array:
        depth = np.maximum(z, 1e-9) * reach
        colors = looked_up(picture, 0.5 + 0.5 * x / depth, 0.5 + 0.5 * y / depth)
        angle = np.degrees(np.arctan2(np.hypot(x, y), z))
        width = max(cutoff - beam, 1e-9)
        falloff = np.clip((cutoff - angle) / width, 0, 1) * (angle < cutoff)
        return np.asarray(colors * np.asarray(intensity) * falloff[:, None])

    return shine


def _slide(picture: Value, scale: float, half: float, aspect: float) -> Shine:
    """Intensity of a projector; a plane across its axis is lit as the picture says."""

    def shine(x: Array, y: Array, z: Array) -> Array:
        depth = np.maximum(z, 1e-9)
        u, v = 0.5 - 0.5 * x / (depth * half), 0.5 - 0.5 * aspect * y / (depth * half)
        inside = (u >= 0) & (u <= 1) & (v >= 0) & (v <= 1) & (z > 0)
        return np.asarray(looked_up(picture, u, v) * (scale * inside / depth**3)[:, None])

    return shine


_PLUGINS: dict[str, Callable[[Emitters, Node], None]] = {
    "point": Emitters._point,
    "spot": Emitters._spot,
    "projector": Emitters._projector,
    "directional": Emitters._directional,
    "constant": Emitters._constant,
    "envmap": Emitters._envmap,
}
