"""Conversion of a scene to the core's scene."""

from __future__ import annotations

import daguerre._core as _core
from daguerre import memory
from daguerre.checks import as_readonly, short
from daguerre.errors import InputError, UsageError, core_errors
from daguerre.scene.catcher import EFFECTS
from daguerre.scene.motion import Vertices
from daguerre.scene.parts import Curves
from daguerre.scene.scene import Scene

from .media import add_media
from .scene_motion import MovingParts
from .shading import Profiles, add_environment, add_lights, add_materials


def build(
    scene: Scene,
    interval: tuple[float, float] | None = None,
    notes: list[str] | None = None,
) -> _core.Scene:
    """Passes the scene to the core, which checks it and builds the ray tracer.

    Args:
        scene: The scene.
        interval: Exposure interval, s; None: the scene's ``time``.
        notes: List that gets a sentence for each motion that is only approximated, and for fog that
            keeps out light.

    Raises:
        InputError: A part cannot be rendered; the message names it.
    """
    if not isinstance(scene, Scene):
        raise UsageError(f"scene: wanted a Scene, got {short(scene)}")
    with core_errors(InputError, str(scene.path or "scene")):
        builder = _core.SceneBuilder()
        seen = interval or (scene.time, scene.time)
        builder.set_interval(*seen)
        notes = [] if notes is None else notes
        moving = MovingParts(scene, seen, notes)
        _add_all(builder, scene, moving)
        add_media(builder, scene, notes)
        moving.finish()
        free = memory.left_bytes()
        return builder.build(free_memory=0 if free is None else max(free, 1))


def _add_all(builder: _core.SceneBuilder, scene: Scene, moving: MovingParts) -> None:
    for texture in scene.textures:
        pixels = as_readonly(texture.pixels)
        filters = (texture.filter, texture.min_filter)
        builder.add_texture(texture.name, pixels, texture.srgb, *texture.wrap, *filters)
    for i, mesh in enumerate(scene.meshes):
        v = moving.vertices(i)
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
            instance.name, instance.mesh, instance.material, moving.transform(i), moving.shown(i)
        )
        if instance.catcher is not None:
            builder.set_catcher(i, *(effect in instance.catcher for effect in EFFECTS))
    add_lights(builder, scene, moving.interval, profiles)
    add_environment(builder, scene, moving.interval)


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
