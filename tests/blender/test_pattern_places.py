"""Patterns on surfaces: coordinates of texels, baked textures, atlases. Needs bpy."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("bpy")

import bpy

from daguerre.blender.atlas import unwrapped
from daguerre.blender.materials import Materials
from daguerre.blender.raster import rasterized
from daguerre.blender.translate import Rooms, scene_of
from daguerre.shading.channels import Mapping, Plane, Texel
from daguerre.shading.lookup import looked_up

from . import building
from .node_scenes import CD_PER_W, Tree, cycles, emptied, picture, random_picture, stage

SIZE = 16
#: Cycles samples up to 1/200 of a pixel beside its middle; textures are filtered between texels.
CLOSE = 3e-3


@pytest.fixture(autouse=True)
def empty():
    emptied()


def translated():
    """The scene of the file, with a stand-in for its camera, which has no perspective."""
    by = Rooms(Materials, building.add_light, building.set_world, building.camera_of)
    return scene_of(building.graph(), by=by)


def shown(scene, size=SIZE):
    """Emission, in Blender's units, that a camera above sees, shape (H, W, 3)."""
    centres = (np.arange(size) + 0.5) / size * 2 - 1
    x, y = np.meshgrid(centres, -centres)
    found, height = np.zeros((size, size, 3)), np.full((size, size), -np.inf)
    for instance in scene.instances:
        mesh = scene.meshes[instance.mesh]
        points = np.asarray(mesh.positions) @ instance.transform[:3, :3].T
        points = points + instance.transform[:3, 3]
        for corners in np.asarray(mesh.indices).reshape(-1, 3):
            a, b, c = points[corners]
            sides = np.array([[b[0] - a[0], c[0] - a[0]], [a[2] - b[2], a[2] - c[2]]])
            if abs(np.linalg.det(sides)) < 1e-9:
                continue
            s, t = np.linalg.solve(sides, np.stack([x - a[0], y + a[2]]).reshape(2, -1))
            weights = np.stack([1 - s - t, s, t], axis=-1)
            level = (weights @ points[corners][:, 1]).reshape(size, size)
            hit = (weights.min(axis=-1) >= -1e-6).reshape(size, size) & (level > height + 1e-5)
            height[hit] = level[hit]
            light = emitted(scene, instance.material, mesh, corners, weights)
            found[hit] = light.reshape(size, size, 3)[hit]
    return found


def emitted(scene, material, mesh, corners, weights):
    """Emission of a triangle at barycentric coordinates."""
    kind = scene.materials[material].kind
    slot = kind.emissive_texture
    factor = np.array(kind.emissive) / CD_PER_W
    if slot is None:
        return np.broadcast_to(factor, (len(weights), 3))
    uv = weights @ np.asarray(mesh.uv if slot.uv_set == 0 else mesh.uv1)[corners]
    a, b, c, d, e, f = slot.transform
    s, t = a * uv[:, 0] + b * uv[:, 1] + c, d * uv[:, 0] + e * uv[:, 1] + f
    texture = scene.textures[slot.texture]
    lie = Mapping("", wrap=(texture.wrap,) * 2 if isinstance(texture.wrap, str) else texture.wrap)
    pixels = np.asarray(texture.pixels)
    channels = [looked_up(Texel(Plane(pixels[:, :, i]), lie), s, 1 - t) for i in range(3)]
    return np.stack(channels, axis=-1) * factor


def compared(folder, tolerance=CLOSE, size=SIZE):
    """Asserts that the stage shines as in Cycles; returns the scene."""
    scene = translated()
    ours, theirs = shown(scene, size), cycles(folder)
    assert np.ptp(theirs) > 0.05
    np.testing.assert_allclose(ours, theirs, atol=tolerance)
    return scene


def put(material, *, layers=True):
    """A stage whose square is moved, turned and scaled; returns the object."""
    stage(material, size=SIZE)
    thing = bpy.context.object
    points = np.array([tuple(one.co) for one in thing.data.vertices])
    points = points * (0.5, 0.25, 1) + (0.1, 0.2, 0.3)
    thing.data.vertices.foreach_set("co", points.astype(np.float32).ravel())
    thing.scale, thing.rotation_euler = (4, 2, 1), (0, 0, np.pi / 2)
    thing.location = (0.4, -0.4, 0.6)
    if not layers:
        thing.data.uv_layers.remove(thing.data.uv_layers[0])
    thing.data.update()
    return thing


def positive(tree, vector):
    """Sum of a vector and 3, so that no channel is negative."""
    return tree.node("VectorMath", {0: vector, 1: (3.0, 3.0, 3.0)}).outputs[0]


