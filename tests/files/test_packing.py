"""Packed values: equal after a journey, shared parts stay shared, and no code comes with them."""

from __future__ import annotations

import json
from collections import OrderedDict
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.errors import InputError, MismatchError, UsageError
from daguerre.files import packing
from daguerre.files.json_item import Item
from daguerre.files.packing import LARGE, Packed, large_of, pack
from daguerre.files.value import same
from tests.faults.scene import write_scene


def moving() -> dg.Scene:
    """A scene of arrays with motion, a texture, a plate's picture and lights."""
    made = dg.Scene()
    corners = np.array([[-1, 0, -4], [1, 0, -4], [0, 1, -4]], np.float32)
    mesh = made.add_mesh(corners, np.array([[0, 1, 2]], np.uint32))
    ahead = np.eye(4)
    ahead[2, 3] = -1.0
    made.add_instance(
        mesh, dg.Material(dg.Diffuse((0.5, 0.4, 0.3))), dg.keys([(0.0, np.eye(4)), (1.0, ahead)])
    )
    made.set_environment(image=np.random.default_rng(1).random((8, 16, 3), np.float32))
    made.add_camera("main", dg.Camera(lens=dg.lenses.load("double-gauss-50mm-f2"), f_stop=2.8))
    return made


def unpack(packed: Packed) -> Any:
    """Unpacks a value with its own large arrays."""
    assert large_of(packed.data) == sorted(packed.large)
    return packing.unpack(packed.data, lambda name: packed.large[name].tobytes())


VALUES: list[Any] = [
    None,
    True,
    -(1 << 70),
    0.1,
    float("inf"),
    "text \n \u2603",
    (1, (2, [3])),
    [1, {"a": [2.5]}, {1: "x", (2, 3): "y"}],
    OrderedDict(b=1, a=2),
    {1, 2},
    frozenset({"a"}),
    Path("a/b.exr"),
    np.float32(0.1),
    np.arange(6, dtype=np.uint8).reshape(2, 3),
    np.zeros((0, 3)),
    np.array(True),
    np.arange(LARGE, dtype=np.float32).reshape(2, -1)[:, ::2],
    Item([1, 2], "weights", Item({}, "file.glb")),
    dg.Camera(lens=dg.lenses.load("nikon-af-s-70-200mm-f2.8"), zoom=100, scatter=dg.LensScatter()),
    dg.RenderSettings.of(spp=3, noise=0.1, aovs=True),
]


@pytest.mark.parametrize("value", VALUES, ids=lambda one: type(one).__name__)
def test_values_are_equal_afterwards(value: Any) -> None:
    found = unpack(pack(value))
    assert type(found) is type(value)
    assert same(found, value)
    assert pack(found).data == pack(value).data


def test_scenes_draw_the_same_picture(tmp_path: Path) -> None:
    for scene in (moving(), dg.load(write_scene(tmp_path / "scene.glb"))):
        found = unpack(pack(scene))
        assert found == scene
        how = dg.RenderSettings.of(resolution=(30, 20), spp=2)
        before, after = (dg.render(one, one.camera(), settings=how) for one in (scene, found))
        assert np.array_equal(before.rgb, after.rgb)


def test_shared_parts_stay_shared() -> None:
    array, inner = np.arange(1000.0), [1]
    found = unpack(pack({"a": array, "b": array, "c": inner, "d": inner}))
    assert found["a"] is found["b"]
    assert found["c"] is found["d"]
    itself: list[Any] = []
    itself.append(itself)
    found = unpack(pack(itself))
    assert found[0] is found


class Own:
    """A class of a user."""


@pytest.mark.parametrize(
    "value",
    [Own(), lambda: 1, open, print, np.array([None]), object(), 1j],
    ids=lambda one: type(one).__name__,
)
def test_other_values_are_refused(value: Any) -> None:
    with pytest.raises(UsageError, match="packing: wanted"):
        pack({"a": value})


def changed(packed: Packed, **changes: Any) -> Packed:
    """A packed value whose head or body is another one."""
    head, body, rest = packed.data.split(b"\n", 2)
    lines = [json.loads(line) for line in (head, body)]
    for key, value in changes.items():
        next(line for line in lines if key in line)[key] = value
    data = b"\n".join([*(json.dumps(line).encode() for line in lines), rest])
    return Packed(data, packed.large)


def damaged(packed: Packed) -> None:
    """Checks that a packed value is refused."""
    with pytest.raises(InputError, match="damaged"):
        packing.unpack(packed.data, lambda name: packed.large[name].tobytes())


@pytest.mark.parametrize(
    "name",
    [
        "builtins:eval",
        "os:system",
        "daguerre.files.extras:find_spec",
        "daguerre.pictures.images:np",
        "daguerre.rendering.session:Session",
        "daguerre.errors:UsageError",
        "daguerre.nothing:There",
        "daguerre.camera.camera:Nothing",
        "",
    ],
)
def test_no_class_but_values_of_ours_is_made(name: str) -> None:
    part = [{"class": name, "state": {"part": 1}}, {"dict": []}]
    damaged(changed(pack(None), root={"part": 0}, parts=part))


@pytest.mark.parametrize(
    "changes",
    [
        {"root": {"part": 7}},
        {"root": {"code": "1"}},
        {"root": {"array": 0}, "arrays": [["<f8", [1 << 40], None]]},
        {"root": {"array": 0}, "arrays": [["|O", [1], None]]},
        {"root": {"array": 0}, "arrays": [[",", [1], None]]},
        {"root": {"array": 0}, "arrays": [["<f8,<f8", [0], None]]},
        {"root": {"array": 0}, "arrays": [["<f8", [-1], None]]},
        {"parts": 3, "root": {"part": 0}},
        {"root": {"array": 0}, "arrays": [["<f8", [2], "unknown"]]},
        {"root": {}},
    ],
    ids=str,
)
def test_damaged_bytes_are_refused(changes: dict[str, Any]) -> None:
    damaged(changed(pack([1.0]), **changes))


def test_cut_bytes_are_refused() -> None:
    packed = pack(np.arange(4.0))
    for end in range(0, len(packed.data), 7):
        damaged(Packed(packed.data[:end], {}))


def test_another_version_is_refused_by_name() -> None:
    with pytest.raises(MismatchError, match=r"made by daguerre '0\.9', but this is"):
        packing.unpack(changed(pack(1), version="0.9").data, lambda name: b"")


def test_scenes_of_a_sequence_share_their_large_arrays() -> None:
    made = moving()
    corners = np.random.default_rng(1).random((9000, 3), np.float32)
    made.add_mesh(corners, np.arange(9000, dtype=np.uint32).reshape(-1, 3))
    one, two = (pack(made.at(time)) for time in (0.2, 0.4))
    assert one.data != two.data
    assert one.large.keys() == two.large.keys()
    assert len(one.large) >= 1
