"""Twelve small scenes of Blender by script, which Cycles and Daguerre photograph alike.

Each has a floor, things on it and a camera that looks down at them from the side; together they
have every kind of lamp, world and surface, modifiers, copies, smooth and flat faces. Flat
polygons are plane: triangles of a bent one have normals of their own in Cycles and here, and a
common one in glTF.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tests.support.blender import blender_pictures as blender

from .building import key, straighten
from .node_scenes import Tree, picture

bpy = blender.bpy

Place = tuple[float, float, float]
#: Bounces that both renderers follow.
BOUNCES = 16
EYE, AIM = (0.0, -6.0, 3.2), (0.0, 0.0, 0.6)


def stage(resolution: tuple[int, int] = (96, 64), samples: int = 256) -> Any:
    """An empty scene whose picture by Cycles is that of its light alone, with a camera."""
    scene = blender.empty(resolution, samples)
    cycles = scene.cycles
    for kind in ("max", "diffuse", "glossy", "transmission", "transparent_max"):
        setattr(cycles, f"{kind}_bounces", BOUNCES)
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0.0
    look(EYE, AIM)
    return scene


def look(eye: Place, aim: Place, lens: float = 50.0) -> Any:
    """The scene's camera, from one point to another."""
    from mathutils import Vector

    turn = (Vector(aim) - Vector(eye)).to_track_quat("-Z", "Y")
    return blender.camera(eye, turn.to_euler(), lens)


def surface(kind: str, name: str = "surface", **inputs: Any) -> Any:
    """A material of one shader; in names of inputs _ stands for a space."""
    tree = Tree(name)
    node = tree.node(kind, {key.replace("_", " "): v for key, v in inputs.items()})
    scatter_once(node)
    tree.surface(node)
    return tree.material


def scatter_once(node: Any) -> None:
    """Lets light leave a rough surface after one facet, as Daguerre does; Cycles offers both."""
    if hasattr(node, "distribution"):
        node.distribution = "GGX"


def bump_plainly(material: Any) -> Any:
    """Leaves shadows at the edge of bumps as they are: Cycles can darken them to hide facets."""
    material.cycles.use_bump_map_correction = False
    return material


def diffuse(*color: float) -> Any:
    """A diffuse material."""
    return surface("BsdfDiffuse", "diffuse", Color=color)


def shape(kind: str, material: Any, *, smooth: bool = False, **options: Any) -> Any:
    """One of Blender's meshes, with a material."""
    getattr(bpy.ops.mesh, f"primitive_{kind}_add")(**options)
    made = bpy.context.object
    if smooth:
        bpy.ops.object.shade_smooth()
    made.data.materials.append(material)
    return made


def ball(material: Any, place: Place, radius: float = 0.7) -> Any:
    """A smooth ball."""
    return shape(
        "uv_sphere", material, smooth=True, radius=radius, location=place, segments=64,
        ring_count=32,
    )  # fmt: skip


def floor(material: Any | None = None) -> Any:
    """A floor that fills the picture."""
    return shape("plane", material or diffuse(0.6, 0.55, 0.5), size=40)


def lamp(kind: str, place: Place, turn: Place = (0, 0, 0), **values: Any) -> Any:
    """A lamp; without a turn it shines down."""
    light = bpy.data.lights.new(kind.lower(), kind)
    for name, value in values.items():
        setattr(light, name, value)
    return blender.linked(light, place, turn, name=kind.lower())


def soft_lamp(energy: float = 250.0, size: float = 0.5) -> Any:
    """A square lamp above. A large one would block the sky: lamps of Cycles do not."""
    return lamp("AREA", (0.5, -1.5, 4.5), (0.3, 0.1, 0), energy=energy, size=size)


def sky(*color: float, strength: float = 1.0) -> Any:
    """A world of one colour."""
    background = bpy.context.scene.world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (*color, 1)
    background.inputs["Strength"].default_value = strength
    return background


