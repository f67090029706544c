"""Skins: vertices computed by hand, and against a second way to the same numbers."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from daguerre.errors import InputError
from daguerre.importers.gltf import reader as gltf
from daguerre.scene import skinning
from tests.support.formats.make_gltf import CORNERS, Builder

HALF = math.sqrt(0.5)
QUARTER = [0, 0, HALF, HALF]  # 90 degrees about z


def columns(*matrices):
    """Matrices in a file's order."""
    return [np.asarray(m).T.ravel() for m in matrices]


def shift(x, y, z):
    matrix = np.eye(4)
    matrix[:3, 3] = x, y, z
    return matrix


def skinned(joints, weights, bind=None, dtype="u1", **attributes) -> Builder:
    """A triangle at node 0 with joints at nodes 1 and 2, the second below the first."""
    b = Builder()
    b.mesh(
        {
            "POSITION": b.accessor(CORNERS),
            "JOINTS_0": b.accessor(joints, dtype),
            "WEIGHTS_0": b.accessor(weights),
        }
        | {name: b.accessor(values) for name, values in attributes.items()}
    )
    b.node(mesh=0, skin=0, name="body", translation=[50, 60, 70], scale=[9, 9, 9])
    b.node(name="root", children=[2])
    b.child(name="arm", translation=[0, 2, 0])
    b.add("skins", {"joints": [1, 2]})
    if bind is not None:
        b.json["skins"][0]["inverseBindMatrices"] = b.accessor(columns(*bind))
    return b


def load(b: Builder, tmp_path, time: float = 0.0):
    return gltf.read(b.glb(tmp_path / "a.glb"), time=time)


ROOT, ARM = [[0, 0, 0, 0]] * 3, [[1, 0, 0, 0]] * 3
ALL = [[1, 0, 0, 0]] * 3


def test_rest_pose_ignores_the_node_of_the_mesh(tmp_path):
    scene = load(skinned(ARM, ALL, bind=[np.eye(4), shift(0, -2, 0)]), tmp_path)
    assert scene.meshes[0].positions.tolist() == CORNERS
    assert scene.instances[0].transform.tolist() == np.eye(4).tolist()
    assert scene.instances[0].name == "body"
    assert scene.nodes["body"] == [0]
    assert scene.node_positions["body"].tolist() == [50, 60, 70]
    assert scene.warnings == []


def test_without_bind_matrices_a_joint_is_where_it_is(tmp_path):
    scene = load(skinned(ARM, ALL), tmp_path)
    assert scene.meshes[0].positions.tolist() == [[0, 2, 0], [1, 2, 0], [0, 3, 0]]


def test_a_turned_joint_carries_normals_and_tangents(tmp_path):
    b = skinned(
        ARM,
        ALL,
        bind=[np.eye(4), shift(0, -2, 0)],
        NORMAL=[[1, 0, 0]] * 3,
        TANGENT=[[0, 1, 0, -1]] * 3,
    )
    b.json["nodes"][2]["rotation"] = QUARTER
    mesh = load(b, tmp_path).meshes[0]
    # About (0, 2, 0): (x, y) -> (2 - y, 2 + x).
    assert mesh.positions == pytest.approx(np.array([[2, 2, 0], [2, 3, 0], [1, 2, 0]]))
    assert mesh.normals == pytest.approx(np.array([[0, 1, 0]] * 3), abs=1e-7)
    assert mesh.tangents == pytest.approx(np.array([[-1, 0, 0, -1]] * 3), abs=1e-7)


def test_normals_follow_the_inverse_transpose(tmp_path):
    b = skinned(ROOT, ALL, NORMAL=[[HALF, HALF, 0]] * 3, TANGENT=[[HALF, -HALF, 0, 1]] * 3)
    b.json["nodes"][1]["scale"] = [2, 1, 1]
    mesh = load(b, tmp_path).meshes[0]
    fifth = math.sqrt(0.2)
    assert mesh.normals == pytest.approx(np.array([[fifth, 2 * fifth, 0]] * 3))
    assert mesh.tangents == pytest.approx(np.array([[2 * fifth, -fifth, 0, 1]] * 3))


