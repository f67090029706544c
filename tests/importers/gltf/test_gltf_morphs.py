"""Morph targets: vertices computed by hand, for each place that weights come from."""

from __future__ import annotations

import math
import struct
import time

import numpy as np
import pytest

from daguerre.errors import InputError
from daguerre.importers.gltf import reader as gltf
from tests.support.formats.make_gltf import CORNERS, Builder

UP = [[0, 0, 1], [0, 0, 2], [0, 0, 3]]
SIDE = [[8, 0, 0]] * 3


def morphing(b: Builder | None = None, **mesh) -> Builder:
    """A triangle with two targets: one lifts it, one moves it aside."""
    b = b or Builder()
    targets = [{"POSITION": b.accessor(UP)}, {"POSITION": b.accessor(SIDE)}]
    b.mesh({"POSITION": b.accessor(CORNERS)}, targets=targets)
    b.json["meshes"][0].update(mesh)
    return b


def moved(lift: float, aside: float):
    return (np.array(CORNERS) + lift * np.array(UP) + aside * np.array(SIDE)).tolist()


def load(b: Builder, tmp_path, time: float = 0.0):
    return gltf.read(b.glb(tmp_path / "a.glb"), time=time)


def animate(b: Builder, keys, values, mode=None, node=0, **accessor) -> None:
    sampler = {"input": b.accessor(keys), "output": b.accessor(values, **accessor)}
    if mode:
        sampler["interpolation"] = mode
    channel = {"sampler": 0, "target": {"node": node, "path": "weights"}}
    b.add("animations", {"samplers": [sampler], "channels": [channel]})


@pytest.mark.parametrize(
    ("mesh", "node", "wanted"),
    [
        ({}, {}, (0, 0)),
        ({"weights": [0.5, 0.25]}, {}, (0.5, 0.25)),
        ({"weights": [0.5, 0.25]}, {"weights": [0, -1]}, (0, -1)),
        ({}, {"weights": [2, 0]}, (2, 0)),
    ],
)
def test_weights_of_mesh_and_node(tmp_path, mesh, node, wanted):
    b = morphing(**mesh)
    b.node(mesh=0, **node)
    scene = load(b, tmp_path)
    assert scene.meshes[0].positions.tolist() == moved(*wanted)
    assert scene.warnings == []


@pytest.mark.parametrize(
    ("mode", "time", "wanted"),
    [
        ("LINEAR", 1.0, (0, 1)),
        ("LINEAR", 1.5, (0.25, 0.75)),
        ("LINEAR", 2.5, (0.75, 0.25)),
        ("LINEAR", 9.0, (1, 0)),
        ("STEP", 2.9, (0, 1)),
        ("STEP", 3.0, (1, 0)),
    ],
)
def test_animated_weights(tmp_path, mode, time, wanted):
    b = morphing(weights=[5, 5])
    b.node(mesh=0)
    animate(b, [1, 3], [0, 1, 1, 0], mode)
    assert load(b, tmp_path, time).meshes[0].positions.tolist() == moved(*wanted)


def test_animated_weights_follow_a_spline(tmp_path):
    """Chapter 3.11: all in-tangents of a key, then its values, then its out-tangents."""
    b = morphing()
    b.node(mesh=0)
    # Weights t^2 and 1 - t on [0, 2]; tangents that look outward are not used.
    first = [77, 88, 0, 1, 0, -1]
    second = [4, -1, 4, -1, 77, 88]
    animate(b, [0, 2], first + second, "CUBICSPLINE")
    for t in (0.0, 0.5, 1.25, 2.0):
        positions = load(b, tmp_path, t).meshes[0].positions
        assert positions == pytest.approx(np.array(moved(t * t, 1 - t)), abs=1e-5)


def test_quantized_weights_and_displacements(tmp_path):
    b = Builder()
    lift = b.accessor([[0, 0, 0], [0, 0, 127], [0, 0, -128]], "i1", normalized=True)
    wide = b.accessor([[30000, 0, 0]] * 3, "i2")
    b.mesh({"POSITION": b.accessor(CORNERS)}, targets=[{"POSITION": lift}, {"POSITION": wide}])
    b.node(mesh=0)
    animate(b, [0.0], [[51], [255]], dtype="u1", normalized=True)
    positions = load(b, tmp_path).meshes[0].positions
    wanted = [[30000, 0, 0], [30001, 0, 0.2], [30000, 1, -0.2]]
    assert positions == pytest.approx(np.array(wanted), rel=1e-7)


