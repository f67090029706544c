"""Small pictures by Blender's Cycles, in this process; tests that import this skip without bpy."""

import tempfile
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest

bpy = pytest.importorskip("bpy", reason="needs Blender as a module, bpy")


def empty(resolution=(16, 16), samples=64):
    """An empty scene of Blender with a black world that Cycles draws without noise reduction."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine, scene.cycles.device = "CYCLES", "CPU"
    scene.cycles.samples, scene.cycles.use_adaptive_sampling = samples, False
    scene.cycles.use_denoising = False
    scene.cycles.pixel_filter_type, scene.cycles.filter_width = "BOX", 1.0
    scene.cycles.light_sampling_threshold = 0.0
    scene.cycles.max_bounces = 0
    scene.render.resolution_x, scene.render.resolution_y = resolution
    scene.render.threads_mode, scene.render.threads = "FIXED", 1
    scene.world = bpy.data.worlds.new("black")
    scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.0
    return scene


def linked(data, location=(0, 0, 0), rotation=(0, 0, 0), scale=(1, 1, 1), name="object"):
    """An object of data in the scene."""
    made = bpy.data.objects.new(name, data)
    made.location, made.rotation_euler, made.scale = location, rotation, scale
    bpy.context.scene.collection.objects.link(made)
    return made


def card(size=0.2, location=(0, 0, 0), rotation=(0, 0, 0)):
    """A white diffuse square that faces +z."""
    bpy.ops.mesh.primitive_plane_add(size=size, location=location, rotation=rotation)
    made = bpy.context.object
    material = bpy.data.materials.new("white")
    tree = material.node_tree
    tree.nodes.clear()
    diffuse = tree.nodes.new("ShaderNodeBsdfDiffuse")
    diffuse.inputs["Color"].default_value = (1, 1, 1, 1)
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(diffuse.outputs[0], output.inputs["Surface"])
    made.data.materials.append(material)
    return made


def glowing_ball(location, radius, strength):
    """A ball that emits."""
    bpy.ops.mesh.primitive_uv_sphere_add(
        radius=radius, location=location, segments=64, ring_count=32
    )
    made = bpy.context.object
    material = bpy.data.materials.new("glow")
    tree = material.node_tree
    tree.nodes.clear()
    emission = tree.nodes.new("ShaderNodeEmission")
    emission.inputs["Strength"].default_value = strength
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(emission.outputs[0], output.inputs["Surface"])
    made.data.materials.append(material)
    return made


def camera(location=(0, 0, 2), rotation=(0, 0, 0), lens=50.0):
    """The scene's camera; without rotation it looks down."""
    data = bpy.data.cameras.new("camera")
    data.lens = lens
    made = linked(data, location, rotation, name="camera")
    bpy.context.scene.camera = made
    return made


def picture():
    """Scene-linear picture by Cycles, shape (H, W, 3), row 0 on top."""
    with tempfile.TemporaryDirectory() as folder:
        return drawn(Path(folder) / "out.exr")


def drawn(path):
    """Picture by the scene's engine, as :func:`picture`, by way of a file."""
    scene = bpy.context.scene
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    return oiio.ImageBuf(str(path)).get_pixels()[..., :3].astype(float)


def y_up(matrix, metres_per_unit=1.0):
    """Scene of Daguerre from an object of Blender, shape (4, 4), m."""
    turn = np.array([(1, 0, 0, 0), (0, 0, 1, 0), (0, -1, 0, 0), (0, 0, 0, 1)], float)
    return turn @ np.diag([metres_per_unit] * 3 + [1.0]) @ np.array(matrix, float)


def rigid(world):
    """A transform with axes of length 1, shape (4, 4)."""
    made = np.array(world)
    made[:3, :3] /= np.linalg.norm(made[:3, :3], axis=0)
    return made
