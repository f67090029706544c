"""Objects, copies and instances of Blender: places, names, visibility, memory and time."""

import gc
import time
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg

from . import triangles
from .building import (
    GREY,
    bpy,
    empty,
    graph,
    grid,
    in_a_render,
    key,
    link,
    mesh_of,
    scene_of,
    translated,
)

CORNER = [(0, 0, 0), (1, 2, 3), (0, 1, 0)]


def places(scene, name=None):
    """Origins of instances, rows in rising order."""
    chosen = range(len(scene.instances)) if name is None else scene.nodes[name]
    rows = np.array([scene.instances[i].transform[:3, 3] for i in chosen])
    return rows[np.lexsort(rows.T)]


def copies(thing, kind):
    """Makes an object place its children at its vertices, faces, ..."""
    thing.instance_type = kind
    return thing


def test_axes_and_units():
    """z is up in Blender, y here; lengths are metres."""
    bscene = empty()
    bscene.unit_settings.scale_length = 0.01
    link(mesh_of(CORNER, [(0, 1, 2)]), location=(10, 20, 30))
    points = triangles.of(translated())[0, :, :3]
    np.testing.assert_allclose(points[1], [0.11, 0.33, -0.22], atol=1e-9)
    assert translated().node_positions["thing"] == pytest.approx([0.1, 0.3, -0.2])


def test_shear():
    """A turned child of a stretched parent."""
    empty()
    parent = link(None, "parent", scale=(3, 1, 1))
    child = link(mesh_of(CORNER, [(0, 1, 2)]), "child", rotation_euler=(0, 0, np.pi / 4))
    child.parent = parent
    x, y, z = 3 * (1 - 2) / 2**0.5, (1 + 2) / 2**0.5, 3
    points = triangles.of(translated())[0, :, :3]
    np.testing.assert_allclose(points[1], [x, z, -y], atol=1e-6)


def test_objects_that_renders_do_not_show():
    """Switches of objects, collections and instancers."""
    bscene = empty()
    mesh = grid(1)
    link(mesh, "shown")
    link(mesh, "hidden").hide_render = True
    dark = bpy.data.collections.new("dark")
    dark.hide_render = True
    bscene.collection.children.link(dark)
    deep = bpy.data.collections.new("deep")
    dark.children.link(deep)
    for name, collection in (("in dark", dark), ("in deep", deep)):
        collection.objects.link(bpy.data.objects.new(name, mesh))
    both = link(mesh, "in both")
    dark.objects.link(both)
    source = copies(link(mesh, "source"), "VERTS")
    source.show_instancer_for_render = source.show_instancer_for_viewport = False
    link(mesh, "leaf", location=(0, 0, 1)).parent = source
    scene = translated()
    assert {instance.name for instance in scene.instances} == {"shown", "in both", "source"}
    assert len(places(scene, "source")) == 4


@pytest.mark.parametrize("kind", ["VERTS", "FACES"])
def test_what_is_copied_is_not_drawn_itself(kind):
    """Nor what is below it; Cycles does so, too."""
    empty()
    source = copies(link(grid(2), "source"), kind)
    leaf = link(grid(1), "leaf", location=(0, 0, 1))
    vein = link(grid(1), "vein", location=(0, 0, 1))
    leaf.parent, vein.parent = source, leaf
    found = [instance.name for instance in translated().instances]
    assert found == ["source"] * (1 + 2 * {"VERTS": 9, "FACES": 4}[kind])


def test_two_thousand_copies_are_one_mesh():
    """In memory once, at the vertices of the instancer, in under half a second."""
    empty()
    points = np.random.default_rng(1).normal(size=(2000, 3))
    source = copies(link(mesh_of(points.tolist(), []), "points"), "VERTS")
    link(grid(20, name="leaf"), "leaf").parent = source
    depsgraph = graph()
    begin = time.process_time()
    scene = scene_of(depsgraph, by=GREY)
    assert time.process_time() - begin < 0.5
    assert len(scene.meshes) == 1
    found = np.array([i.transform[:3, 3] for i in scene.instances])
    wanted = points[:, [0, 2, 1]] * [1, 1, -1]
    np.testing.assert_allclose(np.sort(found, axis=0), np.sort(wanted, axis=0), atol=1e-6)


