"""Placing a camera: ``dg.look_at``, and the flags --position, --look-at, --roll."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.camera.placement import Placement
from daguerre.cli import main
from daguerre.setup.pose import rigid


@pytest.mark.parametrize(
    ("position", "target"),
    [
        ((0, 1.6, 4), (0, 1, 0)),
        ((3, -2, 1), (-5, 7, 2)),
        ((0, 5, 0), (0, 0, 0)),
        ((1, 0, 1), (1, 9, 1)),
        ((1e6, 2, 3), (1e6, 2, 4)),
    ],
)
@pytest.mark.parametrize("roll", [0, 30, -120, 180])
def test_a_placed_camera_sees_its_target_in_the_middle(
    position: Any, target: Any, roll: float
) -> None:
    pose = dg.look_at(position, target, roll)
    assert pose.shape == (4, 4)
    assert np.array_equal(pose[3], [0, 0, 0, 1])
    assert np.allclose(pose[:3, :3].T @ pose[:3, :3], np.eye(3), atol=1e-12)
    assert np.linalg.det(pose[:3, :3]) == pytest.approx(1)
    seen = np.linalg.inv(pose) @ [*target, 1]
    distance = np.linalg.norm(np.subtract(target, position))
    assert np.allclose(seen[:3], [0, 0, -distance], atol=1e-9)
    assert np.allclose(rigid(pose), pose, atol=1e-12)


def test_a_level_camera_has_a_level_horizon_and_up_above() -> None:
    pose = dg.look_at((4, 2, 1), (0, 1, 0))
    assert pose[1, 0] == 0
    assert pose[1, 1] > 0


def test_roll_is_clockwise_as_the_photographer_sees_it() -> None:
    level, rolled = (dg.look_at((0, 0, 5), (0, 0, 0), roll) for roll in (0, 90))
    assert np.allclose(rolled[:3, 0], -level[:3, 1], atol=1e-15)  # its right hand points down
    assert np.allclose(rolled[:3, 1], level[:3, 0], atol=1e-15)


def test_straight_down_and_straight_up_have_a_known_top() -> None:
    assert np.array_equal(dg.look_at((0, 3, 0), (0, 0, 0))[:3, 1], [0, 0, -1])
    assert np.array_equal(dg.look_at((0, 0, 0), (0, 3, 0))[:3, 1], [0, 0, 1])


def test_parts_that_are_not_given_stay() -> None:
    camera = dg.Camera(transform=dg.look_at((1, 2, 3), (4, 5, 7), 20), f_stop=2)
    assert Placement().of(camera) is camera
    moved = Placement(position=(0, 0, 0)).of(camera)
    assert np.array_equal(moved.transform[:3, :3], camera.transform[:3, :3])
    assert np.array_equal(moved.transform[:3, 3], [0, 0, 0])
    turned = Placement(look_at=(0, 0, 0)).of(camera)
    assert np.array_equal(turned.transform, dg.look_at((1, 2, 3), (0, 0, 0)))
    rolled = Placement(roll=-5).of(camera)
    assert np.allclose(rolled.transform, dg.look_at((1, 2, 3), (4, 5, 7), -5), atol=1e-12)
    assert rolled.f_stop == 2


def test_a_placed_camera_stands_still() -> None:
    poses = [(0.0, np.eye(4)), (1.0, dg.look_at((0, 0, 1), (0, 0, 0)))]
    moving = dg.Camera(transform=dg.keys(poses))
    assert moving.motion
    assert not Placement(position=(0, 0, 2)).of(moving).motion


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (((0, 0, 0), (0, 0, 0)), "look_at: target: must differ from the position"),
        (((0, 0), (0, 0, 1)), "look_at: position: wanted"),
        (((0, 0, float("nan")), (0, 0, 1)), "look_at: position: wanted"),
        (((0, 0, 0), (0, 0, 1), float("inf")), "look_at: roll: wanted a number"),
    ],
)
def test_a_place_that_is_none_is_an_error(arguments: Any, message: str) -> None:
    with pytest.raises(dg.UsageError, match=message):
        dg.look_at(*arguments)


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    """A triangle in front of a camera, and one without any camera."""
    for name, cameras in (("bare", False), ("seen", True)):
        gltf: dict[str, Any] = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}]}
        if cameras:
            gltf["cameras"] = [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}}]
            gltf["nodes"] = [{"camera": 0, "name": name, "translation": [0, 0, 5]} for name in "ab"]
            gltf["scenes"][0]["nodes"] = [0, 1]
        (tmp_path / f"{name}.gltf").write_text(json.dumps(gltf))
    return tmp_path


SMALL = ["--res", "8x6", "--spp", "1", "--lens", "pinhole", "--sky", "1,1,1", "-q"]


def test_flags_place_the_camera(scene: Path) -> None:
    out = scene / "out.exr"
    place = ["--position=1,2,3", "--look-at=0,1.5,-2", "--roll=4"]
    assert main(["render", str(scene / "seen.gltf"), "-o", str(out), *SMALL, *place]) == 0
    plain = scene / "plain.exr"
    camera = dg.Camera(lens="pinhole", transform=dg.look_at((1, 2, 3), (0, 1.5, -2), 4))
    dg.render(dg.load(scene / "seen.gltf"), camera, resolution=(8, 6), spp=1).save(plain)
    seen, wanted = (dg.load_frame(path).metadata["worldToCamera"] for path in (out, plain))
    assert np.array_equal(seen, wanted)


def test_a_placed_camera_needs_none_in_the_scene(
    scene: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    command = ["render", str(scene / "bare.gltf"), "-o", str(scene / "out.exr"), *SMALL]
    assert main([*command, "--position=0,0,3"]) == 3
    assert "--position and --look-at" in capsys.readouterr().err
    assert main([*command, "--position=0,0,3", "--look-at=0,0,0"]) == 0


@pytest.mark.parametrize(
    ("flags", "message"),
    [
        (["--position=1,2"], "--position: wanted 3 numbers such as 0,1.6,4; got '1,2'"),
        (["--look-at=0,0,5"], "look_at: target: must differ from the position"),
        (["--roll=much"], "--roll: wanted"),
        (["--camera=a,b", "--position=0,0,1"], "wanted one --camera, got several"),
    ],
)
def test_wrong_places_are_one_error(
    scene: Path, capsys: pytest.CaptureFixture[str], flags: list[str], message: str
) -> None:
    command = ["render", str(scene / "seen.gltf"), "-o", str(scene / "out.exr"), *SMALL, *flags]
    assert main(command) in (2, 3)
    assert message in capsys.readouterr().err