def waves(name: str, rows: int, columns: int, space: str = "Non-Color") -> Any:
    """A smooth picture that repeats, of values 0.1 to 0.9."""
    v, u = np.mgrid[:rows, :columns] * (2 * math.pi)
    u, v = u / columns, v / rows
    pixels = np.ones((rows, columns, 4))
    for channel, (a, b) in enumerate([(2, 1), (1, 3), (3, 2)]):
        pixels[..., channel] = 0.5 + 0.2 * np.sin(a * u) + 0.2 * np.cos(b * v)
    return picture(name, pixels, space)


def coloured_walls() -> None:
    """Diffuse: a subdivided head between coloured walls."""
    floor()
    for side, color in ((-1, (0.7, 0.15, 0.1)), (1, (0.1, 0.5, 0.15))):
        shape(
            "plane", diffuse(*color), size=6, location=(2 * side, 0, 0),
            rotation=(0, math.pi / 2, 0),
        )  # fmt: skip
    head = shape("monkey", diffuse(0.7, 0.7, 0.7), smooth=True, location=(0, 0, 0.9))
    head.modifiers.new("subdivision", "SUBSURF").levels = 1
    head.rotation_euler = (-0.4, 0, 0.4)
    soft_lamp(size=2.0)


def glossy_balls() -> None:
    """Glossy: rough and smooth."""
    floor(surface("BsdfGlossy", Color=(0.5, 0.5, 0.55), Roughness=0.5))
    for k, rough in enumerate((0.2, 0.35, 0.6)):
        material = surface("BsdfGlossy", Color=(0.8, 0.6 + 0.1 * k, 0.6), Roughness=rough)
        ball(material, (1.5 * k - 1.5, 0, 0.7))
    sky(0.4, 0.5, 0.7)
    soft_lamp(60)


def metal() -> None:
    """Principled metals, bevelled and turned."""
    floor()
    for k, color in enumerate([(0.95, 0.7, 0.35), (0.9, 0.55, 0.45), (0.8, 0.8, 0.82)]):
        material = surface(
            "BsdfPrincipled", Base_Color=color, Metallic=1.0, Roughness=0.15 + 0.15 * k
        )
        box = shape("cube", material, size=1.1, location=(1.6 * k - 1.6, 0, 0.6), smooth=True)
        box.rotation_euler = (0, 0, 0.5 * k)
        bevel = box.modifiers.new("bevel", "BEVEL")
        bevel.width, bevel.segments = 0.12, 3
    sky(0.6, 0.65, 0.7)
    soft_lamp(60)


def glass() -> None:
    """Glass, clear and rough, before a coloured wall."""
    floor()
    ball(surface("BsdfGlass", Color=(1, 1, 1), Roughness=0.0, IOR=1.45), (-1, 0, 0.8), 0.8)
    ball(surface("BsdfGlass", Color=(0.93, 1, 0.96), Roughness=0.3, IOR=1.45), (1, 0, 0.8), 0.8)
    shape("cube", diffuse(0.7, 0.3, 0.1), size=1.5, location=(0, 3, 0.8))
    sky(0.8, 0.9, 1.0, strength=0.7)


def coats() -> None:
    """Principled with coats over plain and dark colours."""
    floor(surface("BsdfPrincipled", Base_Color=(0.5, 0.5, 0.5), Roughness=0.5))
    for k, (color, rough, coat) in enumerate(
        [((0.6, 0.05, 0.05), 0.6, 0.05), ((0.05, 0.1, 0.4), 0.4, 0.2), ((0.3, 0.3, 0.3), 0.7, 0.1)]
    ):
        material = surface(
            "BsdfPrincipled", Base_Color=color, Roughness=rough, Coat_Weight=1.0,
            Coat_Roughness=coat,
        )  # fmt: skip
        ball(material, (1.5 * k - 1.5, 0, 0.7))
    sky(0.7, 0.7, 0.7)
    soft_lamp(40)