@pytest.mark.parametrize("layers", [True, False])
@pytest.mark.parametrize("name", ["Generated", "Object", "Position", "of another object"])
def test_coordinates(name, layers, tmp_path):
    tree = Tree()
    kind = "NewGeometry" if name == "Position" else "TexCoord"
    node = tree.node(kind)
    tree.shine(positive(tree, node.outputs["Object" if " " in name else name]))
    put(tree.material, layers=layers)
    if " " in name:
        other = bpy.data.objects.new("other", None)
        bpy.context.scene.collection.objects.link(other)
        other.location, other.rotation_euler, other.scale = (1, 1, 2), (0.3, 0.2, 0.1), (2, 1, 3)
        node.object = other
        bpy.context.view_layer.update()
    scene = compared(tmp_path)
    assert [one for one in scene.warnings if "baked" in one]


def test_generated_coordinates_are_those_before_deformation(tmp_path):
    tree = Tree()
    tree.shine(positive(tree, tree.node("TexCoord").outputs["Generated"]))
    thing = put(tree.material)
    thing.shape_key_add(name="rest")
    key = thing.shape_key_add(name="bent")
    key.data[0].co = (-0.6, -0.1, 0.9)
    key.value = 1.0
    bpy.context.view_layer.update()
    compared(tmp_path)


@pytest.mark.parametrize("layers", [True, False])
def test_noise_without_a_link_is_placed_by_the_surface(layers, tmp_path):
    tree = Tree()
    tree.shine(tree.node("TexNoise", {"Scale": 2.0, "Detail": 1.0}).outputs["Color"])
    put(tree.material, layers=layers)
    scene = compared(tmp_path, 6e-3)
    side = 512 if not layers else 64
    note = f"the patterns of a material are baked to textures of {side} x {side} texels (1 use)"
    assert scene.warnings == (note,) or list(scene.warnings) == [note]


def test_noise_of_texture_coordinates(tmp_path):
    tree = Tree()
    uv = tree.node("TexCoord").outputs["UV"]
    mapped = tree.node("Mapping", {"Vector": uv, "Rotation": (0, 0, 0.5), "Scale": (3, 1, 1)})
    tree.shine(tree.node("TexNoise", {"Vector": mapped.outputs[0], "Scale": 1.0}).outputs["Color"])
    stage(tree.material, size=SIZE)
    compared(tmp_path, 1e-2)


def test_pictures_and_noise_are_combined_texel_by_texel(tmp_path):
    tree = Tree()
    noise = tree.node("TexNoise", {"Scale": 1.0, "Detail": 0.0}).outputs["Color"]
    texels = tree.node("TexImage", image=random_picture("p", 1), interpolation="Linear")
    sum_ = tree.node("VectorMath", {0: noise, 1: texels.outputs[0]}, operation="MULTIPLY")
    tree.shine(sum_.outputs[0])
    stage(tree.material, size=SIZE)
    compared(tmp_path, 6e-3)


def smooth_picture(name):
    """Image of slow waves."""
    across, down = np.meshgrid(np.linspace(0, 3, 32), np.linspace(0, 2, 32))
    pixels = np.stack([np.sin(across), np.cos(down), np.sin(across + down), across], axis=2)
    return picture(name, 0.5 + 0.4 * pixels)


def test_pictures_at_coordinates_of_the_surface(tmp_path):
    tree = Tree()
    how = {"interpolation": "Linear", "extension": "EXTEND"}
    texture = tree.node("TexImage", image=smooth_picture("p"), **how)
    tree.links.new(tree.node("TexCoord").outputs["Generated"], texture.inputs[0])
    texture.image.alpha_mode = "NONE"
    tree.shine(texture.outputs[0])
    put(tree.material)
    compared(tmp_path)


@pytest.mark.parametrize("layers", [True, False])
def test_a_ball_with_noise(layers, tmp_path):
    tree = Tree()
    tree.shine(tree.node("TexNoise", {"Scale": 1.5, "Detail": 0.0}).outputs["Color"])
    stage(tree.material, size=SIZE)
    bpy.ops.mesh.primitive_uv_sphere_add(radius=0.9, segments=24, ring_count=12)
    ball = bpy.context.object
    ball.data.materials.append(tree.material)
    if not layers:
        ball.data.uv_layers.remove(ball.data.uv_layers[0])
    compared(tmp_path, 2e-2)


def test_copies_share_the_material_and_other_meshes_have_their_own():
    tree = Tree()
    tree.shine(tree.node("TexNoise").outputs["Color"])
    for i in range(3):
        bpy.ops.mesh.primitive_cube_add(location=(i, 0, 0))
        bpy.context.object.data.materials.append(tree.material)
    copy = bpy.data.objects.new("copy", bpy.context.object.data)
    bpy.context.scene.collection.objects.link(copy)
    scene = translated()
    assert len(scene.instances) == 4
    assert len({one.material for one in scene.instances}) == 3


def test_patterns_of_texture_coordinates_are_shared_by_meshes_with_the_same_range():
    tree = Tree()
    uv = tree.node("TexCoord").outputs["UV"]
    tree.shine(tree.node("TexNoise", {"Vector": uv}).outputs["Color"])
    for i in range(3):
        bpy.ops.mesh.primitive_plane_add(location=(i, 0, 0))
        bpy.context.object.data.materials.append(tree.material)
    scene = translated()
    assert len(scene.materials) == len(scene.textures) == 1


