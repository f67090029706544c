"""Motion of Blender's objects while the shutter is open, from sub-frames."""

from types import SimpleNamespace

import numpy as np
import pytest

import daguerre as dg
from daguerre.blender.motion import exposure_of
from tests.support.pictures import blur

from .building import (
    bpy,
    empty,
    graph,
    grid,
    in_a_render,
    key,
    link,
    mesh_of,
    straighten,
    translated,
)

FPS = 24.0


def opened(length=0.5, position="CENTER", frame=2):
    """An empty file with motion blur, at a frame."""
    bscene = empty()
    bscene.render.use_motion_blur = True
    bscene.render.motion_blur_shutter = length
    bscene.render.motion_blur_position = position
    bscene.frame_set(frame)
    return bscene


def slide(thing, to=(2, 0, 0)):
    """Moves a thing by ``to`` from frame 1 to 3, evenly."""
    key(thing, "location", [(1, (0, 0, 0)), (3, to)])
    straighten()
    bpy.context.scene.frame_set(2)


@pytest.mark.parametrize(("position", "begin"), [("START", 0.0), ("CENTER", -0.25), ("END", -0.5)])
def test_times_and_places(position, begin):
    """Keys over Blender's shutter, in seconds; the list shows the frame itself."""
    bscene = opened(0.5, position)
    bscene.unit_settings.scale_length = 0.1
    slide(link(grid(1), "mover"))
    link(grid(1), "rests")
    scene = translated(time=5.0)
    assert list(scene.motion.instances) == [scene.nodes["mover"][0]]
    (path,) = scene.motion.instances.values()
    frames = begin + np.array([0, 0.25, 0.5])
    np.testing.assert_allclose(path.times, 5 + frames / FPS, atol=1e-9)
    np.testing.assert_allclose([m[0, 3] for m in path.values], 0.1 * (1 + frames), atol=1e-6)
    now = scene.instances[scene.nodes["mover"][0]].transform
    np.testing.assert_allclose(now[0, 3], 0.1, atol=1e-6)
    where = scene.motion.node_positions["mover"].at(5 + 0.2 * begin / FPS)
    np.testing.assert_allclose(where, [0.1 * (1 + 0.2 * begin), 0, 0], atol=1e-6)
    assert not scene.motion.meshes


def test_the_frame_is_restored():
    """With its fraction, also if the translation fails."""
    bscene = opened()
    slide(link(grid(1, name="broken"), "mover"))
    bscene.frame_set(2, subframe=0.375)
    translated()
    assert (bscene.frame_current, bscene.frame_subframe) == (2, 0.375)
    bpy.data.meshes["broken"].vertices[0].co = (np.nan, 0, 0)
    bpy.data.meshes["broken"].update()
    with pytest.raises(dg.InputError):
        translated()
    assert (bscene.frame_current, bscene.frame_subframe) == (2, 0.375)


def test_no_blur():
    """Blender's switch, and an interval without length; another interval replaces Blender's."""
    bscene = opened()
    slide(link(grid(1)))
    assert not translated(shutter=(0.0, 0.0)).motion
    (path,) = translated(shutter=(-1 / FPS, 0.5 / FPS)).motion.instances.values()
    np.testing.assert_allclose(path.times * FPS, [-1, -0.25, 0.5])
    bscene.render.use_motion_blur = False
    assert exposure_of(bscene, None) is None
    assert not translated().motion


@pytest.mark.parametrize(
    ("panel", "frames"),
    [
        ({}, (-0.25, 0.25)),
        ({"shutter_mode": "blender"}, (-0.25, 0.25)),
        ({"shutter_mode": "angle", "shutter_angle": 360.0}, (-0.5, 0.5)),
        ({"shutter_mode": "time", "shutter_time": 0.25}, (-3, 3)),
        ({"shutter_mode": "time", "shutter_time": 0.0}, None),
        (
            {"shutter_mode": "time", "shutter_time": 1 / FPS, "rolling_side": "top",
             "rolling_time": 1 / FPS},
            (-1, 1),
        ),
    ],
)  # fmt: skip
def test_the_exposure_is_that_of_the_panel(panel, frames):
    """Else of Blender's motion blur; lines that are read in turn make it longer."""
    bscene = opened()
    bscene.render.resolution_y = 1000
    data = SimpleNamespace(daguerre=SimpleNamespace(**panel))
    found = exposure_of(bscene, SimpleNamespace(data=data))
    if frames is None:
        assert found is None
    else:
        np.testing.assert_allclose(np.array(found) * FPS, frames, atol=2e-3)


