"""Reads lights without size: point, spot, distant, goniometric and projection.

One unit of pbrt is 1 cd of a point light where lengths are in metres, and 1 lux of a distant light.

Source: pbrt-v4's user's guide ("Lights"), and ``lights.cpp`` for ``power`` and ``illuminance``.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daguerre.scene.light_profile import LightProfile
from daguerre.scene.lights import DirectionalLight, Light, PointLight
from daguerre.shading.images import Images

from .emission import scaled_by
from .ledger import Ledger
from .octahedral import square_of
from .spectra import Color, Spectra, scaled
from .state import Entity
from .transforms import unit_of

Array = NDArray[np.float64]
#: Steps of the soft edge of a spot light.
_EDGE = 64
#: Smallest step of tables of pictures, degrees, and steps within a pixel of a small picture.
_STEP, _WITHIN = 0.5, 8
_MOST_PICTURES = 256
_ZERO = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Placed:
    """A light and its place: scene from light, rigid, shape (4, 4); it shines along -z."""

    light: Light
    transform: Array


class Lights:
    """Reads lights of a scene.

    Args:
        spectra: Spectra of the scene.
        images: Pictures of the scene.
        axes: Scene from world of pbrt, shape (4, 4).
        version: Version of pbrt, 3 or 4.
        ledger: Counts directives.
    """

    def __init__(
        self, spectra: Spectra, images: Images, axes: Array, version: int, ledger: Ledger
    ) -> None:
        self.spectra, self.images, self.version, self.ledger = spectra, images, version, ledger
        self._axes, self._unit = axes, unit_of(axes)
        self._left = _MOST_PICTURES

    def count(self, entity: Entity) -> None:
        """Counts a light with a picture, and stops at too many."""
        self._left -= 1
        if self._left < 0:
            entity.place.fail(f"too many lights with pictures: the limit is {_MOST_PICTURES}")

    def read(self, entity: Entity) -> list[Placed]:
        """Reads a light; none, and a note: its kind is not supported.

        Raises:
            InputError: A parameter is wrong.
        """
        reader = _KINDS.get(entity.kind)
        if reader is None:
            sentence = f"a LightSource of kind {entity.kind[:40]!r} is left out"
            self.ledger.note(entity.place, sentence)
            return []
        if entity.state.transform.moves:
            self.ledger.notes.add("a moving light stays at its first place, as in pbrt")
        found = reader(self, entity)
        self.ledger.use(entity.place)
        self.ledger.tell_unread(entity.parameters, entity.place, entity.kind)
        return found

    def color(self, entity: Entity, name: str) -> Color:
        """Color and scale of a light."""
        return scaled_by(entity, self.spectra.light(entity.parameters.find(name)), self.spectra)

    def intensity(self, entity: Entity) -> Color:
        """Color of a light without size; ``power`` and all else are factors on it."""
        return scaled(self.color(entity, "I"), self._unit**2)  # so that surfaces get the same light

    def world(self, entity: Entity) -> Array:
        """Scene from the light's space."""
        return np.asarray(self._axes @ entity.state.transform.start)

    def frame(self, world: Array) -> tuple[Array, Array]:
        """Rigid frame of a light, and the light's space from that frame, shape (3, 3)."""
        u, _, v = np.linalg.svd(world[:3, :3])
        ahead = np.diag([1.0, -1.0, -1.0])  # the light's space shines along +z, the frame along -z
        turn, flip = u @ v, np.eye(3)
        if np.linalg.det(turn) < 0:
            flip[0, 0] = -1
            turn = turn @ flip
        rigid = np.eye(4)
        rigid[:3, :3], rigid[:3, 3] = turn @ ahead, world[:3, 3]
        return rigid, flip @ ahead


def _point(lights: Lights, entity: Entity) -> list[Placed]:
    color = lights.intensity(entity)
    power = entity.parameters.number("power", -1.0)
    color = scaled(color, power / (4 * math.pi)) if power > 0 else color
    return [Placed(PointLight(color), _moved(lights.world(entity), _from(entity)))]