def area_lamps() -> None:
    """A rectangle, a disk and an ellipse above hollow things."""
    floor()
    ring = shape("torus", diffuse(0.6, 0.5, 0.7), location=(0, 0, 0.5), smooth=True)
    ring.rotation_euler = (0.6, 0.2, 0)
    shell = shape("cube", diffuse(0.5, 0.7, 0.5), size=1.0, location=(2, 0.8, 0.9))
    shell.modifiers.new("wire", "WIREFRAME").thickness = 0.15
    lamp("AREA", (-2, -1, 3), (0, -0.6, 0), energy=80, shape="RECTANGLE", size=0.4, size_y=1.5)
    lamp("AREA", (2, -1, 3), (0, 0.6, 0), energy=60, shape="DISK", size=0.8, color=(1, 0.7, 0.4))
    lamp("AREA", (0, 1, 4), energy=40, shape="ELLIPSE", size=1.0, size_y=0.5, color=(0.4, 0.6, 1))


def sun() -> None:
    """A low sun of 5 degrees over rows of boxes."""
    floor()
    box = shape("cube", diffuse(0.7, 0.65, 0.6), size=0.5, location=(-2.2, -0.5, 0.25))
    box.rotation_euler = (0, 0, 0.3)
    for axis, count in ((0, 5), (1, 3)):
        array = box.modifiers.new("array", "ARRAY")
        array.count, array.use_relative_offset, array.use_constant_offset = count, False, True
        array.constant_offset_displace = [1.0 * (axis == k) for k in range(3)]
    lamp("SUN", (0, 0, 5), (0.9, 0.3, 0.5), energy=3, angle=math.radians(5), color=(1, 0.9, 0.8))
    sky(0.3, 0.4, 0.6, strength=0.3)


def point_and_spot() -> None:
    """A small round lamp and a spot over a head and a turned body."""
    floor()
    head = shape("monkey", diffuse(0.7, 0.5, 0.4), location=(-0.9, 0, 0.9), smooth=True)
    head.rotation_euler = (-0.4, 0, -0.3)
    body = shape("cylinder", diffuse(0.4, 0.5, 0.7), location=(1.3, 0, 0.8), radius=0.5, depth=1.6)
    bpy.ops.object.shade_smooth_by_angle(angle=0.6)
    body.modifiers.new("twist", "SIMPLE_DEFORM").deform_method = "TAPER"
    lamp("POINT", (-2, -2, 2.5), energy=150, shadow_soft_size=0.1, color=(1, 0.8, 0.6))
    lamp(
        "SPOT", (2, -1.5, 4), (0.3, 0.3, 0), energy=500, shadow_soft_size=0.05,
        spot_size=math.radians(40), spot_blend=0.3,
    )  # fmt: skip