def test_blend_of_two_joints(tmp_path):
    joints = [[0, 1, 0, 0]] * 3
    weights = [[1, 0, 0, 0], [0.5, 0.5, 0, 0], [0.25, 0.75, 0, 0]]
    b = skinned(joints, weights, bind=[np.eye(4), shift(0, -2, 0)])
    b.json["nodes"][2]["translation"] = [0, 2, 8]
    mesh = load(b, tmp_path).meshes[0]
    assert mesh.positions.tolist() == [[0, 0, 0], [1, 0, 4], [0, 1, 6]]


def test_joints_move_in_time_and_parents_carry_them(tmp_path):
    b = skinned(ARM, ALL, bind=[np.eye(4), shift(0, -2, 0)])
    b.json["nodes"][1]["translation"] = [0, 0, 1]
    sampler = {"input": b.accessor([0, 2]), "output": b.accessor([[0, 2, 0], [6, 2, 0]])}
    channel = {"sampler": 0, "target": {"node": 2, "path": "translation"}}
    b.add("animations", {"samplers": [sampler], "channels": [channel]})
    positions = load(b, tmp_path, 1.5).meshes[0].positions
    assert positions == pytest.approx(np.add(CORNERS, [4.5, 0, 1]))


def test_morph_comes_before_skin(tmp_path):
    b = skinned(ROOT, ALL)
    b.json["nodes"][1]["rotation"] = QUARTER
    b.json["meshes"][0]["primitives"][0]["targets"] = [{"POSITION": b.accessor([[1, 0, 0]] * 3)}]
    b.json["nodes"][0]["weights"] = [3]
    positions = load(b, tmp_path).meshes[0].positions
    assert positions == pytest.approx(np.array([[0, 3, 0], [0, 4, 0], [-1, 3, 0]]), abs=1e-6)


@pytest.mark.parametrize("joint_type", ["u1", "u2"])
@pytest.mark.parametrize(("weight_type", "whole"), [("f4", 1.0), ("u1", 255), ("u2", 65535)])
def test_eight_influences_of_every_type(tmp_path, joint_type, weight_type, whole):
    b = skinned(ROOT, ALL, dtype=joint_type)
    attributes = b.json["meshes"][0]["primitives"][0]["attributes"]
    shares = np.array([[0.2, 0.2, 0, 0], [0, 0, 0.4, 0.2]]) * whole
    extra = {} if weight_type == "f4" else {"normalized": True}
    for k, row in enumerate(shares):
        attributes[f"WEIGHTS_{k}"] = b.accessor([row] * 3, weight_type, **extra)
        attributes[f"JOINTS_{k}"] = b.accessor([[0, 1, 1, 0]] * 3, joint_type)
    b.json["nodes"][2]["translation"] = [0, 0, 10]
    scene = load(b, tmp_path)
    # 0.2 + 0.2 of the root, 0.2 + 0.4 of the arm.
    assert scene.meshes[0].positions[:, 2] == pytest.approx([6, 6, 6], rel=1e-4)
    assert scene.warnings == []


def test_weights_that_do_not_add_to_one_are_scaled(tmp_path):
    joints = [[1, 0, 0, 0], [1, 0, 0, 0], [0, 1, 0, 0]]
    weights = [[0.5, 0, 0, 0], [0, 0, 0, 0], [1, -0.25, 0, 0]]
    scene = load(skinned(joints, weights), tmp_path)
    assert scene.meshes[0].positions.tolist() == [[0, 2, 0], [1, 2, 0], [0, 1, 0]]
    assert scene.warnings == [
        "joint weights of a vertex that do not add up to 1 are scaled (2 uses)"
    ]


def test_weights_of_bytes_that_were_rounded_are_no_news(tmp_path):
    b = skinned([[0, 1, 1, 1]] * 3, ALL)
    weights = b.accessor([[84, 85, 85, 0]] * 3, "u1", normalized=True)  # 254 of 255
    b.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = weights
    scene = load(b, tmp_path)
    assert scene.meshes[0].positions[0, 1] == pytest.approx(2 * 170 / 254)
    assert scene.warnings == []


