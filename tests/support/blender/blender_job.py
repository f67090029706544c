"""Runs in a Python that has bpy: renders one small picture through an exported lens.

    python blender_job.py JOB.json

The camera stands at the origin and looks along -z, y up. `world`: what is seen of the sky, "white"
(1), "black", or "direction" ((d + 1) / 2 in R, G and B). `lamps`: x, y, z, radius, luminance.
"""

import json
import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "script" / "docs" / "gallery"))
from blender_lens import set_lens


def main():
    job = json.loads(Path(sys.argv[1]).read_text())
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    camera = bpy.data.cameras.new("camera")
    camera.sensor_width = job["sensor_width"]
    camera.clip_start = 1e-4
    scene.camera = bpy.data.objects.new("camera", camera)
    scene.collection.objects.link(scene.camera)
    set_lens(camera, Path(job["lens"]), **job["parameters"])
    make_world(scene, job["world"])
    for *place, radius, luminance in job["lamps"]:
        bpy.ops.mesh.primitive_uv_sphere_add(radius=radius, location=place)
        bpy.context.object.data.materials.append(emission(luminance))
    scene.render.engine, scene.cycles.device = "CYCLES", "CPU"
    scene.cycles.samples, scene.cycles.use_adaptive_sampling = job["spp"], False
    scene.cycles.use_denoising = False
    scene.render.resolution_x, scene.render.resolution_y = job["resolution"]
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.threads_mode, scene.render.threads = "FIXED", 1
    scene.render.filepath = job["output"]
    bpy.ops.render.render(write_still=True)


def make_world(scene, kind):
    world = scene.world = bpy.data.worlds.new("world")
    world.use_nodes = True  # Blender 5 has them always, and warns
    tree = world.node_tree
    tree.nodes.clear()
    background = tree.nodes.new("ShaderNodeBackground")
    output = tree.nodes.new("ShaderNodeOutputWorld")
    tree.links.new(background.outputs[0], output.inputs["Surface"])
    value = 1.0 if kind == "white" else 0.0
    background.inputs["Color"].default_value = (value, value, value, 1.0)
    if kind == "direction":
        coordinate = tree.nodes.new("ShaderNodeTexCoord")
        half = tree.nodes.new("ShaderNodeVectorMath")
        half.operation = "MULTIPLY_ADD"
        half.inputs[1].default_value = half.inputs[2].default_value = (0.5, 0.5, 0.5)
        tree.links.new(coordinate.outputs["Generated"], half.inputs[0])
        tree.links.new(half.outputs[0], background.inputs["Color"])


def emission(luminance):
    material = bpy.data.materials.new("lamp")
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    light = tree.nodes.new("ShaderNodeEmission")
    light.inputs["Strength"].default_value = luminance
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(light.outputs[0], output.inputs["Surface"])
    return material


if __name__ == "__main__":
    main()