def test_what_rests_costs_no_frames():
    """A caller's own way to frames is used; nothing is kept of what rests."""
    opened()
    link(grid(1), "rests").modifiers.new("s", "SUBSURF")
    visited = []
    scene = translated(frame_set=lambda frame, part: visited.append((frame, part)))
    assert visited == [(1, 0.75), (2, 0.25), (2, 0.0)]
    assert not scene.motion


def test_settings_of_objects():
    """Cycles' switches and steps, each object its own."""
    opened()
    for name, steps, moves in (("few", 1, True), ("many", 3, True), ("none", 2, False)):
        thing = link(grid(1), name)
        slide(thing)
        thing.cycles.motion_steps, thing.cycles.use_motion_blur = steps, moves
    scene = translated()
    counts = {
        scene.instances[i].name: len(path.times) for i, path in scene.motion.instances.items()
    }
    assert counts == {"few": 3, "many": 9}


def test_what_moves_by_others():
    """Parents, constraints, drivers and copies; one mesh for all copies."""
    opened()
    leader = link(None, "leader")
    slide(leader)
    link(grid(1), "child").parent = leader
    link(grid(1), "follower").constraints.new("COPY_LOCATION").target = leader
    driven = link(grid(1), "driven")
    driven.driver_add("location", 1).driver.expression = "frame"
    source = link(mesh_of([(0, 0, 0), (0, 1, 0)], []), "source", instance_type="VERTS")
    link(grid(1, name="leaf"), "leaf").parent = source
    source.parent = leader
    link(grid(1), "rests")
    scene = translated()
    names = [scene.instances[i].name for i in scene.motion.instances]
    assert sorted(names) == ["child", "driven", "follower", "source", "source"]
    child = scene.nodes["child"][0]
    np.testing.assert_allclose(scene.motion.instances[child].at(-0.25 / FPS)[0, 3], 0.75, atol=1e-6)
    assert sum(mesh.name == "leaf" for mesh in scene.meshes) == 1


def bent(bscene, steps=1):
    """A bar of two bones; the upper one bends from frame 1 to 3."""
    mesh = grid(6, 2.0, name="bar")
    data = bpy.data.armatures.new("bones")
    bones = link(data, "bones")
    bpy.context.view_layer.objects.active = bones
    bpy.ops.object.mode_set(mode="EDIT")
    for k in range(2):
        bone = data.edit_bones.new(f"bone{k}")
        bone.head, bone.tail = (0, k, 0), (0, k + 1, 0)
    bpy.ops.object.mode_set(mode="OBJECT")
    bar = link(mesh, "bar")
    for k in range(2):
        group = bar.vertex_groups.new(name=f"bone{k}")
        group.add([v.index for v in mesh.vertices if (v.co.y > 1) == (k == 1)], 1, "REPLACE")
    bar.modifiers.new("armature", "ARMATURE").object = bones
    bar.cycles.motion_steps = steps
    pose = bones.pose.bones["bone1"]
    pose.rotation_mode = "XYZ"
    key(pose, "rotation_euler", [(1, (0, 0, -0.5)), (3, (0, 0, 0.5))])
    straighten()
    bscene.frame_set(2)
    return bar


def shaped(bscene, steps=1):
    """A grid whose shape key rises from frame 1 to 3."""
    thing = link(grid(6, 2.0, name="bar"), "bar")
    thing.shape_key_add(name="base")
    shape = thing.shape_key_add(name="up")
    for point in shape.data:
        point.co.x += 0.8 * point.co.y
    key(shape, "value", [(1, 0.0), (3, 1.0)])
    thing.cycles.motion_steps = steps
    straighten()
    bscene.frame_set(2)
    return thing


