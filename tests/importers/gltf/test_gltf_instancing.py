"""EXT_mesh_gpu_instancing, KHR_node_visibility, and what stands below turned and mirrored nodes."""

from __future__ import annotations

import math
import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import daguerre
from daguerre.errors import InputError
from daguerre.importers.gltf import placing as gltf_placing
from daguerre.importers.gltf import reader as gltf
from daguerre.setup import camera as camera_setup
from daguerre.setup import focus as focusing
from tests.support.formats.make_gltf import CORNERS, Builder, triangle

HALF = math.sqrt(0.5)


def instanced(b: Builder, node: int = 0, **columns) -> Builder:
    extension = {"EXT_mesh_gpu_instancing": {"attributes": columns}}
    b.json["nodes"][node].setdefault("extensions", {}).update(extension)
    return b


def load(b: Builder, tmp_path, time: float = 0.0):
    return gltf.read(b.glb(tmp_path / "a.glb"), time=time)


def test_node_times_instance(tmp_path):
    b = triangle()
    b.json["nodes"][0].update(translation=[100, 0, 0], scale=[2, 2, 2])
    instanced(
        b,
        TRANSLATION=b.accessor([[1, 0, 0], [0, 1, 0]]),
        ROTATION=b.accessor([[0, 0, 0, 1], [0, 0, HALF, HALF]]),
        SCALE=b.accessor([[1, 1, 1], [3, 4, 5]]),
        _ID=b.accessor([7, 8], "u2"),
    )
    scene = load(b, tmp_path)
    wanted = [
        [[2, 0, 0, 102], [0, 2, 0, 0], [0, 0, 2, 0], [0, 0, 0, 1]],
        # 100 + 2 (T R S): the first axis, times 3, turns to y; the second, times 4, to -x.
        [[0, -8, 0, 100], [6, 0, 0, 2], [0, 0, 10, 0], [0, 0, 0, 1]],
    ]
    assert len(scene.instances) == 2
    for instance, matrix in zip(scene.instances, wanted, strict=True):
        assert instance.transform == pytest.approx(np.array(matrix), abs=1e-5)
        assert instance.name == "tri"
    assert scene.nodes == {"tri": [0, 1]}
    assert scene.node_positions["tri"].tolist() == [100, 0, 0]
    assert scene.warnings == []


def test_each_column_may_be_absent(tmp_path):
    for name, values, wanted in (
        ("TRANSLATION", [[1, 2, 3]], [[1, 0, 0, 1], [0, 1, 0, 2], [0, 0, 1, 3]]),
        ("ROTATION", [[0, 0, 2, 2]], [[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0]]),
        ("SCALE", [[2, 3, -4]], [[2, 0, 0, 0], [0, 3, 0, 0], [0, 0, -4, 0]]),
    ):
        b = triangle()
        instanced(b, **{name: b.accessor(values)})
        (instance,) = load(b, tmp_path).instances
        assert instance.transform[:3] == pytest.approx(np.array(wanted), abs=1e-12)


@pytest.mark.parametrize(("dtype", "whole"), [("i1", 127), ("i2", 32767)])
def test_quantized_rotation(tmp_path, dtype, whole):
    b = triangle()
    values = np.round(np.array([[0, 0, HALF, HALF], [0, 0, 0, -1]]) * whole)
    instanced(b, ROTATION=b.accessor(values, dtype, normalized=True))
    first, second = (i.transform[:3, :3] for i in load(b, tmp_path).instances)
    assert first == pytest.approx(np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]]), abs=1e-12)
    assert second == pytest.approx(np.eye(3), abs=1e-12)


def test_hidden_and_flat_instances_among_others(tmp_path):
    b = triangle()
    instanced(b, SCALE=b.accessor([[1, 1, 1], [0, 0, 0], [1, 0, 1], [2, 2, 2]]))
    scene = load(b, tmp_path)
    assert [i.transform[0, 0] for i in scene.instances] == [1, 1, 2]
    assert scene.meshes[scene.instances[1].mesh].positions[:, 1].tolist() == [0, 0, 0]
    assert scene.nodes == {"tri": [0, 1, 2]}
    assert "scales to zero is left out (1 use)" in scene.warnings[0]


def test_other_attributes_and_empty_ones(tmp_path):
    b = triangle()
    b.node(mesh=0, name="plain")
    instanced(b, COLOR=b.accessor([[1, 1, 1]] * 3))
    instanced(b, 1)
    scene = load(b, tmp_path)
    assert len(scene.instances) == 2
    assert scene.warnings == ["instance attribute 'COLOR' is not used (1 use)"]