def _spot(lights: Lights, entity: Entity) -> list[Placed]:
    color = lights.intensity(entity)
    number = entity.parameters.number
    end = number("coneangle", 30.0, 0.0, 180.0)
    start = end - number("conedeltaangle", 5.0, 0.0)
    start = min(max(start, 0.0), end)
    inner, outer = math.cos(math.radians(start)), math.cos(math.radians(end))
    power = number("power", -1.0)
    if power > 0:
        whole = 2 * math.pi * ((1 - inner) + (inner - outer) / 2)
        color = scaled(color, power / whole) if whole > 0 else _ZERO
    if end <= 0:
        lights.ledger.notes.add("a spot light of angle 0 is left out")
        return []
    world, origin = lights.world(entity), _from(entity)
    ahead = entity.parameters.point("to", (0, 0, 1)) - origin
    light = PointLight(color, profile=_cone(start, end, lights.version))
    return [Placed(light, _aimed(entity, world, origin, ahead))]


def _cone(start: float, end: float, version: int) -> LightProfile:
    """Profile that is 1 up to an angle and falls to 0 at another, by pbrt's function of cosines.

    Args:
        start: Angle at which it begins to fall, degrees.
        end: Angle at which it is 0, degrees.
        version: Version of pbrt; version 3 has the fourth power in place of a smooth step.
    """
    inner, outer = math.cos(math.radians(start)), math.cos(math.radians(end))
    if not inner > outer:
        return LightProfile.table([0.0, end], [1.0, 1.0])
    angles = np.linspace(start, end, _EDGE)
    x = np.clip((np.cos(np.radians(angles)) - outer) / (inner - outer), 0, 1)
    share = x**4 if version == 3 else x * x * (3 - 2 * x)
    begins = [0.0] if start > 0 else []
    return LightProfile.table([*begins, *angles], [1.0 for _ in begins] + share.tolist())


def _distant(lights: Lights, entity: Entity) -> list[Placed]:
    color = lights.color(entity, "L")
    illuminance = entity.parameters.number("illuminance", -1.0)
    color = scaled(color, illuminance) if illuminance > 0 else color
    origin = _from(entity)
    ahead = entity.parameters.point("to", (0, 0, 1)) - origin
    aimed = _aimed(entity, lights.world(entity), origin, ahead)
    return [Placed(DirectionalLight(color), aimed)]


def _goniometric(lights: Lights, entity: Entity) -> list[Placed]:
    color = lights.intensity(entity)
    name = entity.parameters.text("filename") or entity.parameters.text("mapname")
    values = _grey(lights, entity, name)
    power = entity.parameters.number("power", -1.0)
    mean = float(values.mean())
    if power > 0:
        color = scaled(color, power / (4 * math.pi * mean)) if mean > 0 else _ZERO
    rigid, flip = lights.frame(lights.world(entity))
    theta, phi, ways = _directions(180.0, 180.0 / max(values.shape), flip)
    # The map's axis is +y of the light, and its y is the light's z.
    x, y, z = ways[..., 0], ways[..., 2], ways[..., 1]
    height, width = values.shape
    if lights.version == 3:
        s, t = np.mod(np.arctan2(y, x) / (2 * math.pi), 1), np.arccos(np.clip(z, -1, 1)) / math.pi
    else:
        s, t = square_of(np.stack([x, y, z], axis=-1))
    columns = np.clip((s * width).astype(int), 0, width - 1)
    found = values[np.clip((t * height).astype(int), 0, height - 1), columns]
    return [Placed(PointLight(color, profile=LightProfile.table(theta, found, phi)), rigid)]


def _projection(lights: Lights, entity: Entity) -> list[Placed]:
    color = lights.intensity(entity)
    name = entity.parameters.text("filename") or entity.parameters.text("mapname")
    pixels = _picture(lights, entity, name)
    height, width = pixels.shape[:2]
    usual = 45.0 if lights.version == 3 else 90.0
    half = math.tan(math.radians(entity.parameters.number("fov", usual, 0.1, 179.0)) / 2)
    across, down = half * max(width / height, 1), half * max(height / width, 1)
    power = entity.parameters.number("power", -1.0)
    if power > 0:
        color = scaled(color, _power_factor(power, pixels, across, down))
    rigid, flip = lights.frame(lights.world(entity))
    corner = math.degrees(math.atan(math.hypot(across, down)))
    pixel = corner / max(width, height)
    theta, phi, ways = _directions(min(corner + _STEP, 89.5), pixel, flip)
    x, y, z = ways[..., 0], ways[..., 1], np.maximum(ways[..., 2], 1e-9)
    up = 1.0 if lights.version == 3 else -1.0
    s, t = (x / z / across + 1) / 2, (up * y / z / down + 1) / 2
    inside = (s >= 0) & (s < 1) & (t >= 0) & (t < 1)
    columns = np.clip((s * width).astype(int), 0, width - 1)
    values = pixels[np.clip((t * height).astype(int), 0, height - 1), columns] * inside[..., None]
    return [
        Placed(PointLight(primary, profile=LightProfile.table(theta, values[..., i], phi)), rigid)
        for i, primary in enumerate(_primaries(color))
        if max(primary) > 0 and values[..., i].any()
    ]