def test_positions_in_the_world_differ_from_copy_to_copy():
    tree = Tree()
    tree.shine(tree.node("NewGeometry").outputs["Position"])
    bpy.ops.mesh.primitive_plane_add()
    bpy.context.object.data.materials.append(tree.material)
    copy = bpy.data.objects.new("copy", bpy.context.object.data)
    copy.location = (3, 0, 0)
    bpy.context.scene.collection.objects.link(copy)
    scene = translated()
    assert len({one.material for one in scene.instances}) == 2


def test_texels_of_all_patterns_are_limited(monkeypatch):
    monkeypatch.setattr("daguerre.blender.materials.MAX_TEXELS", 1 << 17)
    tree = Tree()
    tree.shine(tree.node("TexNoise", {"Scale": 1e5}).outputs["Color"])
    for i in range(60):
        bpy.ops.mesh.primitive_cube_add(location=(i, 0, 0))
        bpy.context.object.data.materials.append(tree.material)
    scene = translated()
    assert sum(one.pixels.shape[0] * one.pixels.shape[1] for one in scene.textures) <= 1 << 17
    assert any("replaced by its mean" in one for one in scene.warnings)


def test_raster_is_a_partition():
    corners = np.array([[[1, 1], [13, 1], [13, 9]], [[1, 1], [13, 9], [1, 9]]], float)
    raster = rasterized(corners, (12, 16))
    whole = np.zeros((12, 16), bool)
    whole[1:9, 1:13] = True
    one, two = raster.weights
    exact = np.minimum(np.minimum(one, two), 1 - one - two) >= -1e-6
    np.testing.assert_array_equal(raster.inside & exact, whole)
    assert raster.overlap == 0
    assert rasterized(np.concatenate([corners, corners]), (12, 16)).overlap > 0.5
    x, y = raster.values(corners)[whole].T
    rows, columns = np.nonzero(whole)
    np.testing.assert_allclose([x, y], [columns + 0.5, rows + 0.5], atol=1e-5)


def tube(turns, sides=24):
    """A band that winds about an axis and lies over itself when seen along any axis."""
    angle = np.linspace(0, 2 * np.pi * turns, sides * turns + 1)
    ring = np.stack([np.cos(angle), np.sin(angle), 0.1 * angle], axis=1)
    points = np.concatenate([ring * (1, 1, 1), ring * (0.5, 0.5, 1)])
    n = len(angle)
    first = np.arange(n - 1)
    quads = np.stack([first, first + 1, first + n + 1, first + n], axis=1)
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    return points, triangles, np.tile(first, 2)


def test_atlas_has_no_overlap():
    points, triangles, faces = tube(3)
    placed = unwrapped(points, triangles, faces)
    assert placed.min() >= 0
    assert placed.max() <= 1
    raster = rasterized(placed * 1024, (1024, 1024))
    assert raster.overlap == 0
    assert len(np.unique(raster.triangle)) == len(triangles) + 1
    assert np.count_nonzero(raster.covers) > 0.3 * 1024**2


@pytest.mark.parametrize("layers", [True, False])
def test_bump_of_a_pattern_has_its_slope(layers):
    """A height that rises by 1 over 2 m has the normal (-1/2, 0, 1) / sqrt(5/4)."""
    tree = Tree()
    height = tree.node("TexGradient", {"Vector": tree.node("TexCoord").outputs["Generated"]})
    bump = tree.node("Bump", {"Height": height.outputs["Fac"], "Strength": 1.0, "Distance": 1.0})
    tree.surface(tree.node("BsdfDiffuse", {"Normal": bump.outputs[0]}))
    stage(tree.material)
    if not layers:
        data = bpy.context.object.data
        data.uv_layers.remove(data.uv_layers[0])
    scene = translated()
    kind = scene.materials[scene.instances[0].material].kind
    texture = scene.textures[kind.normal_texture.texture]
    height, width = texture.pixels.shape[:2]
    middle = np.asarray(texture.pixels)[height // 2, width // 2, :3] * 2.0 - 1
    middle[:2] *= kind.normal_scale
    np.testing.assert_allclose(middle, np.array([-0.5, 0, 1]) / np.sqrt(1.25), atol=2e-3)


@pytest.mark.parametrize(
    ("inputs", "side"),
    [
        ({"Scale": 20.0, "Detail": 0.0}, 256),  # 8 texels for each of 20 cells
        ({"Scale": 20.0, "Detail": 2.0}, 1024),  # the second octave has 80
        ({"Scale": 1.0, "Detail": 0.0}, 64),
        ({"Scale": 1e9, "Detail": 0.0}, 2048),
    ],
)
def test_size_follows_the_scale_of_a_pattern(inputs, side):
    tree = Tree()
    uv = tree.node("TexCoord").outputs["UV"]
    tree.shine(tree.node("TexNoise", {"Vector": uv, **inputs}).outputs[0])
    stage(tree.material)
    scene = translated()
    assert scene.textures[0].pixels.shape[:2] == (side, side)