@pytest.mark.parametrize("base", [True, False])
def test_sparse_displacements(tmp_path, base):
    b = Builder()
    sparse = {
        "count": 1,
        "indices": {"bufferView": b.view(struct.pack("<H", 2)), "componentType": 5123},
        "values": {"bufferView": b.view(struct.pack("<3f", 0, 0, 6))},
    }
    if base:
        target = b.accessor(UP, sparse=sparse)
    else:
        target = b.add(
            "accessors", {"componentType": 5126, "count": 3, "type": "VEC3", "sparse": sparse}
        )
    b.mesh({"POSITION": b.accessor(CORNERS)}, targets=[{"POSITION": target}], weights=[1])
    b.json["meshes"][0]["weights"] = [0.5]
    b.node(mesh=0)
    z = load(b, tmp_path).meshes[0].positions[:, 2]
    assert z.tolist() == ([0.5, 1, 3] if base else [0, 0, 3])


def test_every_attribute_morphs(tmp_path):
    b = Builder()
    attributes = {
        "POSITION": b.accessor(CORNERS),
        "NORMAL": b.accessor([[0, 0, 1]] * 3),
        "TANGENT": b.accessor([[1, 0, 0, -1]] * 3),
        "TEXCOORD_0": b.accessor([[0, 0], [1, 0], [0, 1]]),
        "TEXCOORD_1": b.accessor([[0, 0], [255, 0], [0, 255]], "u1", normalized=True),
        "COLOR_0": b.accessor([[0.5, 0.5, 0.5, 0.5]] * 3),
    }
    target = {
        "NORMAL": b.accessor([[2, 0, 0]] * 3),
        "TANGENT": b.accessor([[0, 0, -2]] * 3),
        "TEXCOORD_0": b.accessor([[1, 2]] * 3),
        "TEXCOORD_1": b.accessor([[0, 127]] * 3, "i1", normalized=True),
        "COLOR_0": b.accessor([[4, -4, 0.25]] * 3),
        "_MINE": 99,
    }
    b.mesh(attributes, targets=[target])
    b.node(mesh=0, weights=[0.5])
    scene = load(b, tmp_path)
    mesh = scene.meshes[0]
    half = math.sqrt(0.5)
    assert mesh.positions.tolist() == CORNERS
    assert mesh.normals == pytest.approx(np.array([[half, 0, half]] * 3))
    assert mesh.tangents == pytest.approx(np.array([[half, 0, -half, -1]] * 3))
    assert mesh.uv.tolist() == [[0.5, 1], [1.5, 1], [0.5, 2]]
    assert mesh.uv1.tolist() == [[0, 0.5], [1, 0.5], [0, 1.5]]
    assert mesh.colors.tolist() == [[1, 0, 0.625, 0.5]] * 3
    assert scene.warnings == []


def test_what_the_mesh_lacks_is_told(tmp_path):
    b = Builder()
    target = {"NORMAL": b.accessor(UP), "TEXCOORD_4": b.accessor([[1, 2]] * 3)}
    b.mesh({"POSITION": b.accessor(CORNERS)}, targets=[target], weights=[1])
    b.json["meshes"][0]["weights"] = [1]
    b.node(mesh=0)
    assert load(b, tmp_path).warnings == [
        "morph target attribute 'NORMAL' is not used (1 use)",
        "morph target attribute 'TEXCOORD_4' is not used (1 use)",
    ]


def test_equal_shapes_share_a_mesh(tmp_path):
    b = morphing(weights=[1, 0])
    for weights in ([1, 0], [0, 1], [0.0, 1.0], None, [0, 0], [0, 0]):
        b.node(mesh=0, **({} if weights is None else {"weights": weights}))
    scene = load(b, tmp_path)
    assert [i.mesh for i in scene.instances] == [0, 1, 1, 0, 2, 2]
    assert [m.positions[0, 2] for m in scene.meshes] == [1, 0, 0]


def test_targets_of_one_accessor_add_up(tmp_path):
    b = morphing(weights=[0.5, 0.25])
    targets = b.json["meshes"][0]["primitives"][0]["targets"]
    targets[1] = targets[0]
    b.node(mesh=0)
    assert load(b, tmp_path).meshes[0].positions.tolist() == moved(0.75, 0)