def _power_factor(power: float, pixels: Array, across: float, down: float) -> float:
    height, width = pixels.shape[:2]
    x = ((np.arange(width) + 0.5) / width * 2 - 1) * across
    y = ((np.arange(height) + 0.5) / height * 2 - 1) * down
    solid = (1 + x[None] ** 2 + y[:, None] ** 2) ** -1.5 * (4 * across * down / pixels[..., 0].size)
    whole = float((pixels @ np.array([0.2126, 0.7152, 0.0722]) * solid).sum())
    return power / whole if whole > 0 else 0.0


def _primaries(color: Color) -> list[Color]:
    return [(color[0], 0.0, 0.0), (0.0, color[1], 0.0), (0.0, 0.0, color[2])]


def _directions(end: float, pixel: float, flip: Array) -> tuple[Array, Array, Array]:
    """Angles of a table, and the directions of a light's own space there, shape (T, P, 3).

    Args:
        end: Largest angle, degrees.
        pixel: Size of a pixel, degrees.
        flip: Own space of the light from its frame.
    """
    step = max(_STEP, pixel / _WITHIN)
    theta = np.linspace(0, end, max(round(end / step), 2) + 1)
    phi = np.linspace(0, 360, round(360 / step) + 1)
    down, around = np.radians(theta)[:, None], np.radians(phi)[None]
    sine = np.sin(down)
    shape = np.broadcast_shapes(down.shape, around.shape)
    parts = (sine * np.cos(around), sine * np.sin(around), -np.cos(down))
    ways = np.stack([np.broadcast_to(part, shape) for part in parts], axis=-1)
    return theta, phi, ways @ flip.T


def _grey(lights: Lights, entity: Entity, name: str) -> Array:
    return np.asarray(_picture(lights, entity, name).mean(axis=2))


def _picture(lights: Lights, entity: Entity, name: str) -> Array:
    """Values of a light's picture, shape (H, W, 3); white without a picture."""
    lights.count(entity)
    picture = lights.images.picture(str(entity.place), name) if name else None
    if picture is None:
        lights.ledger.notes.add("a light without its picture emits equally in all directions")
        return np.ones((1, 1, 3))
    red, green, blue, _ = picture.planes(srgb=picture.pixels.dtype == np.uint8)
    values = np.stack([plane.linear() for plane in (red, green, blue)], axis=2)
    return np.maximum(values, 0).astype(np.float64)


def _from(entity: Entity) -> Array:
    return entity.parameters.point("from", (0, 0, 0))


def _moved(world: Array, origin: Array) -> Array:
    moved = np.eye(4)
    moved[:3, 3] = world[:3, :3] @ origin + world[:3, 3]
    return moved


def _aimed(entity: Entity, world: Array, origin: Array, ahead: Array) -> Array:
    """Rigid frame at ``origin`` with -z along ``ahead``, both in the light's space."""
    way = world[:3, :3] @ ahead
    length = float(np.linalg.norm(way))
    if not length > 0:
        entity.place.fail("from, to: the two points must differ")
    z = -way / length
    other = np.eye(3)[int(np.argmin(np.abs(z)))]
    x = np.cross(other, z)
    x = x / np.linalg.norm(x)
    rigid = _moved(world, origin)
    rigid[:3, 0], rigid[:3, 1], rigid[:3, 2] = x, np.cross(z, x), z
    return rigid


_KINDS: dict[str, Callable[[Lights, Entity], list[Placed]]] = {
    "point": _point,
    "spot": _spot,
    "distant": _distant,
    "goniometric": _goniometric,
    "projection": _projection,
}
