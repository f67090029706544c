"""Cycles' side of ``bench/ajar.py``: bpy, no adaptive sampling, no clamp, no denoiser."""

from __future__ import annotations

from typing import Any

import bpy  # type: ignore[import-not-found]
import mathutils  # type: ignore[import-not-found]
import numpy as np
import room
from side import DEPTH, answer, arguments, cpu_seconds


def nodes_of(owner: Any) -> Any:
    """An empty node tree, and its function that adds a node."""
    owner.use_nodes = True
    owner.node_tree.nodes.clear()
    return owner.node_tree


def material(name: str) -> Any:
    """One of the room's materials."""
    kind, color = room.MATERIALS[name]
    made = bpy.data.materials.new(name)
    tree = nodes_of(made)
    if kind == "diffuse":
        node = tree.nodes.new("ShaderNodeBsdfDiffuse")
        node.inputs["Roughness"].default_value = 0
    else:
        node = tree.nodes.new("ShaderNodeBsdfAnisotropic")
        node.distribution = "GGX"
        node.inputs["Roughness"].default_value = room.ALPHA**0.5
    node.inputs["Color"].default_value = (*color, 1)
    out = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(node.outputs[0], out.inputs[0])
    return made


def shining() -> Any:
    """The lamp, black from behind."""
    made = bpy.data.materials.new("lamp")
    tree = nodes_of(made)
    light, dark = (tree.nodes.new(f"ShaderNode{n}") for n in ("Emission", "BsdfDiffuse"))
    peak = max(room.LAMP["radiance"])
    light.inputs[0].default_value = (*(c / peak for c in room.LAMP["radiance"]), 1)
    light.inputs[1].default_value = peak
    dark.inputs[0].default_value = (0, 0, 0, 1)
    back, mix = (tree.nodes.new(f"ShaderNode{n}") for n in ("NewGeometry", "MixShader"))
    out = tree.nodes.new("ShaderNodeOutputMaterial")
    for source, target in (
        (back.outputs["Backfacing"], mix.inputs[0]),
        (light.outputs[0], mix.inputs[1]),
        (dark.outputs[0], mix.inputs[2]),
        (mix.outputs[0], out.inputs[0]),
    ):
        tree.links.new(source, target)
    made.cycles.emission_sampling = "FRONT"
    return made


def add(name: str, shape: room.Mesh, matter: Any) -> None:
    """A mesh with flat faces."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([tuple(p) for p in shape[0]], [], [tuple(map(int, f)) for f in shape[1]])
    mesh.update()
    mesh.materials.append(matter)
    bpy.context.scene.collection.objects.link(bpy.data.objects.new(name, mesh))


def set_camera(scene: Any) -> None:
    """A thin lens on 36 mm."""
    data = bpy.data.cameras.new("camera")
    data.lens, data.sensor_width, data.sensor_fit = room.CAMERA["focal_mm"], 36, "HORIZONTAL"
    data.clip_start, data.clip_end = 0.01, 1000
    data.dof.use_dof = True
    data.dof.focus_distance = room.focus_distance()
    data.dof.aperture_fstop = room.CAMERA["f_stop"]
    scene.camera = bpy.data.objects.new("camera", data)
    scene.collection.objects.link(scene.camera)
    scene.camera.matrix_world = mathutils.Matrix(room.camera_matrix().tolist())


def set_render(scene: Any, options: Any) -> None:
    """An even path tracer that writes its samples as they are."""
    cycles = scene.cycles
    scene.render.engine = "CYCLES"
    cycles.device, cycles.samples, cycles.seed = "CPU", options.spp, options.seed
    cycles.use_adaptive_sampling = cycles.use_denoising = cycles.use_auto_tile = False
    cycles.max_bounces = DEPTH - 1
    for kind in ("diffuse", "glossy", "transmission"):
        setattr(cycles, f"{kind}_bounces", DEPTH - 1)
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0
    cycles.pixel_filter_type = "BOX"
    render = scene.render
    render.threads_mode, render.threads = "FIXED", options.threads
    render.resolution_x, render.resolution_y = options.w, options.h
    scene.view_settings.view_transform = "Raw"
    image = render.image_settings
    image.file_format, image.color_depth, image.color_mode = "OPEN_EXR", "32", "RGB"
    render.filepath = str(options.out.resolve().with_suffix(".exr"))
    world = bpy.data.worlds.new("dark")
    scene.world = world
    tree = nodes_of(world)
    sky, out = (tree.nodes.new(f"ShaderNode{n}") for n in ("Background", "OutputWorld"))
    sky.inputs[1].default_value = 0
    tree.links.new(sky.outputs[0], out.inputs[0])


def main() -> None:
    """Renders once and reports."""
    options = arguments()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    matter = {name: material(name) for name in room.MATERIALS}
    for name, (shape, wanted) in room.build().items():
        add(name, shape, matter[wanted])
    add("lamp", room.lamp(), shining())
    set_camera(scene)
    set_render(scene, options)
    before = cpu_seconds()
    bpy.ops.render.render(write_still=True)
    cpu = cpu_seconds() - before
    image = bpy.data.images.load(scene.render.filepath)
    image.colorspace_settings.name = "Non-Color"
    texels = np.empty(options.w * options.h * image.channels, np.float32)
    image.pixels.foreach_get(texels)
    picture = texels.reshape(options.h, options.w, image.channels)[::-1, :, :3]
    answer(options.out, picture, f"cycles {bpy.app.version_string}", cpu)


if __name__ == "__main__":
    main()
