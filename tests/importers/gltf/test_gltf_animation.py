"""glTF animation at one moment: steps, lines, great circles, splines; exact numbers."""

from __future__ import annotations

import math

import numpy as np
import pytest

from daguerre.importers.gltf import reader as gltf
from tests.support.formats.make_gltf import Builder, triangle

HALF = math.sqrt(0.5)
QUARTER_TURN = [0, 0, HALF, HALF]  # 90 degrees about z


def animate(b: Builder, path: str, keys, values, mode: str | None = None, node: int = 0) -> None:
    sampler = {"input": b.accessor(keys), "output": b.accessor(values)}
    if mode:
        sampler["interpolation"] = mode
    b.add(
        "animations",
        {
            "samplers": [sampler],
            "channels": [{"sampler": 0, "target": {"node": node, "path": path}}],
        },
    )


def transform(b: Builder, tmp_path, time: float):
    return gltf.read(b.glb(tmp_path / "a.glb"), time=time).instances[0].transform


def angle_deg(matrix) -> float:
    return math.degrees(math.atan2(matrix[1, 0], matrix[0, 0]))


@pytest.mark.parametrize(
    ("mode", "time", "x"),
    [
        (None, 2.0, 15.0),
        ("LINEAR", 1.5, 12.5),
        ("LINEAR", 0.0, 10.0),
        ("LINEAR", 1.0, 10.0),
        ("LINEAR", 3.0, 20.0),
        ("LINEAR", 9.0, 50.0),
        ("LINEAR", -9.0, 10.0),
        ("STEP", 0.0, 10.0),
        ("STEP", 2.999, 10.0),
        ("STEP", 3.0, 20.0),
        ("STEP", 4.9, 20.0),
        ("STEP", 5.0, 50.0),
    ],
)
def test_translation(tmp_path, mode, time, x):
    b = triangle()
    animate(b, "translation", [1, 3, 5], [[10, 0, 0], [20, 0, 0], [50, 0, 0]], mode)
    assert transform(b, tmp_path, time)[0, 3] == pytest.approx(x, abs=1e-6)


@pytest.mark.parametrize(("time", "wanted"), [(0, 0), (0.25, 22.5), (0.5, 45), (0.9, 81), (1, 90)])
@pytest.mark.parametrize("sign", [1, -1])
def test_rotation_is_even_and_takes_the_short_way(tmp_path, time, wanted, sign):
    b = triangle()
    animate(b, "rotation", [0, 1], [[0, 0, 0, 1], [sign * q for q in QUARTER_TURN]])
    assert angle_deg(transform(b, tmp_path, time)) == pytest.approx(wanted, abs=1e-4)


def test_rotation_of_quantized_keys(tmp_path):
    b = triangle()
    output = b.accessor([[0, 0, 0, 32767], [0, 0, 23170, 23170]], "i2", normalized=True)
    animate(b, "rotation", [0, 1], [[0, 0, 0, 1]] * 2)
    b.json["animations"][0]["samplers"][0]["output"] = output
    assert angle_deg(transform(b, tmp_path, 0.5)) == pytest.approx(45, abs=1e-3)


def test_equal_rotations(tmp_path):
    b = triangle()
    animate(b, "rotation", [0, 1], [QUARTER_TURN, QUARTER_TURN])
    assert angle_deg(transform(b, tmp_path, 0.3)) == pytest.approx(90, abs=1e-4)


def test_scale(tmp_path):
    b = triangle()
    animate(b, "scale", [0, 2], [[1, 1, 1], [3, 5, 1]])
    assert transform(b, tmp_path, 1.0)[:3, :3] == pytest.approx(np.diag([2, 3, 1]))


def test_cubic_spline_follows_the_formula(tmp_path):
    b = triangle()
    # Per key: in-tangent, value, out-tangent. x(t) = t^2 on [1, 3]: tangents 2 t, per second.
    values = [[0, 0, 0], [1, 0, 0], [2, 0, 0], [6, 0, 0], [9, 0, 0], [0, 0, 0]]
    animate(b, "translation", [1, 3], values, "CUBICSPLINE")
    for time in (1.0, 1.3, 2.0, 2.9, 3.0):
        assert transform(b, tmp_path, time)[0, 3] == pytest.approx(time**2, abs=1e-5)
    assert transform(b, tmp_path, 0.0)[0, 3] == 1
    assert transform(b, tmp_path, 4.0)[0, 3] == 9


def test_cubic_spline_rotation_is_made_a_unit(tmp_path):
    b = triangle()
    zero = [0, 0, 0, 0]
    values = [zero, [0, 0, 0, 1], zero, zero, QUARTER_TURN, zero]
    animate(b, "rotation", [0, 1], values, "CUBICSPLINE")
    matrix = transform(b, tmp_path, 0.5)
    assert angle_deg(matrix) == pytest.approx(45, abs=1e-4)
    assert np.linalg.det(matrix[:3, :3]) == pytest.approx(1)


def test_all_animations_and_channels_play(tmp_path):
    b = triangle()
    animate(b, "translation", [0, 1], [[0, 0, 0], [2, 0, 0]])
    animate(b, "scale", [0, 1], [[1, 1, 1], [3, 3, 3]])
    b.json["animations"][1]["channels"].append(
        {"sampler": 0, "target": {"node": 0, "path": "mood"}}
    )
    b.json["animations"][1]["channels"].append({"sampler": 0, "target": {"path": "scale"}})
    path = b.glb(tmp_path / "a.glb")
    scene = gltf.read(path, time=0.5)
    matrix = scene.instances[0].transform
    assert matrix[0].tolist() == [2, 0, 0, 1]
    assert scene.warnings == ["an animation of an unsupported path is left out (1 use)"]


def test_a_second_animation_of_the_same_is_told(tmp_path):
    b = triangle()
    animate(b, "translation", [0], [[1, 0, 0]])
    animate(b, "translation", [0], [[2, 0, 0]])
    scene = gltf.read(b.glb(tmp_path / "a.glb"))
    assert scene.instances[0].transform[0, 3] == 2
    assert "a second animation of the same translation" in scene.warnings[0]


def test_animation_keeps_the_rest_of_the_node_and_moves_children(tmp_path):
    b = triangle()
    b.json["nodes"][0].update(scale=[2, 2, 2], translation=[9, 9, 9], children=[1])
    b.child(mesh=0, translation=[1, 0, 0], name="child")
    animate(b, "translation", [0, 1], [[0, 0, 0], [4, 0, 0]])
    scene = gltf.read(b.glb(tmp_path / "a.glb"), time=0.5)
    assert scene.node_positions["tri"].tolist() == [2, 0, 0]
    assert scene.node_positions["child"].tolist() == [4, 0, 0]


def test_animated_camera_and_light(tmp_path):
    b = triangle()
    b.add("cameras", {"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}})
    b.json["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "point"}]}}
    node = b.node(camera=0, extensions={"KHR_lights_punctual": {"light": 0}})
    animate(b, "translation", [0, 2], [[0, 0, 0], [0, 0, 8]], node=node)
    scene = gltf.read(b.glb(tmp_path / "a.glb"), time=1)
    (camera,) = scene.cameras.values()
    assert camera.transform[:3, 3].tolist() == [0, 0, 4]
    assert scene.lights[0][1][:3, 3].tolist() == [0, 0, 4]
