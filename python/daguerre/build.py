"""From the scene's arrays to the core's scene, and a hash of what was handed over."""

from __future__ import annotations

import dataclasses
import hashlib
import math
from typing import Any

import numpy as np

import daguerre._core as _core

from .build_motion import Moving
from .checks import frozen, short
from .errors import DaguerreError, InputError, UsageError
from .lights import DirectionalLight, PointLight, SphereLight, SpotLight
from .materials import Conductor, Dielectric, Diffuse, Gltf, Material, TextureSlot
from .pieces import samples
from .scene import Environment, Scene


def build(
    scene: Scene,
    interval: tuple[float, float] | None = None,
    notes: list[str] | None = None,
) -> _core.Scene:
    """Hands the scene to the core, which checks it and builds the ray tracer.

    Args:
        scene: What is seen.
        interval: When it is seen, s; None: at its ``time``.
        notes: Is told what moves in a way that cannot be shown to its end.

    Raises:
        InputError: Some part cannot be rendered; the message names it.
    """
    if not isinstance(scene, Scene):
        raise UsageError(f"scene: wanted a Scene, got {short(scene)}")
    try:
        builder = _core.SceneBuilder()
        seen = interval or (scene.time, scene.time)
        builder.set_interval(*seen)
        _add_all(builder, scene, Moving(scene, seen, [] if notes is None else notes))
        return builder.build()
    except ValueError as error:
        if isinstance(error, DaguerreError):
            raise
        raise InputError(f"{scene.path or 'scene'}: {error}") from None


def _add_all(builder: _core.SceneBuilder, scene: Scene, moving: Moving) -> None:
    for texture in scene.textures:
        pixels = frozen(texture.pixels)
        filters = (texture.filter, texture.min_filter)
        builder.add_texture(texture.name, pixels, texture.srgb, *texture.wrap, *filters)
    for i, mesh in enumerate(scene.meshes):
        v = moving.vertices(i)
        optional = (v.normals, v.uv, v.uv1, v.tangents, v.colors)
        builder.add_mesh(
            mesh.name,
            frozen(v.positions),
            frozen(mesh.indices),
            *(None if values is None else frozen(values) for values in optional),
        )
    for material in scene.materials:
        _add_material(builder, material)
    for i, instance in enumerate(scene.instances):
        builder.add_instance(
            instance.name, instance.mesh, instance.material, moving.transform(i), moving.shown(i)
        )
    for light, transform in scene.lights:
        _add_light(builder, light, transform)
    if scene.environment is not None:
        _set_environment(builder, scene.environment)


def _slot(slot: TextureSlot | None) -> tuple[Any, ...] | None:
    return None if slot is None else (slot.texture, slot.uv_set, tuple(slot.transform))


def _add_material(builder: _core.SceneBuilder, material: Material) -> None:
    kind, rest = material.kind, (material.emission, material.two_sided_emission)
    if isinstance(kind, Diffuse):
        builder.add_diffuse(material.name, kind.reflectance, *rest)
    elif isinstance(kind, Conductor):
        builder.add_conductor(material.name, kind.reflectance, kind.alpha, *rest)
    elif isinstance(kind, Dielectric):
        builder.add_dielectric(
            material.name, kind.ior, kind.alpha, kind.tint, kind.dispersion, *rest
        )
    elif isinstance(kind, Gltf):
        values = {f.name: getattr(kind, f.name) for f in dataclasses.fields(kind)}
        for name, value in values.items():
            if name.endswith("_texture"):
                values[name] = _slot(value)
        values["anisotropy_rotation"] = math.radians(kind.anisotropy_rotation)
        builder.add_gltf(material.name, values, *rest)
    else:
        raise InputError(
            f"material {material.name!r}: kind: wanted Diffuse, Conductor, Dielectric or Gltf, "
            f"got {type(kind).__name__}"
        )


def _add_light(builder: _core.SceneBuilder, light: Any, transform: np.ndarray) -> None:
    position = tuple(transform[:3, 3])
    shines = -transform[:3, 2]
    length = float(np.linalg.norm(shines))
    if not length > 0:
        raise InputError(f"light {light.name!r}: transform: wanted a direction, got a zero axis")
    direction = tuple(shines / length)
    if isinstance(light, PointLight) and light.radius > 0:
        # A ball of luminance L has the intensity L pi r^2 seen from afar.
        luminance = tuple(c / (math.pi * light.radius**2) for c in light.intensity)
        builder.add_sphere_light(position, light.radius, luminance)
    elif isinstance(light, PointLight):
        builder.add_point_light(position, light.intensity, light.range)
    elif isinstance(light, SpotLight):
        builder.add_spot_light(
            position,
            direction,
            light.intensity,
            math.radians(light.inner_angle),
            math.radians(light.outer_angle),
            light.range,
        )
    elif isinstance(light, DirectionalLight):
        builder.add_directional_light(direction, light.illuminance)
    elif isinstance(light, SphereLight):
        builder.add_sphere_light(position, light.radius, light.luminance)
    else:
        raise InputError(f"light: wanted a point, spot, directional or sphere light, got {light!r}")


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


def content_hash(scene: Scene, interval: tuple[float, float] | None = None) -> str:
    """SHA-256 of everything that the picture can depend on.

    Args:
        scene: What is seen.
        interval: When it is seen, s; what moves is looked at its ends, its keys and in between.
    """
    digest = hashlib.sha256()

    def add(value: Any) -> None:
        if isinstance(value, np.ndarray):
            digest.update(f"{value.dtype}{value.shape}".encode())
            digest.update(np.ascontiguousarray(value).data)
        elif dataclasses.is_dataclass(value):
            for field in dataclasses.fields(value):
                digest.update(field.name.encode())
                add(getattr(value, field.name))
        elif isinstance(value, (list, tuple)):
            digest.update(f"[{len(value)}".encode())
            for item in value:
                add(item)
        else:
            digest.update(repr(value).encode())

    for part in (
        scene.meshes,
        scene.textures,
        scene.materials,
        scene.instances,
        scene.lights,
        scene.environment,
    ):
        add(part)
    if interval is not None:
        for where, dynamic in scene.motion.parts():
            add(where)
            add(samples(dynamic, *interval))
    return digest.hexdigest()
