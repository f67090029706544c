"""Draws the nodes of a world by Cycles into a panorama, in a scene of its own.

Blender draws one picture at a time: while it draws, as on F12, nothing can be baked. So panoramas
are kept; the extension bakes before it draws.
"""

from __future__ import annotations

import contextlib
import math
import os
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daguerre.files.notes import Notes

from .pictures import Picture, pixels_of

if TYPE_CHECKING:
    import bpy


#: Width and height of a panorama, and samples of a pixel.
SIZE, _SAMPLES = (1024, 512), 16
_KEPT: dict[str, Picture] = {}


def baked(world: bpy.types.World, notes: Notes) -> Picture | None:
    """Panorama of a world, shape (H, W, 3), -z of the scene at its centre; None, with a note.

    Args:
        world: World of any nodes, evaluated or not.
        notes: Receives notes.
    """
    try:
        picture = bake(world)
    except RuntimeError:
        kept = _KEPT.get(world.name_full)
        if kept is None:
            names = ", ".join(sorted({node.bl_label for node in world.node_tree.nodes}))
            notes.add(f"a world with other nodes is black, as it cannot be baked now: {names}")
        return kept
    notes.add(
        f"nodes of a world are baked to {SIZE[0]} x {SIZE[1]} pixels, as the camera sees them"
    )
    return picture


def bake(world: bpy.types.World, size: tuple[int, int] = SIZE) -> Picture:
    """Draws a world and keeps the panorama.

    Raises:
        RuntimeError: Blender is drawing already.
    """
    with _scene_of(world, size) as (scene, path):
        import bpy

        bpy.ops.render.render(write_still=True, scene=scene.name)
        picture = _read(path)
    _KEPT[world.name_full] = picture
    return picture


def _read(path: Path) -> Picture:
    """Reads a panorama; by Blender, as parts of a colour may be below 0."""
    import bpy

    image = bpy.data.images.load(str(path))
    try:
        picture = pixels_of(image)
    finally:
        bpy.data.images.remove(image)
    if picture is None:
        raise RuntimeError("Blender wrote no picture")
    return picture


@contextlib.contextmanager
def _scene_of(world: bpy.types.World, size: tuple[int, int]) -> Iterator[tuple[Any, Path]]:
    """A scene that draws a world into a file; both are removed in the end."""
    import bpy

    handle, name = tempfile.mkstemp(suffix=".exr")
    os.close(handle)
    scene = bpy.data.scenes.new("Daguerre world")
    data = bpy.data.cameras.new("Daguerre world")
    eye = bpy.data.objects.new("Daguerre world", data)
    try:
        data.type, data.panorama_type = "PANO", "EQUIRECTANGULAR"
        eye.rotation_euler = (math.pi / 2, 0.0, 0.0)  # it looks along +y
        scene.collection.objects.link(eye)
        scene.camera, scene.world = eye, world.original
        _set_up(scene, size, name)
        yield scene, Path(name)
    finally:
        bpy.data.scenes.remove(scene)
        bpy.data.objects.remove(eye)
        bpy.data.cameras.remove(data)
        Path(name).unlink(missing_ok=True)


def _set_up(scene: bpy.types.Scene, size: tuple[int, int], name: str) -> None:
    render, cycles = scene.render, scene.cycles
    render.engine, cycles.device = "CYCLES", "CPU"
    cycles.samples, cycles.use_adaptive_sampling = _SAMPLES, False
    cycles.use_denoising = False
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 1.0
    render.resolution_x, render.resolution_y = size
    render.resolution_percentage = 100
    render.use_compositing = render.use_sequencer = False
    render.image_settings.file_format = "OPEN_EXR"
    render.image_settings.color_depth = "32"
    render.filepath = name
