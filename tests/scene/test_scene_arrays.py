"""Scenes, cameras and renders from Python: what is wrong is named, what is obsolete goes."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.cli import main
from daguerre.files import extras
from daguerre.rendering.session import Session
from tests.support.formats.make_gltf import Builder
from tests.support.scene import scenes

SQUARE = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]
FACES = [[0, 1, 2], [0, 2, 3]]


def small() -> dg.Scene:
    scene = dg.Scene()
    scene.add_instance(scene.add_mesh(SQUARE, FACES), dg.Diffuse((0.5, 0.5, 0.5)), name="wall")
    scene.add_camera("Camera", dg.Camera(transform=scenes.at(0, 0, 3)))
    scene.set_environment(color=(1, 1, 1))
    return scene


BAD: list[tuple[str, Callable[[dg.Scene], Any], str]] = [
    ("steps", lambda s: s.add_mesh(SQUARE, FACES, steps=[0]), "steps: vertices per time step"),
    ("text", lambda s: s.add_mesh("abc", FACES), "positions: wanted shape"),
    ("ragged", lambda s: s.add_mesh([[1, 2], [3]], FACES), "unequal length"),
    ("quads", lambda s: s.add_mesh(SQUARE, [[0, 1, 2, 3]] * 3), r"indices: wanted shape \(M, 3\)"),
    (
        "overflow",
        lambda s: s.add_mesh([[1e300, 0, 0]] * 4, FACES),
        r"positions\[0\]: wanted finite",
    ),
    ("uv", lambda s: s.add_mesh(SQUARE, FACES, uv=[[0, np.nan]] * 4), r"uv\[0\]"),
    ("material", lambda s: s.add_instance(0, "red"), "material: wanted an index, got 'red'"),
    ("mesh", lambda s: s.add_instance(-1), "mesh: wanted 0 .. 0, got -1"),
    ("keys", lambda s: s.add_instance(0, None, [(0, np.eye(4)), (1, np.eye(4))]), "keys over time"),
    ("colour", lambda s: s.add_material(dg.Diffuse(0.5)), "reflectance: wanted three numbers"),
    ("field", lambda s: s.add_material(emissio=(1, 1, 1)), "did you mean 'emission'"),
    ("light", lambda s: s.add_light("sun"), "wanted a point, spot"),
    ("intensity", lambda s: s.add_light(dg.PointLight(5)), "intensity: wanted three numbers"),
    ("dark", lambda s: s.add_light(dg.PointLight((-1, 0, 0))), "intensity: wanted three finite"),
    ("cone", lambda s: s.add_light(dg.SpotLight(inner_angle=60)), "inner_angle < outer_angle"),
    ("angle", lambda s: s.add_light(dg.DirectionalLight(angle=400)), "angle: wanted a number"),
    ("camera", lambda s: s.add_camera("a", "b"), "wanted a Camera, got 'b'"),
    (
        "film size",
        lambda s: s.add_camera("a", dg.Camera(), film_size=(0, 5)),
        "film_size: wanted 1 .. 65536, got 0",
    ),
    ("sky", lambda s: s.set_environment(color=(1, 2)), "color: wanted three numbers"),
    ("night", lambda s: s.set_environment(-np.ones((2, 4, 3))), "at least 0"),
]


@pytest.mark.parametrize(("act", "message"), [b[1:] for b in BAD], ids=[b[0] for b in BAD])
def test_what_is_wrong_is_named_and_nothing_is_added(
    act: Callable[[dg.Scene], Any], message: str
) -> None:
    scene = small()
    before = [len(x) for x in (scene.meshes, scene.instances, scene.lights, scene.cameras)]
    with pytest.raises(dg.DaguerreError, match=message):
        act(scene)
    after = [len(x) for x in (scene.meshes, scene.instances, scene.lights, scene.cameras)]
    assert after == before


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"f_stop": "wide"}, "f_stop: wanted a number above 0, got 'wide'"),
        ({"f_stop": 1e-308}, "f_stop: wanted a number of at least 0.01"),
        ({"focal_length": 1e300}, "focal_length: wanted"),
        ({"sensor_size": 36}, "sensor_size: wanted two"),
        ({"sensor_size": (1e19, 24)}, "sensor_size: wanted"),
        ({"shutter_time": -1}, "shutter_time"),
        ({"iso": "fast"}, "iso"),
        ({"shift": (1,)}, "shift: wanted two"),
        ({"lens": 5}, "lens: wanted a name"),
        ({"aperture_image": np.ones(4)}, r"aperture_image: wanted shape \(H, W\)"),
        ({"lens": "tessar-50mm-f2.8", "focal_length": 35}, "prescription has its own"),
        ({"lens": "pinhole", "f_stop": 2}, "f_stop: a pinhole has none"),
        ({"focus_on": "wall", "focus_distance": 2}, "wanted either"),
    ],
)
def test_a_camera_refuses_what_it_cannot_honour(changes: dict[str, Any], message: str) -> None:
    scene = small()
    with pytest.raises(dg.DaguerreError, match=message):
        dg.render(scene, scene.camera().with_(**changes), resolution=(4, 3), spp=1)


@pytest.mark.parametrize(
    "options",
    [
        {"resolution": 5},
        {"resolution": (1.5, 2)},
        {"spp": 1.5},
        {"seed": "x"},
        {"crop": 5},
        {"filter": None},
    ],
)
def test_options_of_a_render_are_checked(options: dict[str, Any]) -> None:
    with pytest.raises(dg.UsageError, match=next(iter(options))):
        dg.render(small(), **{"resolution": (4, 3), "spp": 1, **options})


def test_a_change_replaces_its_rivals() -> None:
    ideal = dg.Camera(focal_length=35, aperture_diameter=10, focus_on="wall")
    real = ideal.with_(lens="tessar-50mm-f2.8", focus_distance=2.0)
    assert (real.focal_length, real.aperture_diameter, real.focus_on) == (None, None, None)
    assert ideal.with_(f_stop=4).aperture_diameter is None
    assert ideal.with_(lens="pinhole").focal_length == 35


def test_a_camera_may_be_named_and_a_scene_told_by_its_hash() -> None:
    scene = small()
    frame = dg.render(scene, "Camera", resolution=(4, 3), spp=1)
    assert frame.metadata["scene_hash"] == Session(scene, resolution=(8, 6)).key["scene"]
    scene.add_light(dg.PointLight())
    other = dg.render(scene, "Camera", resolution=(4, 3), spp=1)
    assert other.metadata["scene_hash"] != frame.metadata["scene_hash"]
    assert frame.metadata["bad_samples"] == 0


def test_a_prescription_whose_image_is_far_smaller_than_the_sensor() -> None:
    scene = dg.Scene()
    scene.set_environment(color=(1, 1, 1))
    camera = dg.Camera(lens="tessar-50mm-f2.8", sensor_size=(3600, 2400), focus_distance=np.inf)
    frame = dg.render(scene, camera, resolution=(45, 30), spp=64)
    assert frame.rgb[14:16, 22].mean() > 0.1
    assert frame.rgb[0].max() == 0


def test_a_plot_without_matplotlib(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(extras, "find_spec", lambda name: None)
    for flag, name in (("--plot", "lens.svg"), ("--plot", "lens.png"), ("--drawing", "lens.png")):
        target = tmp_path / name
        assert main(["lens", "tessar-50mm-f2.8", flag, str(target)]) == 2
        assert extras.hint("matplotlib") in capsys.readouterr().err
        assert not target.exists()
    assert main(["lens", "tessar-50mm-f2.8", "--drawing", str(tmp_path / "lens.svg")]) == 0


@pytest.mark.parametrize(
    ("camera", "where"),
    [
        ({"yfov": 1e-300}, "perspective.yfov"),
        ({"yfov": 1, "aspectRatio": 1e19}, "perspective.aspectRatio"),
    ],
)
def test_absurd_cameras_of_a_file(tmp_path: Path, camera: dict[str, float], where: str) -> None:
    made = Builder()
    made.add("cameras", {"type": "perspective", "perspective": {"znear": 0.1, **camera}})
    made.node(camera=0)
    path = made.glb(tmp_path / "a.glb")
    with pytest.raises(dg.InputError, match=where):
        dg.load(path)