def test_linked_objects_share_their_mesh():
    """Also if their slots have other materials."""
    empty()
    mesh = grid(2)
    mesh.materials.append(bpy.data.materials.new("first"))
    for k in range(3):
        thing = link(mesh, f"thing{k}")
        if k == 2:
            thing.material_slots[0].link = "OBJECT"
            thing.material_slots[0].material = bpy.data.materials.new("other")
    scene = translated()
    assert len(scene.meshes) == 1
    names = [scene.materials[i.material].name for i in scene.instances]
    assert names == ["first", "first", "other"]


def test_an_object_with_a_modifier_has_its_own_mesh():
    empty()
    mesh = grid(2)
    link(mesh, "plain")
    link(mesh, "thick").modifiers.new("s", "SOLIDIFY")
    scene = translated()
    assert [len(m.indices) for m in scene.meshes] == [8, 2 * 8 + 2 * 8]


def hidden_member():
    """A collection with an object that renders hide."""
    group = bpy.data.collections.new("group")
    for name, hides in (("seen", False), ("hidden", True)):
        member = bpy.data.objects.new(name, grid(1, name=name))
        member.hide_render = hides
        group.objects.link(member)
    link(None, "place", instance_type="COLLECTION", instance_collection=group)


def hidden_leaf():
    """An instancer whose child renders hide."""
    source = link(grid(1), "source", instance_type="VERTS")
    link(grid(1, name="leaf"), "leaf", hide_render=True).parent = source


def hidden_instancer():
    """An instancer that renders hide."""
    source = link(grid(1), "source", instance_type="VERTS", hide_render=True)
    link(grid(1, name="leaf"), "leaf").parent = source


def hidden_source_of_nodes():
    """Geometry nodes place an object that renders hide."""
    leaf = link(grid(1, name="leaf"), "leaf", hide_render=True)
    instances_by_nodes(link(grid(1), "field"), leaf, as_instance=True)


@pytest.mark.parametrize(
    "make", [hidden_member, hidden_leaf, hidden_instancer, hidden_source_of_nodes]
)
def test_the_viewport_shows_what_renders_show(make):
    """Both graphs give the same copies; Blender itself decides in that of a render."""
    bscene = empty()
    make()
    bscene.camera = link(bpy.data.cameras.new("c"), "c")
    viewport = translated()
    render, _ = in_a_render()
    found = [
        sorted((scene.meshes[i.mesh].name, i.name) for i in scene.instances)
        for scene in (viewport, render)
    ]
    assert found[0] == found[1]


