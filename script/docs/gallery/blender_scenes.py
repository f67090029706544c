"""Scenes of Blender for `blender_engine.py`: the default cube, a moving arm, and node trees."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
from blender_lens import add_lamps
from mathutils import Vector

Color = tuple[float, float, float]
Place = tuple[float, float, float]


@dataclass(frozen=True)
class Shot:
    """How a scene is photographed.

    Attributes:
        lens: Properties of Daguerre's panel; the f-stop counts for Cycles, too.
        focus: Distance along the axis, m.
    """

    lens: dict[str, Any]
    focus: float


def cube() -> Shot:
    """Blender's default scene as a box of 20 cm, with far lamps behind it."""
    bpy.context.scene.unit_settings.scale_length = 0.1
    add_lamps()
    return Shot({"lens": "canon-50mm-f0.95", "f_stop": 0.95}, 0.96)


def emptied(sky: Color, strength: float) -> Any:
    """An empty scene under a sky of one colour."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.world = bpy.data.worlds.new("sky")
    background = scene.world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (*sky, 1.0)
    background.inputs["Strength"].default_value = strength
    return scene


def linked(data: Any, place: Place, turn: Place = (0, 0, 0)) -> Any:
    """An object of some data in the scene."""
    made = bpy.data.objects.new(data.name, data)
    made.location, made.rotation_euler = place, turn
    bpy.context.scene.collection.objects.link(made)
    return made


def aimed(data: Any, place: Place, aim: Place) -> Any:
    """An object that looks or shines from one point to another."""
    turn = (Vector(aim) - Vector(place)).to_track_quat("-Z", "Y").to_euler()
    return linked(data, place, turn)


def eye(place: Place, aim: Place) -> None:
    """The scene's camera, of 50 mm."""
    data = bpy.data.cameras.new("camera")
    data.lens = 50.0
    bpy.context.scene.camera = aimed(data, place, aim)


def soft_box(place: Place, aim: Place, watts: float, size: float, color: Color) -> None:
    """An area lamp."""
    data = bpy.data.lights.new("box", "AREA")
    data.energy, data.size, data.color = watts, size, color
    aimed(data, place, aim)


def material(kind: str, **inputs: Any) -> Any:
    """A material of one shader; in names of inputs _ stands for a space."""
    made = bpy.data.materials.new(kind)
    tree = made.node_tree
    tree.nodes.clear()
    node = tree.nodes.new(f"ShaderNode{kind}")
    for name, value in inputs.items():
        full = (*value, 1.0) if isinstance(value, tuple) else value
        node.inputs[name.replace("_", " ")].default_value = full
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    return made


def practicals(rows: list[tuple[Place, float, Color, float]]) -> None:
    """Small glowing balls: place, radius, colour and strength."""
    for place, radius, color, strength in rows:
        bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=2, radius=radius, location=place)
        bpy.ops.object.shade_smooth()
        glow = material("Emission", Color=color, Strength=strength)
        bpy.context.object.data.materials.append(glow)


def ground(size: float, surface: Any) -> None:
    """A table top."""
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=40, y_subdivisions=40, size=size)
    bpy.context.object.data.materials.append(surface)


# A tentacle of steel and rubber.

BONES, LENGTH, RINGS, SIDES = 6, 0.42, 96, 40


def arm() -> Shot:
    """An arm of six bones that reaches for the camera, while a rolling shutter is open."""
    scene = emptied((0.25, 0.35, 0.6), 0.15)
    ground(3.0, material("BsdfPrincipled", Base_Color=(0.03, 0.03, 0.035), Roughness=0.35))
    bones = skeleton()
    body = tube()
    for k in range(BONES):
        body.vertex_groups.new(name=f"bone{k}")
    bind(body)
    body.modifiers.new("armature", "ARMATURE").object = bones
    body.cycles.motion_steps = 3
    bend(bones)
    random = np.random.default_rng(4)
    warm, cold = (1.0, 0.5, 0.18), (0.25, 0.5, 1.0)
    lamps = []
    for k in range(60):
        x, z = -1.6 + 3.2 * (k + 0.6 * random.uniform()) / 60, random.uniform(0.1, 1.3)
        color = warm if random.uniform() < 0.7 else cold
        lamps.append(((x, random.uniform(1.6, 2.6), z), 0.012, color, random.uniform(8, 30)))
    practicals(lamps)
    soft_box((-0.7, -0.3, 0.9), (0, 0, 0.25), 40.0, 0.4, (1.0, 0.85, 0.7))
    soft_box((0.8, 0.5, 0.6), (0, 0, 0.25), 30.0, 0.25, (0.45, 0.65, 1.0))
    eye((0.06, -1.0, 0.3), (0.04, 0.0, 0.22))
    scene.frame_set(10)
    scene.render.fps = 24
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 0.5
    lens = {"lens": "canon-50mm-f0.95", "f_stop": 1.2, "shutter_type": "electronic"}
    lens |= {"rolling_side": "top", "rolling_time": 0.012}
    return Shot(lens, 0.98)