@pytest.mark.parametrize("make", [bent, shaped], ids=["armature", "shape key"])
def test_points_over_time(make):
    """Vertices at each step are those that Blender has at that moment."""
    bscene = opened(1.0)
    thing = make(bscene, steps=2)
    scene = translated()
    (mesh,) = scene.motion.meshes
    for offset in np.linspace(-0.5, 0.5, 5):
        bscene.frame_set(int(np.floor(2 + offset)), subframe=offset % 1)
        evaluated = thing.evaluated_get(graph()).data
        wanted = np.array([vertex.co for vertex in evaluated.vertices])
        found = scene.motion.meshes[mesh].at(offset / FPS).positions
        np.testing.assert_allclose(
            found[np.lexsort(found.round(4).T)], wanted[np.lexsort(wanted.round(4).T)], atol=1e-6
        )
        assert np.abs(found - scene.meshes[mesh].positions).max() > 0.05 or offset == 0
    assert not scene.motion.instances


def test_points_that_rest_by_setting():
    """Without deformation only the transform moves."""
    bscene = opened()
    thing = shaped(bscene)
    slide(thing)
    thing.cycles.use_deform_motion = False
    scene = translated()
    assert not scene.motion.meshes
    assert scene.motion.instances


def test_vertices_that_become_more():
    """A note, and the mesh of the frame."""
    opened()
    thing = link(grid(1), "growing")
    array = thing.modifiers.new("array", "ARRAY")
    array.driver_add("count").driver.expression = "1 + int(frame > 2)"
    scene = translated()
    assert not scene.motion.meshes
    assert scene.warnings == [
        "a mesh that gains or loses vertices while the shutter is open is drawn without motion "
        "(1 use)"
    ]


def test_lights_and_cameras_move():
    """By place, energy and focal length."""
    bscene = opened()
    lamp = bpy.data.lights.new("lamp", "POINT")
    slide(link(lamp, "lamp"))
    key(lamp, "energy", [(1, 10.0), (3, 30.0)])
    lens = bpy.data.cameras.new("c")
    bscene.camera = link(lens, "c")
    slide(bscene.camera, (0, 2, 0))
    key(lens, "lens", [(1, 20.0), (3, 60.0)])
    straighten()
    bscene.frame_set(2)
    scene = translated(time=1.0)
    light, world = scene.motion.lights[0].at(1 + 0.25 / FPS)
    assert light.intensity == pytest.approx((22.5,) * 3)
    assert world[0, 3] == pytest.approx(1.25)
    assert scene.lights[0][0].intensity == pytest.approx((20,) * 3)
    camera = scene.camera()
    assert sorted(camera.motion) == ["focal_length", "transform"]
    assert camera.focal_length == pytest.approx(40)
    then = camera.evaluated_at(1 - 0.25 / FPS)
    assert then.focal_length == pytest.approx(35)
    assert then.transform[2, 3] == pytest.approx(-0.75)


def test_curves_that_become_thick():
    """Text and curves, which Blender turns into meshes, deform, too."""
    bscene = opened(1.0)
    data = bpy.data.curves.new("c", "CURVE")
    data.dimensions = "3D"
    data.splines.new("POLY").points.add(1)
    data.splines[0].points[1].co = (0, 3, 0, 1)
    key(data, "bevel_depth", [(1, 0.1), (3, 0.3)])
    link(data, "cable")
    straighten()
    bscene.frame_set(2)
    scene = translated()
    (mesh,) = scene.motion.meshes
    widths = [scene.motion.meshes[mesh].at(t / FPS).positions[:, 0].max() for t in (-0.5, 0, 0.5)]
    assert widths == pytest.approx([0.15, 0.2, 0.25], abs=1e-5)