def test_a_skinned_mesh_is_shown_once(tmp_path):
    b = triangle()
    attributes = b.json["meshes"][0]["primitives"][0]["attributes"]
    attributes["JOINTS_0"] = b.accessor([[0, 0, 0, 0]] * 3, "u1")
    attributes["WEIGHTS_0"] = b.accessor([[1, 0, 0, 0]] * 3)
    b.add("skins", {"joints": [0]})
    b.json["nodes"][0]["skin"] = 0
    instanced(b, TRANSLATION=b.accessor([[1, 0, 0], [0, 1, 0]]))
    scene = load(b, tmp_path)
    assert len(scene.instances) == 1
    assert "shown once, not at its instances" in scene.warnings[0]


def test_a_hundred_thousand_instances_are_quick(tmp_path):
    rng = np.random.default_rng(3)
    b = triangle()
    turns = rng.normal(size=(100_000, 4))
    turns /= np.linalg.norm(turns, axis=1, keepdims=True)
    places = rng.normal(size=(100_000, 3)).astype(np.float32)
    instanced(b, TRANSLATION=b.accessor(places), ROTATION=b.accessor(turns))
    start = time.perf_counter()
    scene = load(b, tmp_path)
    assert time.perf_counter() - start < 20
    assert len(scene.instances) == 100_000
    assert np.array_equal([i.transform[:3, 3] for i in scene.instances], places)