def test_joints_beyond_the_skin_may_stand_without_weight(tmp_path):
    scene = load(skinned([[1, 255, 7, 0]] * 3, ALL), tmp_path)
    assert scene.meshes[0].positions[0].tolist() == [0, 2, 0]


def test_a_mirrored_joint_turns_the_triangles(tmp_path):
    """Triangles wind about the outside, and normals point there, also in a mirror."""
    b = skinned(ROOT, ALL, NORMAL=[[0, 0, 1]] * 3, TANGENT=[[1, 0, 0, 1]] * 3)
    b.json["nodes"][1]["scale"] = [-1, 1, 1]
    mesh = load(b, tmp_path).meshes[0]
    a, c, d = mesh.positions[mesh.indices[0]]
    assert np.cross(c - a, d - a).tolist() == [0, 0, 1]
    assert mesh.normals.tolist() == [[0, 0, 1]] * 3
    # Bitangent w n x t: the mirrored one is still +y.
    assert mesh.tangents.tolist() == [[-1, 0, 0, -1]] * 3


def test_flat_joints_keep_normals(tmp_path):
    b = skinned(ROOT, ALL, NORMAL=[[0, 0.6, 0.8]] * 3)
    b.json["nodes"][1]["scale"] = [1, 1, 0]
    mesh = load(b, tmp_path).meshes[0]
    assert mesh.normals.tolist() == [[0, 0, 1]] * 3


def test_joints_of_scale_0_hide_the_mesh(tmp_path):
    b = skinned(ROOT, ALL, NORMAL=[[0, 0, 1]] * 3)
    b.json["nodes"][1]["scale"] = [0, 0, 0]
    scene = load(b, tmp_path)
    assert scene.instances == []
    assert scene.warnings == ["a mesh that its skin scales to zero is left out (1 use)"]


def test_skins_share_and_do_not_share(tmp_path):
    b = skinned(ROOT, ALL)
    b.node(mesh=0, skin=0)
    b.add("skins", {"joints": [2, 1]})
    b.node(mesh=0, skin=1)
    b.node(mesh=0, translation=[0, 0, 5])
    scene = load(b, tmp_path)
    assert [i.mesh for i in scene.instances] == [0, 0, 1, 2]
    assert [m.positions[0, 1] for m in scene.meshes] == [0, 2, 0]
    assert scene.instances[3].transform[2, 3] == 5


def test_a_part_without_joints_stays_with_its_node(tmp_path):
    b = skinned(ROOT, ALL)
    b.json["meshes"][0]["primitives"].append({"attributes": {"POSITION": b.accessor(CORNERS)}})
    scene = load(b, tmp_path)
    assert scene.instances[0].transform[0, 3] == 0
    assert scene.instances[1].transform[0, 3] == 50
    assert scene.warnings == ["a mesh without JOINTS_0 is not moved by its skin (1 use)"]