def test_a_target_without_weight_is_not_read(tmp_path):
    b = morphing(weights=[0, 1])
    b.json["meshes"][0]["primitives"][0]["targets"][0] = {"POSITION": b.accessor([[1, 2, 3]])}
    b.node(mesh=0)
    assert load(b, tmp_path).meshes[0].positions.tolist() == moved(0, 1)


def nan_target(b: Builder) -> None:
    target = b.accessor([[0, 0, 0], [0, math.nan, 0], [0, 0, 0]])
    b.json["meshes"][0]["primitives"][0]["targets"][1]["POSITION"] = target


def target(key: str, value):
    def change(b: Builder) -> None:
        made = value(b) if callable(value) else value
        b.json["meshes"][0]["primitives"][0]["targets"][1][key] = made

    return change


T = r"meshes\[0\]\.primitives\[0\]\.targets\[1\]"
BAD = {
    "too few weights": (
        lambda b: b.json["nodes"][0].update(weights=[1]),
        r"nodes\[0\]\.weights: wrong length: wanted 2 numbers, got 1",
    ),
    "too many weights": (
        lambda b: b.json["meshes"][0].update(weights=[1, 2, 3]),
        r"meshes\[0\]\.weights: wrong length: wanted 2 numbers, got 3",
    ),
    "weights of text": (
        lambda b: b.json["meshes"][0].update(weights=[1, "2"]),
        r"meshes\[0\]\.weights\[1\]: wrong type: wanted a number, got '2'",
    ),
    "weights are a number": (
        lambda b: b.json["nodes"][0].update(weights=1),
        r"nodes\[0\]\.weights: wrong type: wanted a list",
    ),
    "huge weight": (
        lambda b: b.json["meshes"][0].update(weights=[1e30, 1]),
        r"attributes\.POSITION: vertex 0: wanted coordinates below 1e\+18",
    ),
    "targets is an object": (
        lambda b: b.json["meshes"][0]["primitives"][0].update(targets={}),
        r"targets: wrong type: wanted a list",
    ),
    "count": (
        target("POSITION", lambda b: b.accessor([[0, 0, 0]] * 4)),
        T + r"\.POSITION: wrong count: wanted 3 like POSITION of the mesh, got 4",
    ),
    "type": (
        target("POSITION", lambda b: b.accessor([[0, 0]] * 3)),
        T + r"\.POSITION: wrong accessor type: wanted VEC3, got VEC2",
    ),
    "accessor": (target("POSITION", 77), T + r"\.POSITION: index out of range"),
    "NaN": (nan_target, T + r"\.POSITION: displacement 1: wanted finite numbers"),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_targets(tmp_path, case):
    change, wanted = BAD[case]
    b = morphing(weights=[1, 1])
    b.node(mesh=0)
    change(b)
    with pytest.raises(InputError, match=wanted):
        load(b, tmp_path)


@pytest.mark.parametrize(
    ("values", "mode", "wanted"),
    [
        ([0, 1, 2], None, r"wanted a multiple of 2 \(LINEAR\), got 3"),
        ([0, 1, 2, 3], "CUBICSPLINE", r"wanted a multiple of 6 \(CUBICSPLINE\), got 4"),
        ([[0, 1], [2, 3]], None, "wrong accessor type: wanted SCALAR, got VEC2"),
    ],
)
def test_bad_weight_keys(tmp_path, values, mode, wanted):
    b = morphing()
    b.node(mesh=0)
    animate(b, [0, 1], values, mode)
    with pytest.raises(InputError, match=wanted):
        load(b, tmp_path)


def test_small_files_do_not_ask_for_much(tmp_path, monkeypatch):
    """A thousand names of one accessor cost what one costs; copies of a mesh are counted."""
    start = time.perf_counter()
    b = Builder()
    zeros = b.add("accessors", {"componentType": 5126, "count": 1 << 20, "type": "VEC3"})
    targets = [{"POSITION": zeros}] * 999
    b.mesh({"POSITION": zeros}, indices=b.accessor([0, 1, 2], "u1"), targets=targets)
    b.node(mesh=0, weights=[1] * 999)
    assert len(load(b, tmp_path).meshes) == 1
    monkeypatch.setattr(gltf, "_MAX_COPIES", 1 << 21)
    for k in range(9):
        b.node(mesh=0, weights=[k + 2] * 999)
    with pytest.raises(
        InputError, match="too many vertices that are not shared: the limit is 2097152"
    ):
        load(b, tmp_path)
    assert time.perf_counter() - start < 20