def instances_by_nodes(thing, leaf, *, as_instance=False):
    """Geometry nodes that place an object at all vertices."""
    tree = bpy.data.node_groups.new("tree", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    first, last = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    place, info = (
        tree.nodes.new(kind) for kind in ("GeometryNodeInstanceOnPoints", "GeometryNodeObjectInfo")
    )
    info.inputs["Object"].default_value = leaf
    info.inputs["As Instance"].default_value = as_instance
    tree.links.new(first.outputs[0], place.inputs["Points"])
    tree.links.new(info.outputs["Geometry"], place.inputs["Instance"])
    tree.links.new(place.outputs[0], last.inputs[0])
    thing.modifiers.new("nodes", "NODES").node_group = tree


def test_instances_of_geometry_nodes():
    """One mesh, placed at all vertices, under the name of the object."""
    empty()
    leaf = link(grid(1, name="leaf"), "leaf", hide_render=True)
    thing = link(grid(3), "field", location=(0, 0, 2))
    instances_by_nodes(thing, leaf)
    scene = translated()
    assert [mesh.name for mesh in scene.meshes] == ["leaf"]
    assert len(scene.nodes["field"]) == len(scene.instances) == 16
    assert places(scene)[:, 1].mean() == pytest.approx(2, abs=0.1)


def test_collections_in_collections():
    """Nested instances multiply."""
    bscene = empty()
    inner, outer = bpy.data.collections.new("inner"), bpy.data.collections.new("outer")
    inner.objects.link(bpy.data.objects.new("leaf", grid(1)))
    for k in range(2):
        bough = bpy.data.objects.new(f"bough{k}", None)
        bough.instance_type, bough.instance_collection, bough.location = (
            "COLLECTION",
            inner,
            (k, 0, 0),
        )
        outer.objects.link(bough)
    for k in range(3):
        link(None, f"tree{k}", location=(0, 10 * k, 0), instance_type="COLLECTION",
             instance_collection=outer)  # fmt: skip
    assert bscene
    scene = translated()
    wanted = sorted([x, 0, -10.0 * y] for x in range(2) for y in range(3))
    assert sorted(places(scene).round(6).tolist()) == wanted
    assert len(scene.meshes) == 1


def test_nodes_are_objects():
    """A name stands for what is below it, too; empties have places."""
    empty()
    car = link(None, "car", location=(1, 2, 3))
    body = link(grid(1), "body")
    body.parent = car
    link(grid(1), "wheel").parent = body
    link(grid(1), "tree")
    scene = translated()
    assert {name: sorted(found) for name, found in scene.nodes.items()} == {
        "car": [0, 1], "body": [0, 1], "wheel": [1], "tree": [2],
    }  # fmt: skip
    np.testing.assert_allclose(scene.node_positions["car"], [1, 3, -2])


def test_catchers_and_holdouts():
    """Blender's switches, for the object itself and not for what is below it."""
    empty()
    floor = link(grid(1), "floor", is_shadow_catcher=True)
    link(grid(1), "table").parent = floor
    link(grid(1), "mask", is_holdout=True)
    found = {i.name: i.catcher for i in translated().instances}
    assert found["floor"] == ("shadow",)
    assert found["table"] is None
    assert found["mask"] not in (None, ("shadow",))


def test_lamps_catch_no_shadows():
    """Lamps have Blender's switch on, for the shadows that they cast; an area lamp stays a mesh."""
    empty()
    lamp = link(bpy.data.lights.new("lamp", "AREA"), "lamp")
    assert lamp.is_shadow_catcher
    found = {i.name: i.catcher for i in scene_of(graph()).instances}
    assert found == {"lamp": None}


def test_what_cannot_be_drawn_is_counted():
    """One note a kind; things without surfaces are none."""
    empty()
    for _ in range(2):
        bpy.ops.object.volume_add()
    bpy.ops.object.grease_pencil_add(type="STROKE")
    bpy.ops.object.pointcloud_random_add()
    bpy.ops.object.armature_add()
    link(None, "empty")
    link(grid(1), "flat", scale=(1, 0, 0))
    assert not translated().instances
    assert sorted(translated().warnings) == [
        "an object with a scale of 0 is left out (1 use)",
        "grease pencil drawings are left out (1 use)",
        "point clouds are left out (1 use)",
        "volumes are left out (2 uses)",
    ]


@pytest.mark.parametrize("number", [np.nan, 2e18])
def test_places_that_cannot_be_drawn(number):
    """One error that names the object."""
    empty()
    link(grid(1), "far", location=(number, 0, 0))
    with pytest.raises(dg.InputError, match=r"object 'far': transform: wanted"):
        translated()


def test_lights_cameras_and_the_world():
    """Each translator gets its things at their places; the camera of the scene comes first."""
    bscene = empty()
    link(bpy.data.lights.new("lamp", "POINT"), "lamp", location=(1, 2, 3))
    for name in ("a", "b"):
        link(bpy.data.cameras.new(name), name, rotation_euler=(np.pi / 2, 0, 0))
    bscene.camera = bpy.data.objects["b"]
    scene = translated()
    assert scene.default_camera == "b"
    assert sorted(scene.cameras) == ["a", "b"]
    ahead = -scene.camera("a").transform[:3, 2]
    np.testing.assert_allclose(ahead, [0, 0, -1], atol=1e-6)  # +y of Blender
    ((light, world),) = scene.lights
    assert light.name == "lamp"
    np.testing.assert_allclose(world[:3, 3], [1, 3, -2])
    assert scene.environment.color == (1, 1, 1)


def hair(counts, **attributes):
    """Curves with their points on a helix, and attributes (type, domain, values)."""
    data = bpy.data.hair_curves.new("hair")
    data.add_curves(counts)
    k = np.arange(sum(counts), dtype=np.float32)
    points = np.stack([np.cos(k), np.sin(k), 0.1 * k], axis=1)
    data.attributes["position"].data.foreach_set("vector", points.reshape(-1))
    for name, (kind, domain, values) in attributes.items():
        layer = data.attributes.get(name) or data.attributes.new(name, kind, domain)
        item = "vector" if kind == "FLOAT2" else "value"
        layer.data.foreach_set(item, np.asarray(values).reshape(-1))
    link(data, "hair")
    return points


def test_hair():
    """Splines through their points, with the radii and roots of Blender."""
    empty()
    points = hair(
        [3, 4],
        radius=("FLOAT", "POINT", np.linspace(0.1, 0.7, 7, dtype=np.float32)),
        surface_uv_coordinate=("FLOAT2", "CURVE", np.float32([0.1, 0.2, 0.3, 0.9])),
    )
    scene = translated()
    (curves,) = scene.meshes
    assert (len(curves.ends), len(curves.starts), curves.cubic) == (2, 2 + 3, True)
    ends = np.append(curves.positions[curves.starts], curves.positions[[-1]], axis=0)
    np.testing.assert_allclose(ends[:2], points[:2], atol=1e-6)
    np.testing.assert_allclose(ends[-1], points[-1], atol=1e-6)
    np.testing.assert_allclose(curves.radii[curves.starts[:2]], [0.1, 0.2], atol=1e-6)
    np.testing.assert_allclose(curves.uv, [[0.1, 0.8], [0.3, 0.1]], atol=1e-6)
    np.testing.assert_allclose(scene.instances[0].transform[:3, :3] @ [0, 0, 1], [0, 1, 0])


def test_kinds_of_hair():
    """Polylines and closed splines are meshes of their own; other kinds are counted."""
    empty()
    points = hair(
        [4, 4, 4, 4, 4, 1],
        cyclic=("BOOLEAN", "CURVE", np.array([0, 0, 0, 0, 1, 0], bool)),
    )
    for index, kind in ((1, "POLY"), (2, "BEZIER"), (3, "NURBS")):
        bpy.data.hair_curves["hair"].set_types(type=kind, indices=[index])
    scene = translated()
    kinds = [(mesh.cubic, mesh.closed, len(mesh.starts)) for mesh in scene.meshes]
    assert kinds == [(True, False, 3), (True, True, 4), (False, False, 3)]
    np.testing.assert_allclose(scene.meshes[2].positions, points[4:8], atol=1e-6)
    closed = np.roll(scene.meshes[1].positions[::3][:4], 1, axis=0)  # they begin at point 1
    np.testing.assert_allclose(closed, points[16:20], atol=1e-6)
    assert sorted(scene.warnings) == [
        "Bezier and NURBS hair curves are left out (2 uses)",
        "hair curves with too few points are left out (1 use)",
    ]


def fur(**settings):
    """A moved grid with straight hair of length 0.5."""
    thing = link(grid(3), "fur", location=(5, 6, 7), rotation_euler=(0.3, 0.4, 0.5))
    thing.data.materials.append(bpy.data.materials.new("skin"))
    for name in ("keratin", "horn"):
        thing.data.materials.append(bpy.data.materials.new(name))
    thing.modifiers.new("hair", "PARTICLE_SYSTEM")
    made = thing.particle_systems[0].settings
    made.type, made.count, made.hair_length, made.material = "HAIR", 20, 0.5, 2
    for name, value in settings.items():
        setattr(made, name, value)
    return thing


def test_particle_hair():
    """Strands stand on the surface and are as long as Blender says; the tip is closed."""
    empty()
    fur(root_radius=3.0, tip_radius=1.0, radius_scale=0.02)
    scene = translated()
    mine = next(i for i in scene.instances if len(scene.meshes[i.mesh].indices) == 0)
    assert scene.materials[mine.material].name == "keratin"
    curves = scene.meshes[mine.mesh]
    assert len(curves.ends) == 20
    strands = curves.positions.reshape(20, -1, 3)[:, ::3]  # ends of segments
    steps = np.linalg.norm(np.diff(strands, axis=1), axis=2)
    np.testing.assert_allclose(steps.sum(axis=1), 0.5, rtol=0.05)
    root = strands[:, 0]
    np.testing.assert_allclose(root[:, 2], 0.1 * np.sin(6 * root[:, 0]) * np.cos(5 * root[:, 1]),
                               atol=0.08)  # fmt: skip
    np.testing.assert_allclose(mine.transform[:3, 3], [5, 7, -6], atol=1e-6)
    radii = curves.radii.reshape(20, -1)
    np.testing.assert_allclose(radii[:, 0], 0.03, rtol=1e-5)
    np.testing.assert_allclose(radii[:, -1], 0, atol=1e-7)


def test_particle_hair_in_a_render():
    """With the detail of renders."""
    bscene = empty()
    fur(render_step=4, display_step=2)
    bscene.camera = link(bpy.data.cameras.new("c"), "c")
    scene, _ = in_a_render()
    (curves,) = (mesh for mesh in scene.meshes if not len(mesh.indices))
    assert len(curves.starts) == 20 * 16
    strands = curves.positions.reshape(20, -1, 3)[:, ::3]
    lengths = np.linalg.norm(np.diff(strands, axis=1), axis=2).sum(axis=1)
    np.testing.assert_allclose(lengths, 0.5, rtol=0.05)


def test_children_of_particle_hair():
    """They replace their parents unless these are asked for; copies share the strands."""
    empty()
    thing = fur(child_type="SIMPLE", child_percent=3, rendered_child_count=3)
    group = bpy.data.collections.new("group")
    group.objects.link(thing)
    link(None, "place", location=(9, 0, 0), instance_type="COLLECTION", instance_collection=group)
    scene = translated()
    assert [len(m.ends) for m in scene.meshes if not len(m.indices)] == [60]
    assert sum(not len(scene.meshes[i.mesh].indices) for i in scene.instances) == 2
    thing.particle_systems[0].settings.use_parent_particles = True
    scene = translated()
    assert [len(m.ends) for m in scene.meshes if not len(m.indices)] == [80]


def resident_mb():
    """Memory of this process, MB."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * 4096 / 1e6


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="needs /proc")
def test_fifty_translations_leak_nothing():
    """With motion; a single mesh that stayed would be 25 MB in all."""
    bscene = empty()
    bscene.render.use_motion_blur = True
    mesh = grid(120)
    mesh.shade_smooth()
    thing = link(mesh)
    key(thing, "location", [(1, (0, 0, 0)), (3, (1, 0, 0))])
    thing.modifiers.new("wave", "WAVE")
    size = sum(a.nbytes for a in (translated().meshes[0].positions, translated().meshes[0].indices))
    for _ in range(5):
        translated()
    gc.collect()
    before = resident_mb()
    for _ in range(50):
        translated()
    gc.collect()
    assert resident_mb() - before < 50 * size / 1e6 / 4


def test_a_picture():
    """The translated scene renders."""
    bscene = empty()
    link(grid(4, 4), location=(-2, -2, 0))
    bscene.camera = link(bpy.data.cameras.new("c"), "c", location=(0, 0, 5))
    frame = dg.render(translated(), resolution=(8, 8), spp=16)
    assert frame.rgb[2:6, 2:6].mean() == pytest.approx(0.5, rel=0.1)
