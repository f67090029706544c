"""Materials, lights and the environment in the core's form, over an interval."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core
from daguerre.errors import InputError
from daguerre.motion.resample import resample
from daguerre.motion.values import Dynamic
from daguerre.scene.lights import (
    DirectionalLight,
    Light,
    PointLight,
    SphereLight,
    SpotLight,
    check_light,
)
from daguerre.scene.materials import Material, check_material
from daguerre.scene.parts import Environment
from daguerre.scene.scene import Scene

from .core_materials import common_values, kind_name, kind_values

if TYPE_CHECKING:
    from daguerre.scene.light_profile import LightProfile

Interval = tuple[float, float]
#: Kind of light, and arguments of the core's function for that kind.
CoreLight = tuple[Any, ...]


@dataclass(frozen=True)
class _Seen:
    """A value over time in the form that ``look`` gives it, in which the core interpolates."""

    dynamic: Dynamic
    look: Callable[[Any], Any]

    def at(self, time_s: float) -> Any:
        return self.look(self.dynamic.at(time_s))

    def breaks(self, begin: float, end: float) -> Sequence[float] | NDArray[np.float64]:
        return self.dynamic.breaks(begin, end)


class Profiles:
    """Light profiles of a scene in the core's builder, each once."""

    def __init__(self, builder: _core.SceneBuilder) -> None:
        self._builder = builder
        self._known: dict[LightProfile, int] = {}

    def index(self, profile: LightProfile | None) -> int:
        """Index of a profile in the builder; -1: no profile."""
        if profile is None:
            return -1
        if profile not in self._known:
            self._known[profile] = self._builder.add_profile(profile.core)
        return self._known[profile]


def add_materials(
    builder: _core.SceneBuilder, scene: Scene, interval: Interval, profiles: Profiles
) -> None:
    """Adds all materials; those that change become keys."""
    for i, material in enumerate(scene.materials):
        dynamic = scene.motion.materials.get(i)
        if dynamic is None:
            _add_material(builder, material, profiles)
            continue
        times, values = resample(_Seen(dynamic, _checker(material, i)), *interval)
        for value in values:
            _add_material(builder, value, profiles)
        builder.fold_materials(times)


def add_lights(
    builder: _core.SceneBuilder, scene: Scene, interval: Interval, profiles: Profiles
) -> None:
    """Adds all lights; those that change become keys."""
    for i, (light, transform) in enumerate(scene.lights):
        dynamic = scene.motion.lights.get(i)
        first = _core_light(light, transform)
        if dynamic is None:
            _add_light(builder, first, profiles)
            continue
        times, values = resample(_Seen(dynamic, _light_checker(first[0])), *interval)
        for value in values:
            _add_light(builder, value, profiles)
        builder.fold_lights(times)


def add_environment(builder: _core.SceneBuilder, scene: Scene, interval: Interval) -> None:
    """Adds the environment with its changes."""
    dynamic = scene.motion.environment
    environment = scene.environment if dynamic is None else dynamic.at(interval[0])
    if environment is None:
        return
    if dynamic is not None:
        image = environment.image
        times, poses = resample(_Seen(dynamic, lambda e: _pose(e, image)), *interval)
        if len(times) > 1:
            builder.key_environment(times, poses)
            color = None if environment.color is None else (1.0, 1.0, 1.0)
            environment = dataclasses.replace(environment, color=color, scale=1.0, rotation=0.0)
    _set_environment(builder, environment)


def _pose(environment: Environment, image: object) -> tuple[tuple[float, ...], float]:
    """Factor on the environment's light, and its rotation about +y, rad."""
    if environment.image is not image:
        raise InputError("environment: image: cannot change while the shutter is open")
    color = (1.0, 1.0, 1.0)
    if environment.image is None:
        color = environment.color or (0.0, 0.0, 0.0)
    strength = tuple(float(c) * environment.scale for c in color)
    return strength, math.radians(environment.rotation)


def _checker(first: Material, index: int) -> Callable[[Any], Material]:
    where = f"material {first.name!r}" if first.name else f"material {index}"
    kind = type(first.kind)

    def checked(material: Any) -> Material:
        check_material(material, where)
        if not isinstance(material.kind, kind):
            raise InputError(
                f"{where}: kind: cannot change while the shutter is open, from {kind.__name__} to "
                f"{type(material.kind).__name__}"
            )
        return material  # type: ignore[no-any-return]

    return checked


def _light_checker(kind: str) -> Callable[[Any], CoreLight]:
    def checked(placed: Any) -> CoreLight:
        light, transform = placed
        core = _core_light(light, transform)
        if core[0] != kind:
            raise InputError(
                f"light {light.name!r}: kind: cannot change while the shutter is open, from "
                f"{kind} to {core[0]}"
            )
        return core

    return checked


def _add_material(builder: _core.SceneBuilder, material: Material, profiles: Profiles) -> None:
    kind, common = material.kind, common_values(material, profiles.index(material.profile))
    builder.add_material(material.name, kind_name(kind), kind_values(kind), common)


def _add_light(builder: _core.SceneBuilder, light: CoreLight, profiles: Profiles) -> None:
    kind, *values = light
    if kind in ("point", "sphere"):
        profile, *axes = values[-1]
        values[-1] = (profiles.index(profile), *axes)
    getattr(builder, f"add_{kind}_light")(*values)


def _core_light(light: Light, transform: NDArray[np.float64]) -> CoreLight:
    check_light(light)
    position = tuple(float(x) for x in transform[:3, 3])
    shines = -transform[:3, 2]
    length = float(np.linalg.norm(shines))
    if not length > 0:
        raise InputError(f"light {light.name!r}: transform: wanted a direction, got a zero axis")
    direction = tuple(float(x) for x in shines / length)
    if isinstance(light, PointLight) and light.radius > 0:
        # A ball of luminance L has the intensity L pi r^2 seen from afar.
        luminance = tuple(c / (math.pi * light.radius**2) for c in light.intensity)
        return "sphere", position, light.radius, luminance, _lamp(light, transform)
    if isinstance(light, PointLight):
        return "point", position, light.intensity, light.range, _lamp(light, transform)
    if isinstance(light, SpotLight):
        cone = math.radians(light.inner_angle), math.radians(light.outer_angle)
        return "spot", position, direction, light.intensity, *cone, light.range
    if isinstance(light, DirectionalLight):
        return "directional", direction, light.illuminance, math.radians(light.angle)
    if isinstance(light, SphereLight):
        return "sphere", position, light.radius, light.luminance, _lamp(light, transform)
    raise InputError(f"light: wanted a point, spot, directional or sphere light, got {light!r}")


def _lamp(light: PointLight | SphereLight, transform: NDArray[np.float64]) -> tuple[Any, ...]:
    """Profile and axes of a lamp; without a profile it may turn as it likes."""
    turned = np.eye(3) if light.profile is None else transform[:3, :3]
    return light.profile, *(tuple(float(x) for x in axis) for axis in turned.T)


def _set_environment(builder: _core.SceneBuilder, environment: Environment) -> None:
    if environment.image is None:
        color = environment.color or (0.0, 0.0, 0.0)
        builder.set_environment_color(tuple(c * environment.scale for c in color))
        return
    angle = math.radians(environment.rotation)
    matrix = np.eye(4)
    matrix[0, 0] = matrix[2, 2] = math.cos(angle)
    matrix[0, 2], matrix[2, 0] = math.sin(angle), -math.sin(angle)
    builder.set_environment_image(environment.image, environment.scale, matrix)