def skeleton() -> Any:
    """Bones along z, one above the other."""
    bones = linked(bpy.data.armatures.new("bones"), (0, 0, 0))
    bpy.context.view_layer.objects.active = bones
    bpy.ops.object.mode_set(mode="EDIT")
    before = None
    for k in range(BONES):
        bone = bones.data.edit_bones.new(f"bone{k}")
        bone.head, bone.tail = (0, 0, k * LENGTH / BONES), (0, 0, (k + 1) * LENGTH / BONES)
        bone.parent, before = before, bone
    bpy.ops.object.mode_set(mode="OBJECT")
    return bones


def tube() -> Any:
    """A tapered tube with ribs; every other rib is of steel, the skin between of rubber."""
    along, around = np.linspace(0, 1, RINGS + 1), np.linspace(0, 2 * math.pi, SIDES, False)
    rib = np.abs(np.sin(along * 12 * math.pi)) ** 0.5
    radius = (0.05 - 0.036 * along) * (0.8 + 0.2 * rib)
    radius[-1] = 1e-4
    x, y = radius[:, None] * np.cos(around), radius[:, None] * np.sin(around)
    z = np.broadcast_to((along * LENGTH)[:, None], x.shape)
    points = np.stack([x, y, z], axis=-1).reshape(-1, 3)
    ring, side = np.mgrid[:RINGS, :SIDES].reshape(2, -1)
    after = (side + 1) % SIDES
    faces = np.stack(
        [ring * SIDES + side, ring * SIDES + after, (ring + 1) * SIDES + after,
         (ring + 1) * SIDES + side], axis=1,
    )  # fmt: skip
    mesh = bpy.data.meshes.new("arm")
    mesh.from_pydata(points.tolist(), [], faces.tolist())
    mesh.shade_smooth()
    steel = material("BsdfPrincipled", Base_Color=(0.85, 0.5, 0.25), Metallic=1.0, Roughness=0.22)
    rubber = material("BsdfPrincipled", Base_Color=(0.03, 0.03, 0.035), Roughness=0.4)
    mesh.materials.append(steel), mesh.materials.append(rubber)
    middle = (ring + 0.5) / RINGS * 12
    mesh.polygons.foreach_set("material_index", (np.abs(middle % 1 - 0.5) > 0.33).astype(np.int32))
    return linked(mesh, (0, 0, 0))


def bind(body: Any) -> None:
    """Weights of the points: each belongs to the two nearest bones."""
    for vertex in body.data.vertices:
        place = vertex.co.z / LENGTH * BONES - 0.5
        low = min(max(math.floor(place), 0), BONES - 1)
        high, share = min(low + 1, BONES - 1), min(max(place - low, 0.0), 1.0)
        body.vertex_groups[low].add([vertex.index], 1 - share, "ADD")
        body.vertex_groups[high].add([vertex.index], share, "ADD")


def bend(bones: Any) -> None:
    """Curls the arm from frame 1 to 19; the tip sweeps fastest."""
    for k, bone in enumerate(bones.pose.bones):
        bone.rotation_mode = "XYZ"
        for frame, turn in ((1, -1.0), (19, 1.0)):
            lean = 0.25 if k > 1 else -0.15
            bone.rotation_euler = (0.22 * lean, 0.0, 0.0)
            bone.rotation_euler[2] = lean + turn * 0.3 * (k + 1)
            bone.keyframe_insert("rotation_euler", frame=frame)


# Painted balls, whose colours, roughness and bumps are all pictures through nodes.


def picture(name: str, values: Any, space: str = "Non-Color") -> Any:
    """Grey image of values 0 to 1, shape (H, W)."""
    height, width = values.shape
    image = bpy.data.images.new(name, width, height, float_buffer=True)
    image.colorspace_settings.name = space
    pixels = np.ones((height, width, 4), np.float32)
    pixels[..., :3] = values[..., None]
    image.pixels.foreach_set(pixels.ravel())
    image.update()
    return image


def clouds(seed: int, power: float, size: int = 512) -> Any:
    """Random values that repeat, their amplitude falling with frequency by a power."""
    random = np.random.default_rng(seed)
    fx, fy = np.meshgrid(np.fft.fftfreq(size), np.fft.fftfreq(size))
    frequency = np.maximum(np.hypot(fx, fy) * size, 2.0)
    noise = np.fft.fft2(random.normal(size=(size, size))) / frequency**power
    found = np.fft.ifft2(noise).real
    order = found.ravel().argsort().argsort()  # each value is as frequent as any other
    return (order / order.size).reshape(size, size)