E = r"nodes\[0\]\.extensions\.EXT_mesh_gpu_instancing\.attributes"
BAD = {
    "attributes is a list": ([], E + ": wrong type: wanted an object"),
    "accessor": ({"SCALE": 99}, E + r"\.SCALE: index out of range"),
    "counts": (
        {"TRANSLATION": [[0, 0, 0]] * 2, "SCALE": [[1, 1, 1]] * 3},
        E + r"\.SCALE: wrong count: wanted 2 like the other attributes, got 3",
    ),
    "count of custom": (
        {"TRANSLATION": [[0, 0, 0]] * 2, "_ID": [1, 2, 3]},
        E + r"\._ID: wrong count: wanted 2 like the other attributes, got 3",
    ),
    "type": ({"ROTATION": [[0, 0, 0]]}, E + r"\.ROTATION: wrong accessor type: wanted VEC4"),
    "turn": (
        {"ROTATION": [[0, 0, 0, 1], [0, 0, 0, 0]]},
        E + r"\.ROTATION: instance 1: wanted a quaternion of length 1",
    ),
    "NaN": ({"SCALE": [[1, 1, math.nan]]}, E + r"\.SCALE: instance 0: wanted finite numbers"),
    "far": ({"TRANSLATION": [[1e30, 0, 0]]}, r"nodes\[0\]: world transform: wanted numbers below"),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_instances(tmp_path, case):
    columns, wanted = BAD[case]
    b = triangle()
    if isinstance(columns, dict):
        columns = {k: v if isinstance(v, int) else b.accessor(v) for k, v in columns.items()}
    b.json["nodes"][0]["extensions"] = {"EXT_mesh_gpu_instancing": {"attributes": columns}}
    with pytest.raises(InputError, match=wanted):
        load(b, tmp_path)


def test_a_column_of_zeros_without_bytes_has_an_end(tmp_path, monkeypatch):
    b = triangle()
    zeros = {"componentType": 5126, "count": 1 << 22, "type": "VEC3"}
    instanced(b, TRANSLATION=b.add("accessors", zeros))
    with pytest.raises(InputError, match=r"wanted at most \d+ instances, got 4194304"):
        load(b, tmp_path)
    monkeypatch.setattr(gltf_placing, "MAX_INSTANCES", 1000)
    b = triangle()
    instanced(b, TRANSLATION=b.add("accessors", zeros | {"count": 300}))
    b.json["meshes"][0]["primitives"] *= 4
    with pytest.raises(
        InputError, match=r"nodes\[0\]: too many instances in a scene: the limit is 1000"
    ):
        load(b, tmp_path)


def test_focus_on_one_of_many_instances_and_on_a_skin(tmp_path, monkeypatch):
    monkeypatch.setattr(focusing, "_VERTICES_AT_ONCE", 7)
    b = triangle()
    instanced(b, TRANSLATION=b.accessor([[0, 0, -z] for z in (9, 3, 5, 4, 8, 7)]))
    attributes = {"POSITION": b.accessor(np.array(CORNERS) - (9, 9, 2))}
    attributes["JOINTS_0"] = b.accessor([[0, 0, 0, 0]] * 3, "u1")
    attributes["WEIGHTS_0"] = b.accessor([[1, 0, 0, 0]] * 3)
    b.mesh(attributes)
    b.add("skins", {"joints": [1]})
    b.node(translation=[0, 0, -4])
    b.node(mesh=1, skin=0, name="skin", translation=[0, 0, -100])
    scene = load(b, tmp_path)
    for name, depth in (("tri", 3), ("skin", 6)):
        camera = daguerre.Camera(focus_on=name)
        setup = camera_setup.set_up(scene, camera, (30, 20), None)
        assert setup.lens.focus_distance_m == pytest.approx(depth)


# Visibility ------------------------------------------------------------------------------------


def test_invisible_nodes_hide_meshes_and_lights_below_but_no_cameras(tmp_path):
    b = triangle()
    b.add("cameras", {"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}})
    b.json["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "point"}]}}
    shown = {"KHR_node_visibility": {"visible": True}}
    lamp = {"extensions": {"KHR_lights_punctual": {"light": 0}}}
    leaf = b.child(mesh=0, name="leaf", extensions=shown)
    light, camera = b.child(**lamp), b.child(camera=0, name="eye", translation=[1, 2, 3])
    mid = b.child(children=[leaf, light, camera], extensions=shown)
    hidden = {"KHR_node_visibility": {"visible": False}}
    b.node(children=[mid], mesh=0, name="top", extensions=hidden)
    b.node(mesh=0, name="other", extensions={"KHR_node_visibility": {}})
    scene = load(b, tmp_path)
    assert [i.name for i in scene.instances] == ["tri", "other"]
    assert scene.nodes["top"] == scene.nodes["leaf"] == []
    assert scene.lights == []
    assert list(scene.cameras) == ["eye"]
    assert scene.node_positions["eye"].tolist() == [1, 2, 3]
    assert scene.warnings == []


def test_an_invisible_joint_still_moves_its_skin(tmp_path):
    b = triangle()
    attributes = b.json["meshes"][0]["primitives"][0]["attributes"]
    attributes["JOINTS_0"] = b.accessor([[0, 0, 0, 0]] * 3, "u1")
    attributes["WEIGHTS_0"] = b.accessor([[1, 0, 0, 0]] * 3)
    b.add("skins", {"joints": [1]})
    b.json["nodes"][0]["skin"] = 0
    b.node(translation=[7, 0, 0], extensions={"KHR_node_visibility": {"visible": False}})
    assert load(b, tmp_path).meshes[0].positions[0].tolist() == [7, 0, 0]


@pytest.mark.parametrize("value", [0, None, "no", {}])
def test_visible_is_true_or_false(tmp_path, value):
    b = triangle()
    b.json["nodes"][0]["extensions"] = {"KHR_node_visibility": {"visible": value}}
    with pytest.raises(InputError, match=r"KHR_node_visibility\.visible: wrong type: wanted true"):
        load(b, tmp_path)


# Trees of any transforms -----------------------------------------------------------------------


def turn(x: float, y: float, z: float, w: float) -> np.ndarray:
    """By the definition: v -> q v q*, written with cross products."""
    u = np.array([x, y, z])
    basis = np.eye(3)
    return np.stack([e + 2 * np.cross(u, np.cross(u, e) + w * e) for e in basis], axis=1)


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_shear_and_mirrors_against_points_carried_up(tmp_path_factory, seed):
    """A point is scaled, turned and shifted at each node on its way up."""
    rng = np.random.default_rng(seed)
    b = Builder()
    position = rng.normal(size=(3, 3)).astype(np.float32)
    b.mesh({"POSITION": b.accessor(position)})
    points, below = position.astype(np.float64), []
    for level in range(4):
        scale = rng.uniform(0.2, 3, 3) * rng.choice([-1, 1], 3)
        q = rng.normal(size=4)
        q /= np.linalg.norm(q)
        shift = rng.normal(size=3)
        points = (points * scale) @ turn(*q).T + shift
        node = {"scale": scale.tolist(), "rotation": q.tolist(), "translation": shift.tolist()}
        carried = {"children": below} if below else {"mesh": 0}
        below = [(b.node if level == 3 else b.child)(**node, **carried)]
    (instance,) = load(b, tmp_path_factory.mktemp("tree")).instances
    world = position @ instance.transform[:3, :3].T + instance.transform[:3, 3]
    assert world == pytest.approx(points, abs=1e-9)
