"""Meshes of Blender: against Blender's own glTF, against numbers, in memory and time."""

import time

import numpy as np
import pytest

import daguerre as dg
from daguerre.blender.meshes import Needs
from daguerre.errors import InputError

from . import building, triangles
from .building import GREY, bpy, empty, graph, grid, link, mesh_of, scene_of, translated


def uv_sphere(name, **modifiers):
    """A smooth sphere with texture coordinates and a modifier."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=12, ring_count=7)
    thing = bpy.context.object
    thing.name = name
    bpy.ops.object.shade_smooth()
    return thing


def smooth():
    """A subdivided sphere that is stretched and turned."""
    thing = uv_sphere("smooth")
    thing.modifiers.new("s", "SUBSURF").levels = 1
    thing.scale, thing.rotation_euler = (1.5, 0.7, 1), (0.3, 0.5, 0.9)


def flat():
    """A flat sphere."""
    uv_sphere("flat")
    bpy.ops.object.shade_flat()


def mixed():
    """A sphere with sharp edges at steep angles."""
    uv_sphere("mixed")
    bpy.ops.object.shade_smooth_by_angle(angle=0.45)


def custom():
    """A grid whose normals someone chose."""
    mesh = grid(4)
    mesh.shade_smooth()
    random = np.random.default_rng(1).normal(size=(len(mesh.loops), 3)) + np.array([0, 0, 3])
    random /= np.linalg.norm(random, axis=1, keepdims=True)
    mesh.normals_split_custom_set(random.tolist())
    link(mesh, "custom", location=(0.3, 0.2, 0.1))


def polygons():
    """Large polygons, one of them with a bay."""
    bay = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (1, 0.5, 0), (0, 2, 0), (0, 1, 0)]
    five = [(0, 0, 1), (1, 0, 1), (1.5, 1, 1), (0.5, 1.5, 1), (-0.5, 1, 1)]
    link(mesh_of(bay + five, [range(6), range(6, 11)]), "polygons")


def mirrored():
    """A grid that is mirrored and stretched."""
    mesh = grid(3)
    mesh.shade_smooth()
    link(mesh, "mirrored", scale=(-1.2, 0.7, 1), rotation_euler=(0.2, 0, 0.4))


def several_materials():
    """A grid of three slots, one of them without faces, one empty."""
    mesh = grid(4)
    mesh.shade_smooth()
    for name in ("a", None, "c"):
        mesh.materials.append(name and bpy.data.materials.new(name))
    mesh.polygons.foreach_set("material_index", np.int32([0, 2] * 8))
    link(mesh, "several")


def text():
    """Words, which are curves."""
    data = bpy.data.curves.new("t", "FONT")
    data.body, data.extrude = "ab", 0.1
    link(data, "text")


def cable():
    """A bevelled curve."""
    data = bpy.data.curves.new("c", "CURVE")
    data.dimensions, data.bevel_depth = "3D", 0.1
    spline = data.splines.new("POLY")
    spline.points.add(3)
    for i, point in enumerate(spline.points):
        point.co = (i, 0.3 * i * i, 0, 1)
    link(data, "cable")


def family():
    """A child of a turned parent."""
    parent = link(None, "parent", location=(1, 2, 0.5), rotation_euler=(0.1, 0.2, 0.3))
    mesh = grid(3)
    mesh.shade_smooth()
    link(mesh, "child", location=(0, 0, 1), scale=(1, 1, 0.5)).parent = parent


def collection():
    """A collection that is placed twice."""
    mesh = grid(2)
    group = bpy.data.collections.new("group")
    group.objects.link(bpy.data.objects.new("member", mesh))
    for k in range(2):
        thing = link(None, f"place{k}", location=(2 * k, 1, 0), rotation_euler=(0, 0, k))
        thing.instance_type, thing.instance_collection = "COLLECTION", group


SCENES = [
    smooth, flat, mixed, custom, polygons, mirrored, several_materials, text, cable, family,
    collection,
]  # fmt: skip


@pytest.mark.parametrize("make", SCENES, ids=lambda make: make.__name__)
def test_triangles_are_those_of_the_gltf_export(make, tmp_path, monkeypatch):
    """Positions, normals and texture coordinates in the world, within 1e-6."""
    empty()
    make()
    ours, theirs = translated(), dg.load(building.exported(tmp_path, monkeypatch))
    apart = triangles.farthest(triangles.of(ours), triangles.of(theirs))
    assert max(apart) < 1e-6, apart
    assert not ours.warnings


def test_materials_by_face():
    """Each used slot is a mesh of its own; slots without faces are none."""
    empty()
    several_materials()
    scene = translated()
    found = {scene.materials[i.material].name: scene.meshes[i.mesh] for i in scene.instances}
    assert set(found) == {"a", "c"}
    columns = {  # of the squares of the grid
        name: set(np.floor(4 * mesh.positions[mesh.indices][..., 0].mean(axis=1)).astype(int))
        for name, mesh in found.items()
    }
    assert columns == {"a": {0, 2}, "c": {1, 3}}
    assert [len(mesh.indices) for mesh in found.values()] == [16, 16]


def test_slots_beyond_the_last():
    """Faces of a slot that is not there have the last one, as in Blender."""
    empty()
    mesh = grid(2)
    for name in ("first", "last"):
        mesh.materials.append(bpy.data.materials.new(name))
    mesh.polygons.foreach_set("material_index", np.int32([0, 1, 2, 8]))
    link(mesh)
    scene = translated()
    sizes = {
        scene.materials[i.material].name: len(scene.meshes[i.mesh].indices) for i in scene.instances
    }
    assert sizes == {"first": 2, "last": 6}


class Choosy(building.Grey):
    """Materials that read other layers than those that renders use."""

    wants = Needs()

    def needs(self, material):
        return self.wants


def choosy(wants, notes=()):
    """The scene with materials of these needs."""
    made = type("Wanting", (Choosy,), {"wants": wants})
    by = building.Rooms(made, building.add_light, building.set_world, building.camera_of)
    scene = scene_of(graph(), by=by)
    assert scene.warnings == list(notes)
    return scene


def test_uv_maps():
    """The map that renders use is set 0; a material may name others; v points down."""
    empty()
    mesh = grid(1)
    other = mesh.uv_layers.new(name="other")
    chosen = np.float32([0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.9])
    other.uv.foreach_set("vector", chosen)
    link(mesh)
    top = np.unique(choosy(Needs()).meshes[0].uv, axis=0)
    np.testing.assert_allclose(top, [[0, 0], [0, 1], [1, 0], [1, 1]])
    both = choosy(Needs(("other", "UVMap"))).meshes[0]
    wanted = chosen.reshape(-1, 2) * [1, -1] + [0, 1]
    np.testing.assert_allclose(np.sort(both.uv, axis=0), np.sort(wanted, axis=0), atol=1e-6)
    assert len(both.uv1) == 4
    other.active_render = True
    np.testing.assert_allclose(choosy(Needs()).meshes[0].uv, both.uv)
    gone = "UV map 'none' is missing on a mesh (1 use)"
    assert choosy(Needs(("none",)), [gone]).meshes[0].uv is None


@pytest.mark.parametrize("domain", ["POINT", "CORNER"])
@pytest.mark.parametrize("kind", ["FLOAT_COLOR", "BYTE_COLOR"])
def test_colours(domain, kind):
    """Colour attributes are linear, and there only if a material reads them."""
    empty()
    mesh = grid(2)
    layer = mesh.color_attributes.new("tint", kind, domain)
    corners = np.array([loop.vertex_index for loop in mesh.loops])
    vertices = np.arange(9) if domain == "POINT" else corners
    for vertex, item in zip(vertices, layer.data, strict=True):
        item.color_srgb = (0.1 * vertex, 0.5, 1, 0.8)
    link(mesh)
    assert translated().meshes[0].colors is None
    for name in ("", "tint"):
        found = choosy(Needs(("",), name)).meshes[0]
        x, y = np.rint(2 * found.positions[:, :2].T)
        encoded = 0.1 * (x + 3 * y)
        linear = np.where(encoded < 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
        np.testing.assert_allclose(found.colors[:, 0], linear, atol=0.01)
        np.testing.assert_allclose(found.colors[:, 3], 0.8, atol=0.01)


def test_a_mesh_without_faces():
    """Nothing is drawn of vertices and edges alone."""
    empty()
    link(mesh_of([(0, 0, 0), (1, 0, 0)], []))
    scene = translated()
    assert not scene.meshes
    assert not scene.instances


@pytest.mark.parametrize("number", [np.nan, 2e18])
def test_numbers_that_cannot_be_drawn(number):
    """One error that names the mesh."""
    empty()
    mesh = grid(1, name="broken")
    mesh.vertices[0].co = (number, 0, 0)
    link(mesh)
    with pytest.raises(InputError, match=r"mesh 'broken'.*positions.*wanted"):
        translated()


def test_a_million_triangles_within_a_second():
    """Smooth, with texture coordinates and normals of corners."""
    empty()
    mesh = grid(708)
    mesh.shade_smooth()
    mesh.normals_split_custom_set([(0, 0, 1)] * len(mesh.loops))
    link(mesh)
    depsgraph = graph()
    begin = time.process_time()
    scene = scene_of(depsgraph, by=GREY)
    taken = time.process_time() - begin
    assert len(scene.meshes[0].indices) == 2 * 708**2
    assert scene.meshes[0].normals is not None
    assert taken < 1