def lifted_by_frames(thing):
    """Geometry nodes that lift points by the number of the frame."""
    tree = bpy.data.node_groups.new("lift", "GeometryNodeTree")
    for side in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=side, socket_type="NodeSocketGeometry")
    kinds = ("NodeGroupInput", "GeometryNodeInputSceneTime", "ShaderNodeCombineXYZ",
             "GeometryNodeSetPosition", "NodeGroupOutput")  # fmt: skip
    first, clock, vector, lift, last = (tree.nodes.new(kind) for kind in kinds)
    tree.links.new(clock.outputs["Frame"], vector.inputs["Z"])
    tree.links.new(vector.outputs[0], lift.inputs["Offset"])
    tree.links.new(first.outputs[0], lift.inputs["Geometry"])
    tree.links.new(lift.outputs[0], last.inputs[0])
    thing.modifiers.new("nodes", "NODES").node_group = tree


def test_hair_moves():
    """Control points that a deformation moves, and no transform."""
    opened()
    data = bpy.data.hair_curves.new("hair")
    data.add_curves([3])
    positions = np.float32([[0, 0, 0], [1, 0, 0], [2, 0, 0]])
    data.attributes["position"].data.foreach_set("vector", positions.reshape(-1))
    lifted_by_frames(link(data, "hair"))
    scene = translated()
    assert not scene.motion.instances
    for offset in (-0.25, 0.1, 0.25):
        heights = scene.motion.meshes[0].at(offset / FPS).positions[:, 2]
        np.testing.assert_allclose(heights, 2 + offset, atol=1e-5)


def seen_from_above(bscene):
    """A camera above the bar."""
    data = bpy.data.cameras.new("c")
    bscene.camera = link(data, "c", location=(1, 1, 6))


@pytest.mark.parametrize("make", [bent, shaped], ids=["armature", "shape key"])
def test_blurred_is_the_mean_of_stills(make):
    """Stills are Blender's own frames at random moments, without motion of ours."""
    bscene = opened(1.0)
    make(bscene, steps=3)
    seen_from_above(bscene)
    scene = translated()
    camera = scene.camera().with_(shutter_time=1 / FPS)

    def still(t):
        place = 2 + t * FPS
        bscene.frame_set(int(np.floor(place)), subframe=place % 1)
        frozen = translated(shutter=(0.0, 0.0))
        return frozen, camera.with_(shutter_time=0.0)

    half = 0.5 / FPS
    case = blur.Case(scene, camera, (-half, half), still)
    stills = blur.mean_of_stills(case, batches=8, moments=8, spp=8)
    assert not blur.disagreement(blur.blurred(case, batches=8, spp=64), stills)
    late = blur.Case(scene, camera, (0.0, 2 * half), still)
    shifted = blur.mean_of_stills(late, batches=8, moments=8, spp=8)
    assert blur.disagreement(blur.blurred(case, batches=8, spp=64), shifted)  # it can tell


def test_in_a_render_of_blender():
    """The graph of a render has its own switches; its engine goes to frames."""
    bscene = opened(1.0)
    seen_from_above(bscene)
    slide(link(grid(1), "mover"))
    thing = shaped(bscene)
    thing.modifiers.new("s", "SUBSURF").render_levels = 2
    link(grid(1), "viewport only").hide_render = True
    link(grid(1), "render only").hide_viewport = True
    scene, frame = in_a_render()
    assert frame == 2
    assert {i.name for i in scene.instances} == {"mover", "bar", "render only"}
    (path,) = scene.motion.instances.values()
    np.testing.assert_allclose([m[0, 3] for m in path.values], [0.5, 1, 1.5], atol=1e-6)
    (mesh,) = scene.motion.meshes
    assert len(scene.meshes[mesh].indices) == 2 * 36 * 16
    ends = [scene.motion.meshes[mesh].at(t / FPS).positions[:, 0].max() for t in (-0.5, 0.5)]
    assert ends == pytest.approx([2 + 1.6 * 0.25, 2 + 1.6 * 0.75], abs=0.1)
