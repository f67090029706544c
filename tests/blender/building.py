"""Scenes of Blender by script, and stand-ins for translators of materials, lights and cameras."""

import importlib

import numpy as np
import pytest

import daguerre as dg
from daguerre.blender.meshes import Needs
from daguerre.blender.translate import Rooms, scene_of

bpy = pytest.importorskip("bpy", reason="needs bpy, the wheel of Blender")


class Grey:
    """Materials that are grey, one for each of Blender's."""

    def __init__(self, scene, notes):
        self.scene, self.made = scene, {}

    def index(self, material):
        name = "" if material is None else material.name_full
        if name not in self.made:
            self.made[name] = self.scene.add_material(dg.Material(dg.Diffuse(), name=name))
        return self.made[name]

    def needs(self, material):
        return Needs()

    def binding(self, material, world):
        return None


def add_light(scene, matrix, light, name, notes):
    """A point light of the light's energy as its intensity."""
    scene.add_light(dg.PointLight((light.energy,) * 3, name=name), matrix)


def camera_of(thing, render, matrix, notes):
    """A camera with the lens of Blender's, and its place."""
    rigid = matrix.copy()
    rigid[:3, :3] /= np.linalg.norm(rigid[:3, :3], axis=0)
    return dg.Camera(transform=rigid, focal_length=thing.data.lens)


def set_world(scene, world, notes):
    """A white sky."""
    scene.set_environment(color=(1, 1, 1))


GREY = Rooms(Grey, add_light, set_world, camera_of)


def empty():
    """An empty file of Blender; returns its scene."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    return bpy.context.scene


def link(data, name="thing", **fields):
    """An object of some data in the scene."""
    thing = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(thing)
    for key, value in fields.items():
        setattr(thing, key, value)
    return thing


def mesh_of(points, faces, name="mesh"):
    """A mesh of polygons."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(points, [], faces)
    return mesh


def grid(n, size=1.0, name="grid"):
    """A mesh of n x n squares with texture coordinates."""
    x, y = np.meshgrid(np.linspace(0, size, n + 1), np.linspace(0, size, n + 1))
    points = np.stack([x, y, 0.1 * np.sin(6 * x) * np.cos(5 * y)], axis=-1).reshape(-1, 3)
    first = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).reshape(-1)
    faces = np.stack([first, first + 1, first + n + 2, first + n + 1], axis=1)
    mesh = bpy.data.meshes.new(name)
    mesh.vertices.add(len(points))
    mesh.vertices.foreach_set("co", points.astype(np.float32).reshape(-1))
    mesh.loops.add(faces.size)
    mesh.loops.foreach_set("vertex_index", faces.astype(np.int32).reshape(-1))
    mesh.polygons.add(len(faces))
    mesh.polygons.foreach_set("loop_start", np.arange(0, faces.size, 4, dtype=np.int32))
    uv = mesh.uv_layers.new(name="UVMap")
    uv.uv.foreach_set("vector", points[faces.reshape(-1), :2].astype(np.float32).reshape(-1))
    mesh.update(calc_edges=True)
    return mesh


def graph():
    """The evaluated dependency graph."""
    bpy.context.view_layer.update()
    return bpy.context.evaluated_depsgraph_get()


def translated(**options):
    """The scene of the file, with stand-ins."""
    return scene_of(graph(), by=GREY, **options)


def exported(folder, monkeypatch):
    """File of Blender's own glTF exporter, without materials."""
    exporter = importlib.import_module("io_scene_gltf2.blender.exp.primitive_extract")
    monkeypatch.setattr(exporter, "ROUNDING_DIGIT", 9)  # it rounds normals to four digits
    path = folder / "scene.glb"
    bpy.ops.export_scene.gltf(
        filepath=str(path), export_format="GLB", export_apply=True, export_materials="PLACEHOLDER"
    )
    return path


def key(thing, path, frames):
    """Keys of a property with straight lines between: pairs (frame, value)."""
    for frame, value in frames:
        setattr(thing, path, value)
        thing.keyframe_insert(path, frame=frame)


def straighten():
    """Makes all keys of the file linear."""
    for action in bpy.data.actions:
        for layer in action.layers:
            for strip in layer.strips:
                for bag in strip.channelbags:
                    for curve in bag.fcurves:
                        curve.extrapolation = "LINEAR"
                        for point in curve.keyframe_points:
                            point.interpolation = "LINEAR"


class Recorder(bpy.types.RenderEngine):
    """An engine of Blender that translates the scene when it renders."""

    bl_idname, bl_label = "RECORDER", "Recorder"
    found = None

    def render(self, depsgraph):
        scene = scene_of(depsgraph, by=GREY, frame_set=self.frame_set)
        type(self).found = scene, depsgraph.scene.frame_current_final


def in_a_render():
    """The scene of the file as an engine sees it in a render, and the frame after it."""
    render = bpy.context.scene.render
    render.resolution_x = render.resolution_y = 4
    bpy.utils.register_class(Recorder)
    try:
        render.engine = "RECORDER"
        bpy.ops.render.render()
        return Recorder.found
    finally:
        bpy.utils.unregister_class(Recorder)
        Recorder.found = None