def world_colour() -> None:
    """Copies of a collection under an even sky."""
    floor()
    group = bpy.data.collections.new("group")
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=2, radius=0.35)
    member = bpy.context.object
    member.data.materials.append(diffuse(0.7, 0.5, 0.3))
    bpy.context.scene.collection.objects.unlink(member)
    group.objects.link(member)
    for k in range(9):
        place = (1.2 * (k % 3) - 1.2, 1.2 * (k // 3) - 1, 0.35 + 0.1 * (k % 2))
        empty = blender.linked(None, place, (0, 0, 0.7 * k), (1, 1, 1 + 0.1 * k), f"place{k}")
        empty.instance_type, empty.instance_collection = "COLLECTION", group
    sky(0.9, 0.8, 1.0)


def world_picture() -> None:
    """A turned sky from a picture, over diffuse and shiny things."""
    floor()
    ball(surface("BsdfPrincipled", Metallic=1.0, Roughness=0.2), (-1.2, 0, 0.7))
    ball(diffuse(0.7, 0.7, 0.7), (1.2, 0, 0.7))
    shape("cone", diffuse(0.3, 0.5, 0.7), location=(0, 1.5, 1.0))
    background = sky(1, 1, 1, strength=1.5)
    tree = bpy.context.scene.world.node_tree
    shown = tree.nodes.new("ShaderNodeTexEnvironment")
    shown.image = waves("sky", 64, 128)
    coordinate = tree.nodes.new("ShaderNodeTexCoord")
    mapping = tree.nodes.new("ShaderNodeMapping")
    mapping.inputs["Rotation"].default_value = (0, 0, 0.8)
    tree.links.new(coordinate.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs[0], shown.inputs["Vector"])
    tree.links.new(shown.outputs[0], background.inputs["Color"])


def pictures_and_bumps() -> None:
    """A picture repeated on a bumped floor, and a normal map on a box."""
    tree = Tree("bumped")
    mapping = tree.node("Mapping", {"Scale": (4.0, 4.0, 1.0)})
    tree.links.new(tree.node("TexCoord").outputs["UV"], mapping.inputs["Vector"])
    where = {"Vector": mapping.outputs[0]}
    color = tree.node("TexImage", where, image=waves("paint", 64, 64, "sRGB"))
    height = tree.node("TexImage", where, image=waves("height", 64, 64), interpolation="Linear")
    bump = tree.node("Bump", {"Height": height.outputs[0], "Distance": 0.1, "Strength": 0.8})
    inputs = {"Color": color.outputs[0], "Normal": bump.outputs[0]}
    tree.surface(tree.node("BsdfDiffuse", inputs))
    shape("plane", bump_plainly(tree.material), size=8)
    tree = Tree("mapped")
    bent = tree.node("NormalMap", {"Color": normals(tree).outputs[0]})
    tree.surface(tree.node("BsdfDiffuse", {"Color": (0.6, 0.6, 0.6), "Normal": bent.outputs[0]}))
    box = shape("cube", bump_plainly(tree.material), size=1.4, location=(0, 0.5, 0.8))
    box.rotation_euler = (0, 0, 0.6)
    soft_lamp()
    sky(0.3, 0.3, 0.3)


def normals(tree: Tree) -> Any:
    """Texture of normals that lean up to 0.3 each way."""
    v, u = np.mgrid[:64, :64] * (2 * math.pi / 64)
    pixels = np.stack([0.3 * np.sin(2 * u), 0.3 * np.cos(3 * v), np.ones((64, 64))], axis=-1)
    pixels /= np.linalg.norm(pixels, axis=-1, keepdims=True)
    alpha = np.ones((64, 64, 1))
    image = picture("normals", np.concatenate([(pixels + 1) / 2, alpha], axis=-1))
    return tree.node("TexImage", image=image, interpolation="Linear")


def glowing_things() -> None:
    """Meshes that emit, one of them solidified and flat, between diffuse ones."""
    floor()
    glow = surface("Emission", Color=(1, 0.6, 0.3), Strength=4.0)
    shape("torus", glow, smooth=True, location=(-1, 0, 0.8),
          rotation=(0.8, 0, 0), major_radius=0.6, minor_radius=0.15)  # fmt: skip
    sheet = shape("plane", surface("Emission", Color=(0.3, 0.6, 1), Strength=5.0), size=0.8,
                  location=(1.4, 0, 0.9), rotation=(1.2, 0, 0.3))  # fmt: skip
    sheet.modifiers.new("thick", "SOLIDIFY").thickness = 0.3
    ball(diffuse(0.7, 0.7, 0.7), (0.3, 0.6, 0.5), 0.5)


def painted_floor(repeats: float) -> None:
    """A floor of coloured waves, so that blur shows everywhere."""
    tree = Tree("painted")
    mapping = tree.node("Mapping", {"Scale": (repeats, repeats, 1.0)})
    tree.links.new(tree.node("TexCoord").outputs["UV"], mapping.inputs["Vector"])
    image = waves("paint", 64, 64)
    color = tree.node("TexImage", {"Vector": mapping.outputs[0]}, image=image)
    tree.surface(tree.node("BsdfDiffuse", {"Color": color.outputs[0]}))
    floor(tree.material)


def deep_rows() -> None:
    """Balls and glowing beads from near to far, and a lens half a metre wide."""
    painted_floor(24)
    bead = surface("Emission", Color=(1.0, 0.7, 0.4), Strength=3.0)
    for row in range(5):
        for column in range(-2, 3):
            place = (0.9 * column + 0.2 * row, 1.3 * row - 3, 0.3)
            lit = (row + column) % 3 == 0
            ball(bead if lit else diffuse(0.6, 0.3, 0.2 + 0.1 * row), place, 0.25)
    sky(0.6, 0.7, 0.9)
    dof = bpy.context.scene.camera.data.dof
    dof.use_dof, dof.focus_distance, dof.aperture_fstop = True, 5.0, 0.1


def moved(thing: Any, path: str, begin: Any, end: Any) -> None:
    """Moves a property evenly from frame 1 to 3, and goes to frame 2."""
    key(thing, path, [(1, begin), (3, end)])
    straighten()
    bpy.context.scene.frame_set(2)


def opened() -> None:
    """Blender's shutter, open for 0.8 of a frame around it."""
    render = bpy.context.scene.render
    render.use_motion_blur, render.motion_blur_shutter = True, 0.8
    render.motion_blur_position = "CENTER"


def sliding_boxes() -> None:
    """Rows of boxes that slide over a floor at rest."""
    painted_floor(6)
    for k in range(3):
        box = shape("cube", diffuse(0.7, 0.2 + 0.2 * k, 0.2), size=0.6, location=(0, 0, 0.3))
        array = box.modifiers.new("array", "ARRAY")
        array.count, array.use_relative_offset, array.use_constant_offset = 6, False, True
        array.constant_offset_displace = (1.3, 0, 0)
        place = (-3.2 + 0.5 * k, 1.2 * k - 1.5, 0.31)
        moved(box, "location", place, (place[0] + 1.6, place[1] + 0.5, place[2]))
    sky(0.7, 0.8, 1.0)
    lamp("SUN", (0, 0, 5), (0.7, 0.3, 0), energy=2, angle=0.05)
    opened()


def turning_cross() -> None:
    """Two crossed bars and a head, which turn about the vertical by 23 degrees."""
    painted_floor(6)
    for turn in (0.0, math.pi / 2):
        bar = shape("cube", diffuse(0.8, 0.5, 0.3), size=1.0, location=(0, 0, 0.2))
        bar.scale = (5, 0.5, 0.3)
        moved(bar, "rotation_euler", (0, 0, turn - 0.5), (0, 0, turn + 0.5))
    head = shape("monkey", diffuse(0.4, 0.5, 0.8), location=(0, 0, 1.2), smooth=True)
    moved(head, "rotation_euler", (0, 0, -0.5), (0, 0, 0.5))
    sky(0.7, 0.8, 1.0)
    lamp("SUN", (0, 0, 5), (0.7, 0.3, 0), energy=2, angle=0.05)
    opened()


def travelling_camera() -> None:
    """A camera that goes sideways, down and turns, over things at rest."""
    painted_floor(8)
    for k in range(5):
        ball(diffuse(0.7, 0.2 * k, 0.4), (1.1 * k - 2.2, 0.8 * (k % 3) - 1, 0.4), 0.4)
    sky(0.8, 0.8, 0.9)
    eye = bpy.context.scene.camera
    x, y, z = eye.location
    moved(eye, "location", (x - 0.4, y, z + 0.2), (x + 0.4, y, z - 0.2))
    a, b, c = eye.rotation_euler
    moved(eye, "rotation_euler", (a, b, c - 0.05), (a, b, c + 0.05))
    opened()


#: Scenes for a pinhole and a frozen moment.
SCENES = [
    coloured_walls, glossy_balls, metal, glass, coats, area_lamps, sun, point_and_spot,
    world_colour, world_picture, pictures_and_bumps, glowing_things,
]  # fmt: skip
#: Scenes that a lens or the time blurs.
BLURRED = [deep_rows, sliding_boxes, turning_cross, travelling_camera]