def test_joints_outside_of_the_scene_are_told(tmp_path):
    b = skinned(ARM, ALL)
    b.json["scenes"][0]["nodes"] = [0]
    b.json["nodes"][1]["translation"] = [0, 0, 3]
    scene = load(b, tmp_path)
    assert scene.meshes[0].positions[0].tolist() == [0, 2, 3]
    assert scene.warnings == ["a joint of a skin is not in the scene (2 uses)"]


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_any_skin_against_plain_sums(tmp_path_factory, seed):
    """Random joints in a tree, bound where they stand at first, then moved."""
    rng = np.random.default_rng(seed)
    count, joints = 40, 5
    positions, weights = rng.normal(size=(count, 3)), rng.random((count, 4))
    weights /= weights.sum(axis=1, keepdims=True)
    picked = rng.integers(0, joints, (count, 4))
    normals = rng.normal(size=(count, 3))
    b = Builder()
    b.mesh(
        {
            "POSITION": b.accessor(positions),
            "NORMAL": b.accessor(normals),
            "JOINTS_0": b.accessor(picked, "u2"),
            "WEIGHTS_0": b.accessor(weights),
        },
        indices=b.accessor(rng.integers(0, count, 30), "u1"),
    )
    parents = [int(rng.integers(-1, k)) if k else -1 for k in range(joints)]
    matrices = rng.normal(size=(joints, 4, 4)) * 0.3 + np.eye(4)
    matrices[:, 3] = (0, 0, 0, 1)
    b.node(mesh=0, skin=0)
    for k in range(joints):
        children = [c + 1 for c in range(joints) if parents[c] == k]
        node = {"matrix": matrices[k].T.ravel().tolist(), "children": children}
        (b.node if parents[k] < 0 else b.child)(**node)
    bind = rng.normal(size=(joints, 4, 4))
    bind[:, 3] = (0, 0, 0, 1)
    bind = bind.astype(np.float32)
    b.add("skins", {"joints": [1 + k for k in range(joints)]})
    b.json["skins"][0]["inverseBindMatrices"] = b.accessor(columns(*bind))
    mesh = load(b, tmp_path_factory.mktemp("skin")).meshes[0]

    world: list = []
    for k in range(joints):
        world.append(matrices[k] if parents[k] < 0 else world[parents[k]] @ matrices[k])
    for v in range(count):
        blend = sum(weights[v, i] * world[j] @ bind[j] for i, j in enumerate(picked[v]))
        wanted = blend @ [*positions[v], 1]
        assert mesh.positions[v] == pytest.approx(wanted[:3], rel=1e-4, abs=1e-4)
        normal = np.linalg.solve(blend[:3, :3].T, normals[v])
        assert mesh.normals[v] == pytest.approx(normal / np.linalg.norm(normal), abs=1e-3)


def test_pieces_do_not_show(tmp_path, monkeypatch):
    rng = np.random.default_rng(1)
    b = Builder()
    weights = rng.random((1000, 4))
    b.mesh(
        {
            "POSITION": b.accessor(rng.normal(size=(1000, 3))),
            "NORMAL": b.accessor(rng.normal(size=(1000, 3))),
            "JOINTS_0": b.accessor(rng.integers(0, 2, (1000, 4)), "u1"),
            "WEIGHTS_0": b.accessor(weights / weights.sum(axis=1, keepdims=True)),
        },
        indices=b.accessor(rng.integers(0, 1000, 300), "u2"),
    )
    b.node(mesh=0, skin=0)
    b.node(rotation=QUARTER, scale=[1, 2, 3])
    b.node(translation=[1, 2, 3], scale=[-1, 1, 1])
    b.add("skins", {"joints": [1, 2]})
    whole = load(b, tmp_path).meshes[0]
    monkeypatch.setattr(skinning, "_CHUNK", 7)
    pieces = load(b, tmp_path).meshes[0]
    for name in ("positions", "normals", "indices"):
        assert np.array_equal(getattr(whole, name), getattr(pieces, name))


def test_sets_of_joints_are_counted(tmp_path, monkeypatch):
    monkeypatch.setattr(gltf, "_MAX_COPIES", 299)
    b = skinned(ROOT, ALL)
    attributes = b.json["meshes"][0]["primitives"][0]["attributes"]
    for k in range(1, 100):
        for name in ("JOINTS", "WEIGHTS"):
            attributes[f"{name}_{k}"] = attributes[f"{name}_0"]
    with pytest.raises(InputError, match="too many vertices that are not shared: the limit is 299"):
        load(b, tmp_path)


def attribute(name: str, make):
    def change(b: Builder) -> None:
        b.json["meshes"][0]["primitives"][0]["attributes"][name] = make(b)

    return change


def in_skin(**values):
    def change(b: Builder) -> None:
        made = {k: v(b) if callable(v) else v for k, v in values.items()}
        b.json["skins"][0].update(made)

    return change