def glaze(seed: int, colors: tuple[Color, Color, Color]) -> Any:
    """Paint that is worn to the metal where a picture says so."""
    made = bpy.data.materials.new("glaze")
    tree = made.node_tree
    tree.nodes.clear()

    def node(kind: str, **inputs: Any) -> Any:
        new = tree.nodes.new(f"ShaderNode{kind}")
        for name, value in inputs.items():
            socket = new.inputs[name.replace("_", " ")]
            if isinstance(value, bpy.types.NodeSocket):
                tree.links.new(value, socket)
            else:
                socket.default_value = value
        return new

    def texture(name: str, values: Any) -> Any:
        new = node("TexImage")
        new.image = picture(name, values)
        return new.outputs["Color"]

    def ramp(value: Any, *stops: tuple[float, Color]) -> Any:
        new = node("ValToRGB", Fac=value)
        elements = new.color_ramp.elements
        while len(elements) < len(stops):
            elements.new(0.5)
        for element, (place, color) in zip(elements, stops, strict=True):
            element.position, element.color = place, (*color, 1.0)
        return new.outputs["Color"]

    def mixed(share: Any, a: Any, b: Any) -> Any:
        new = tree.nodes.new("ShaderNodeMix")
        new.data_type = "RGBA"
        for key, value in (("Factor_Float", share), ("A_Color", a), ("B_Color", b)):
            socket = next(s for s in new.inputs if s.identifier == key)
            tree.links.new(value, socket)
        return next(s for s in new.outputs if s.identifier == "Result_Color")

    first, second, third = colors
    cloud = texture("cloud", clouds(seed, 1.6))
    v = np.broadcast_to(np.linspace(0, 1, 512)[:, None], (512, 512))
    bands = texture("bands", 0.5 + 0.5 * np.sin(14 * math.pi * v + 3 * clouds(seed + 1, 2.2)))
    paint = ramp(bands, (0.35, first), (0.5, third), (0.65, second))
    metal = ramp(cloud, (0.0, (0.6, 0.3, 0.15)), (1.0, (0.95, 0.75, 0.5)))
    grey = (0.0,) * 3, (1.0,) * 3
    worn = ramp(texture("wear", clouds(seed + 2, 1.3)), (0.70, grey[0]), (0.74, grey[1]))
    rough = ramp(cloud, (0.2, (0.15,) * 3), (0.9, (0.5,) * 3))
    bump = node("Bump", Height=worn, Strength=0.5, Distance=-0.002)
    shader = node(
        "BsdfPrincipled", Base_Color=mixed(worn, paint, metal), Metallic=worn, Roughness=rough,
        Normal=bump.outputs[0],
    )  # fmt: skip
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
    return made


def nodes() -> Shot:
    """Three painted and worn balls on a table."""
    emptied((0.6, 0.7, 0.9), 0.15)
    ground(3.0, material("BsdfPrincipled", Base_Color=(0.22, 0.17, 0.13), Roughness=0.5))
    teal, cream, navy = (0.02, 0.25, 0.28), (0.75, 0.62, 0.42), (0.02, 0.04, 0.12)
    red, black, white = (0.45, 0.03, 0.02), (0.03, 0.03, 0.03), (0.75, 0.72, 0.68)
    for place, radius, seed, colors in (
        ((-0.16, 0.1, 0.1), 0.1, 1, (teal, cream, navy)),
        ((0.06, -0.02, 0.075), 0.075, 11, (red, white, black)),
        ((0.24, 0.28, 0.11), 0.11, 21, (navy, cream, teal)),
    ):
        bpy.ops.mesh.primitive_uv_sphere_add(
            radius=radius, location=place, segments=96, ring_count=48
        )
        bpy.ops.object.shade_smooth()
        bpy.context.object.rotation_euler = (0.5, 0.3, seed)
        bpy.context.object.data.materials.append(glaze(seed, colors))
    soft_box((-0.6, -0.4, 0.9), (0, 0, 0.05), 24.0, 0.5, (1.0, 0.9, 0.8))
    soft_box((0.9, 0.7, 0.5), (0, 0, 0.05), 14.0, 0.3, (0.6, 0.75, 1.0))
    eye((0.02, -0.75, 0.3), (0.03, 0.05, 0.08))
    return Shot({"lens": "double-gauss-50mm-f2", "f_stop": 2.0}, 0.73)


SHOTS: dict[str, Callable[[], Shot]] = {"cube": cube, "arm": arm, "nodes": nodes}
