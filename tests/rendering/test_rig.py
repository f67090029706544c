"""Rigs: one scene, several cameras, one call."""

from __future__ import annotations

import math
import re
import warnings
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre import charts
from daguerre.camera.projection import Projection
from daguerre.errors import InputError, UsageError
from daguerre.rendering import session
from daguerre.rendering.rig import disparity
from daguerre.setup import built_scene

MODEL = Projection("opencv", (96, 54), (90.0, 90.0), (46.0, 27.0), (-0.1, 0.02))


def base() -> dg.Camera:
    place = np.eye(4)
    place[2, 3] = 1.5
    return dg.Camera(transform=place, projection=MODEL)


def test_a_rig_has_the_bits_of_its_cameras_and_builds_once(monkeypatch: Any) -> None:
    scene = charts.make("slanted-edge").scene(1.0)
    cameras = dg.stereo_pair(base(), 0.12)
    cameras["wide"] = base().with_(projection=Projection.of_field("equidistant", (64, 64), 170))
    alone = {
        name: dg.render(scene, camera, resolution=camera.projection.size, spp=2, seed=3)
        for name, camera in cameras.items()
        if camera.projection
    }
    built, build = [], built_scene.build
    monkeypatch.setattr(built_scene, "build", lambda *given: (built.append(1), build(*given))[1])
    frames = dg.render_rig(scene, cameras, spp=2, seed=3)
    assert len(built) == 1
    for name, frame in frames.items():
        np.testing.assert_array_equal(frame.rgb, alone[name].rgb)


def test_cameras_of_other_moments_see_them() -> None:
    """A scene built for one shutter does not serve another: it moves."""
    scene = dg.Scene()
    scene.add_light(dg.SphereLight((1, 1, 1), 0.1), dg.keys([(0, np.eye(4)), (1, 2 * np.eye(4))]))
    early, late = base().with_(shutter_time=0.01), base().with_(shutter_time=0.02)
    first = session.Session(scene, early, resolution=(96, 54))
    same = session.Session(scene, early, resolution=(96, 54), built=first.built)
    assert same.built is first.built
    other = session.Session(scene, late, resolution=(96, 54), built=first.built)
    assert other.built is not first.built
    scene.motion.lights.clear()  # what stays is the same at any moment
    again = session.Session(scene, late, resolution=(96, 54), built=first.built)
    assert again.built is first.built


def test_disparity_is_focal_length_times_baseline_over_depth() -> None:
    scene, place = dg.Scene(), np.eye(4)
    place[:3, 3] = 0.1, -0.05, -1.2
    scene.add_light(dg.SphereLight((1e3, 1e3, 1e3), 0.01), place)
    camera = dg.Camera(projection=Projection("rectilinear", (96, 54), (80.0, 80.0)))
    options: dict[str, Any] = {"filter": "box", "crop": (40, 25, 70, 35)}
    frames = dg.render_rig(scene, dg.stereo_pair(camera, 0.24), spp=512, **options)
    x = {}
    for name, frame in frames.items():
        light = np.maximum(frame.xyz[..., 1], 0)
        x[name] = (light.sum(axis=0) * np.arange(light.shape[1])).sum() / light.sum()
    assert x["left"] - x["right"] == pytest.approx(80 * 0.24 / 1.2, abs=0.05)


def test_disparity_is_where_both_pictures_show_a_point() -> None:
    """A point in one picture, projected into the other, lies so much further."""
    scene = charts.make("slanted-edge").scene(1.0)
    model = Projection("rectilinear", (96, 54), (90.0, 80.0), (46.0, 27.0))
    place = np.eye(4)
    place[2, 3] = 2.5
    cameras = dg.stereo_pair(base().with_(projection=model, transform=place), 0.12)
    frames = dg.render_rig(scene, cameras, spp=1, gt_time="mid", resolution=(48, 27), aovs=True)
    rows, columns = 0.5 + 2 * np.mgrid[:27, :48]  # in pixels of the projection
    for name, other, sign in (("left", "right", 1), ("right", "left", -1)):
        frame = frames[name]
        points = np.stack([frame.aovs[f"P.{axis}"] for axis in "XYZ"], axis=-1)
        hit = frame.aovs["depth.Z"] > 0
        assert 0.2 < hit.mean() < 0.95
        local = np.c_[points[hit], np.ones(hit.sum())] @ np.linalg.inv(cameras[other].transform).T
        there = model.project(local[:, :3] * (1, -1, -1))
        found = disparity(frame, 0.12)
        assert (found[~hit] == 0).all()
        np.testing.assert_allclose(sign * (columns[hit] - there[:, 0]) / 2, found[hit], atol=1e-4)
        np.testing.assert_allclose(there[:, 1], rows[hit], atol=1e-3)
    wide = base().with_(projection=MODEL)
    with pytest.raises(InputError, match="got opencv"):
        disparity(dg.render(scene, wide, resolution=(48, 27), spp=1, gt_time="mid"), 0.1)
    with pytest.raises(InputError, match="exact depth"):
        disparity(dg.render(scene, cameras["left"], resolution=(48, 27), spp=1, aovs=True), 0.1)
    options: dict[str, Any] = {"resolution": (48, 27), "spp": 1, "gt_time": "mid"}
    with pytest.raises(InputError, match="gt_lens='chief'"):
        disparity(dg.render(scene, cameras["left"], gt_lens="mean", **options), 0.1)