A = r"meshes\[0\]\.primitives\[0\]\.attributes\."
S = r"skins\[0\]\."
BAD = {
    "skin": (lambda b: b.json["nodes"][0].update(skin=3), r"nodes\[0\]\.skin: index out of ran"),
    "no joints": (lambda b: b.json["skins"][0].pop("joints"), S + "joints: missing"),
    "empty": (in_skin(joints=[]), S + "joints: the list is empty, wanted at least one joint"),
    "node": (in_skin(joints=[1, 9]), S + r"joints\[1\]: index out of range: wanted 0 \.\. 2"),
    "skeleton": (in_skin(skeleton=12), S + "skeleton: index out of range"),
    "bind type": (
        in_skin(inverseBindMatrices=lambda b: b.accessor([[1, 2, 3, 4]] * 2)),
        S + "inverseBindMatrices: wrong accessor type: wanted MAT4, got VEC4",
    ),
    "bind of shorts": (
        in_skin(inverseBindMatrices=lambda b: b.accessor(columns(np.eye(4), np.eye(4)), "i2")),
        S + "inverseBindMatrices: wrong accessor type: wanted matrices of component type 5126",
    ),
    "bind count": (
        in_skin(inverseBindMatrices=lambda b: b.accessor(columns(np.eye(4)))),
        S + "inverseBindMatrices: wrong count: wanted at least 2 like the joints, got 1",
    ),
    "bind NaN": (
        in_skin(inverseBindMatrices=lambda b: b.accessor([[math.nan] * 16] * 2)),
        S + "inverseBindMatrices: matrix 0: wanted finite numbers",
    ),
    "bind projects": (
        in_skin(inverseBindMatrices=lambda b: b.accessor([[1] * 16] * 2)),
        S + r"inverseBindMatrices: wanted 0, 0, 0, 1 as its last row, got \[1\.0, 1\.0",
    ),
    "bind is huge": (
        in_skin(inverseBindMatrices=lambda b: b.accessor(columns(shift(1e30, 0, 0), np.eye(4)))),
        A + r"POSITION: vertex 0: wanted coordinates below 1e\+18",
    ),
    "joint": (
        attribute("JOINTS_0", lambda b: b.accessor([[0, 0, 0, 0], [2, 0, 0, 0], [0] * 4], "u1")),
        A + r"JOINTS_0: vertex 1: index out of range: wanted 0 \.\. 1 \(joints\), got 2 \(1 such",
    ),
    "joints of floats": (
        attribute("JOINTS_0", lambda b: b.accessor(ALL)),
        A + "JOINTS_0: wrong accessor type: wanted VEC4 of component type 5121 or 5123",
    ),
    "joints normalized": (
        attribute("JOINTS_0", lambda b: b.accessor(ROOT, "u1", normalized=True)),
        A + "JOINTS_0: wrong accessor type: .*normalized",
    ),
    "joints of three": (
        attribute("JOINTS_0", lambda b: b.accessor(CORNERS, "u1")),
        A + "JOINTS_0: wrong accessor type: .* got VEC3",
    ),
    "joint count": (
        attribute("JOINTS_0", lambda b: b.accessor(ROOT * 2, "u1")),
        A + "JOINTS_0: wrong count: wanted 3 like POSITION, got 6",
    ),
    "weight count": (
        attribute("WEIGHTS_0", lambda b: b.accessor(ALL * 2)),
        A + "WEIGHTS_0: wrong count: wanted 3 like POSITION, got 6",
    ),
    "weight type": (
        attribute("WEIGHTS_0", lambda b: b.accessor(ALL, "u1")),
        A + "WEIGHTS_0: wrong accessor type: wanted float or normalized unsigned",
    ),
    "weight NaN": (
        attribute("WEIGHTS_0", lambda b: b.accessor([[math.nan] * 4] * 3)),
        A + "WEIGHTS_0: vertex 0: wanted finite numbers",
    ),
    "no weights": (
        lambda b: b.json["meshes"][0]["primitives"][0]["attributes"].pop("WEIGHTS_0"),
        A + "JOINTS_0: WEIGHTS_0 is missing",
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_skins(tmp_path, case):
    change, wanted = BAD[case]
    b = skinned(ROOT, ALL)
    change(b)
    with pytest.raises(InputError, match=wanted):
        load(b, tmp_path)
