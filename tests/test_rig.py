"""Rigs: one scene, several cameras, one call."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre import charts, session
from daguerre.errors import UsageError
from daguerre.projection import Projection

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
    built, build = [], session.build
    monkeypatch.setattr(session, "build", lambda *given: (built.append(1), build(*given))[1])
    frames = dg.render_rig(scene, cameras, spp=2, seed=3)
    assert len(built) == 1
    for name, frame in frames.items():
        np.testing.assert_array_equal(frame.rgb, alone[name].rgb)


def test_cameras_of_other_moments_see_them() -> None:
    """What was built for one shutter does not serve another: the scene moves."""
    scene = charts.make("slanted-edge").scene(1.0)
    early, late = base().with_(shutter_time=0.01), base().with_(shutter_time=0.02)
    first = session.Session(scene, early, resolution=(96, 54))
    assert session.Session(scene, early, resolution=(96, 54), beside=first)._core_scene is (
        first._core_scene
    )
    other = session.Session(scene, late, resolution=(96, 54), beside=first)
    assert other._core_scene is not first._core_scene


def test_disparity_is_focal_length_times_baseline_over_depth() -> None:
    scene, place = dg.Scene(), np.eye(4)
    place[:3, 3] = 0.1, -0.05, -1.2
    scene.add_light(dg.SphereLight((1e3, 1e3, 1e3), 0.01), place)
    camera = dg.Camera(projection=Projection("rectilinear", (96, 54), (80.0, 80.0)))
    frames = dg.render_rig(scene, dg.stereo_pair(camera, 0.24), spp=512, filter="box")
    x = {}
    for name, frame in frames.items():
        light = np.maximum(frame.xyz[..., 1], 0)
        x[name] = (light.sum(axis=0) * np.arange(96)).sum() / light.sum()
    assert x["left"] - x["right"] == pytest.approx(80 * 0.24 / 1.2, abs=0.05)


def test_bad_rigs_are_errors() -> None:
    scene = charts.make("slanted-edge").scene(1.0)
    with pytest.raises(UsageError, match="by name"):
        dg.render_rig(scene, [base()])  # type: ignore[arg-type]
    with pytest.raises(UsageError, match="by name"):
        dg.render_rig(scene, {})
    with pytest.raises(UsageError, match="baseline"):
        dg.stereo_pair(base(), -1)
    moving = base().with_(transform=dg.keys([(0, np.eye(4)), (1, np.eye(4))]))
    with pytest.raises(UsageError, match="stays"):
        dg.stereo_pair(moving, 0.1)