def _parallax(angle_deg: float) -> float:
    """Angle between the sights of both eyes of a panorama to a point 10 m away, of baselines."""
    camera = dg.Camera(projection=Projection.of_field("equirectangular", (64, 32), 360))
    with pytest.warns(UserWarning, match="parallax"):
        pair = dg.stereo_pair(camera, 0.1)
    turn = math.radians(angle_deg)
    point = 10 * np.array([math.sin(turn), 0, -math.cos(turn), 0.1])
    seen = [np.linalg.inv(pair[name].transform) @ point for name in ("left", "right")]
    left, right = (math.atan2(x, -z) for x, _, z, _ in seen)
    return math.remainder(left - right, math.tau) / 0.01


def test_a_pair_of_a_panorama_has_parallax_ahead_alone_as_its_note_says() -> None:
    for angle in (0, 60, 90, 120, 180):
        assert _parallax(angle) == pytest.approx(math.cos(math.radians(angle)), abs=1e-3)


@pytest.mark.parametrize(
    ("projection", "words"),
    [
        (Projection.of_field("equirectangular", (64, 32), 360), "reversed behind.* 180 degrees"),
        (Projection("cube", (384, 64), (64.0, 64.0)), "reversed behind.* 180 degrees"),
        (Projection.of_field("equidistant", (64, 64), 190), "reversed behind.* 95 degrees"),
        (Projection.of_field("equisolid", (64, 64), 170), r"90 degrees; .* reaches 85 degrees"),
        (Projection("kannala_brandt", (64, 48), (15.0, 15.0)), "reversed behind.* 122 degrees"),
        (Projection("double_sphere", (640, 480), (150.0, 150.0), None, (0.1, 0.6)), "degrees$"),
        (Projection.of_field("equidistant", (64, 64), 140), ""),
        (MODEL, ""),
        (None, ""),
    ],
)
def test_a_pair_that_lacks_parallax_at_its_sides_has_a_note(
    projection: Projection | None, words: str
) -> None:
    camera = dg.Camera(projection=projection)
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        dg.stereo_pair(camera, 0.06)
    assert len(found) == bool(words)
    for one in found:
        assert re.search(words, str(one.message))
        assert one.filename == __file__


def test_bad_rigs_are_errors() -> None:
    scene = charts.make("slanted-edge").scene(1.0)
    with pytest.raises(UsageError, match="by name"):
        dg.render_rig(scene, [base()])  # type: ignore[arg-type]
    with pytest.raises(UsageError, match="by name"):
        dg.render_rig(scene, {})
    with pytest.raises(UsageError, match="wanted a Camera, got 'left'"):
        dg.stereo_pair("left", 0.1)  # type: ignore[arg-type]
    with pytest.raises(UsageError, match="camera: name: wanted a string or None, got 1"):
        dg.render_rig(dg.Scene(), {"a": 1})  # type: ignore[dict-item]
    numbers = {"image_size": (96, 54), "camera_matrix": [90, 0, 46, 0, 90, 27, 0, 0, 1]}
    with pytest.raises(UsageError, match="wanted a Camera or None, got 'left'"):
        dg.Camera.from_opencv(numbers, camera="left")  # type: ignore[arg-type]
    with pytest.raises(UsageError, match="baseline"):
        dg.stereo_pair(base(), -1)


def test_rigs_move_with_the_body_that_they_are_fixed_to() -> None:
    """The camera turns and its file scales it: the baseline is in metres of the world."""
    turned = np.eye(4)
    turned[:3, :3] = 3.0 * np.array([[0, 0, 1], [0, 1, 0], [-1, 0, 0]])
    turned[:3, 3] = 1, 2, 3
    camera = base().with_(transform=dg.keys([(0, 3.0 * np.diag([1, 1, 1, 1 / 3])), (1, turned)]))
    pair = dg.stereo_pair(camera, 0.5)
    for time in (0.0, 0.3, 1.0):
        left, right = (pair[name].motion["transform"].at(time) for name in ("left", "right"))
        between = right[:3, 3] - left[:3, 3]
        np.testing.assert_allclose(between, 0.5 * right[:3, 0], atol=1e-12)
        middle = 0.5 * (left[:3, 3] + right[:3, 3])
        np.testing.assert_allclose(middle, camera.motion["transform"].at(time)[:3, 3], atol=1e-12)
    np.testing.assert_allclose(pair["left"].frozen_at(1.0).transform[:3, 0], (0, 0, -1), atol=1e-12)
    still = dg.stereo_pair(base().with_(transform=turned), 0.5)
    np.testing.assert_allclose(still["right"].transform[:3, 3], (1, 2, 2.75), atol=1e-12)
    scene = charts.make("slanted-edge").scene(1.0)
    frames = dg.render_rig(scene, {n: c.with_(shutter_time=0.5) for n, c in pair.items()}, spp=1)
    assert frames["left"].metadata["camera"]["motion"]["transform"]


def test_cameras_of_a_rig_share_what_the_meter_of_the_first_chose() -> None:
    scene = charts.make("slanted-edge").scene(300.0)
    left, right = (
        one.with_(exposure="auto", shutter_time=time)
        for one, time in zip(dg.stereo_pair(base(), 0.6).values(), (0.01, 0.001), strict=True)
    )
    frames = dg.render_rig(scene, {"left": left, "right": right}, spp=1)
    alone = dg.render(scene, left, resolution=(96, 54), spp=1)
    isos = {name: frame.metadata["isoSpeed"] for name, frame in frames.items()}
    assert isos == dict.fromkeys(frames, alone.metadata["isoSpeed"])
    assert {frame.metadata["exposure"] for frame in frames.values()} == {"auto"}
    assert dg.render(scene, right, resolution=(96, 54), spp=1).metadata["isoSpeed"] > isos["left"]
