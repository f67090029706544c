"""Conversion of a scene to the core's scene."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import daguerre._core as _core
from daguerre import memory
from daguerre.checks import as_readonly, freeze_in_place, short
from daguerre.errors import InputError, UsageError, core_errors
from daguerre.scene.catcher import EFFECTS
from daguerre.scene.far import ZERO, Place
from daguerre.scene.motion import Vertices
from daguerre.scene.parts import Curves
from daguerre.scene.scene import Scene

from .media import add_media
from .nesting import add_nesting, overlap_warnings
from .origin import beyond, coarse, local_origin, may_be_far
from .scene_motion import MovingParts
from .shading import Profiles, add_environment, add_lights, add_materials


def build(
    scene: Scene,
    interval: tuple[float, float] | None = None,
    notes: list[str] | None = None,
    origin: Place = ZERO,
) -> _core.Scene:
    """Passes the scene to the core, which checks it and builds the ray tracer.

    Args:
        scene: The scene.
        interval: Exposure interval, s; None: the scene's ``time``.
        notes: List that gets a sentence for each motion that is only approximated, for fog that
            keeps out light, and for solids that overlap in an unclear order.
        origin: Origin of the core's scene in the world, m (:mod:`.origin`).

    Raises:
        InputError: A part cannot be rendered; the message names it.
    """
    if not isinstance(scene, Scene):
        raise UsageError(f"scene: wanted a Scene, got {short(scene)}")
    with core_errors(InputError, str(scene.path or "scene")):
        builder = _core.SceneBuilder(origin)
        seen = interval or (scene.time, scene.time)
        builder.set_interval(*seen)
        notes = [] if notes is None else notes
        notes += beyond(origin)
        moving = MovingParts(scene, seen, notes)
        _add_all(builder, scene, moving)
        add_media(builder, scene, notes)
        add_nesting(builder, scene)
        moving.finish()
        free = memory.left_bytes()
        made = builder.build(free_memory=0 if free is None else max(free, 1))
        notes += overlap_warnings(scene, made)
        return made


def _add_all(builder: _core.SceneBuilder, scene: Scene, moving: MovingParts) -> None:
    for texture in scene.textures:
        pixels = as_readonly(texture.pixels)
        filters = (texture.filter, texture.min_filter)
        builder.add_texture(texture.name, pixels, texture.srgb, *texture.wrap, *filters)
    local_origins = _local_origins(scene, moving.notes)
    for i, mesh in enumerate(scene.meshes):
        v = moving.vertices(i)
        if i in local_origins and not any(mesh.origin):
            moved = v.positions - np.array(local_origins[i], np.float32)
            v = replace(v, positions=freeze_in_place(moved))
        if isinstance(mesh, Curves):
            _add_curves(builder, mesh, v)
            continue
        optional = (v.normals, v.uv, v.uv1, v.tangents, v.colors)
        builder.add_mesh(
            mesh.name,
            as_readonly(v.positions),
            as_readonly(mesh.indices),
            *(None if values is None else as_readonly(values) for values in optional),
        )
    profiles = Profiles(builder)
    add_materials(builder, scene, moving.interval, profiles)
    for i, instance in enumerate(scene.instances):
        builder.add_instance(
            instance.name,
            instance.mesh,
            instance.material,
            moving.transform(i),
            moving.shown(i),
            local_origins.get(instance.mesh, ZERO),
        )
        if instance.catcher is not None:
            builder.set_catcher(i, *(effect in instance.catcher for effect in EFFECTS))
    add_lights(builder, scene, moving.interval, profiles)
    add_environment(builder, scene, moving.interval)


def _local_origins(scene: Scene, notes: list[str]) -> dict[int, Place]:
    """Origins of meshes that are far from that of their space, by index.

    Args:
        scene: The scene.
        notes: List that gets a sentence for each mesh with vertices that a file has rounded.
    """
    found = {i: mesh.origin for i, mesh in enumerate(scene.meshes) if any(mesh.origin)}
    near = (i for i in range(len(scene.meshes)) if i not in found)
    sizes = {i: 0.0 for i in near if may_be_far(scene.meshes[i].positions)}
    for instance in scene.instances if sizes else ():
        if instance.mesh in sizes:
            axes = np.asarray(instance.transform, np.float64)[:3, :3]
            size = float(np.linalg.norm(axes, axis=0).max())
            sizes[instance.mesh] = max(sizes[instance.mesh], size)
    for i, size in sizes.items():
        mesh = scene.meshes[i]
        place = local_origin(mesh.positions, size)
        if any(place):
            found[i] = place
            note = coarse(place, size)
            notes += [f"mesh {mesh.name or i!r}: {note}"] if note else []
    return found


def _add_curves(builder: _core.SceneBuilder, curves: Curves, vertices: Vertices) -> None:
    values = (vertices.uv, vertices.colors)
    builder.add_curves(
        curves.name,
        as_readonly(vertices.positions),
        as_readonly(curves.radii),
        as_readonly(curves.starts),
        as_readonly(curves.ends),
        (curves.cubic, curves.closed),
        *(None if rows is None else as_readonly(rows) for rows in values),
    )
