"""Brightness and shutter over time: a picture has those of its own time."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.development import develop

SQUARE = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float32)
SIZE = (24, 16)


def scene() -> dg.Scene:
    """A square that shines and moves sideways."""
    made = dg.Scene()
    places = []
    for time in (0.0, 1.0):
        place = np.eye(4)
        place[:3, 3] = 8 * time - 4, 0, -5
        places.append((time, place))
    mesh = made.add_mesh(SQUARE, [[0, 1, 2], [0, 2, 3]])
    made.add_instance(mesh, dg.Gltf(emissive=(1, 1, 1)), dg.keys(places))
    return made


def drawn(camera: dg.Camera, time: float) -> dg.Frame:
    return dg.render(scene().at(time), camera, resolution=SIZE, spp=4)


def told(frame: dg.Frame) -> dict[str, str]:
    return {name: repr(value) for name, value in frame.metadata.items()}


SHUTTERS: list[dict[str, Any]] = [
    {"shutter_time": dg.keys([(0, 0.0), (1, 0.2)])},
    {"shutter_angle": dg.keys([(0, 90.0), (1, 360.0)])},
    {"shutter_offset": dg.keys([(0, -2.0), (1, 2.0)])},
    {"shutter_time": dg.keys([(0, 0.1), (1, 0.02)]), "shutter_type": "focal_plane"},
]


@pytest.mark.parametrize("changing", SHUTTERS)
@pytest.mark.parametrize("time", [0.25, 0.75])
def test_a_picture_has_the_shutter_of_its_time(changing: dict[str, Any], time: float) -> None:
    camera = dg.Camera(lens="pinhole").with_(**changing)
    now = {name: getattr(v, "at", lambda t, v=v: v)(time) for name, v in changing.items()}
    fixed = drawn(dg.Camera(lens="pinhole").with_(**now), time)
    moving = drawn(camera, time)
    np.testing.assert_array_equal(moving.rgb, fixed.rgb)
    assert told(moving) == told(fixed)
    other = drawn(camera, 1 - time)
    assert not np.array_equal(other.rgb, fixed.rgb)


def test_a_picture_has_one_brightness() -> None:
    changing: dict[str, Any] = {
        "iso": dg.keys([(0, 100.0), (1, 400.0)]),
        "exposure_compensation": dg.keys([(0, 0.0), (1, 2.0)]),
        "exposure_time": dg.keys([(0, 0.01), (1, 0.03)]),
        "exposure_f_stop": dg.keys([(0, 2.0), (1, 4.0)]),
        "responsivity": dg.keys([(0, 1.0), (1, 3.0)]),
    }
    still = dg.Camera(f_stop=2.8, focus_distance=5)
    for time in (0.0, 0.5):
        fixed = still.with_(**{name: value.at(time) for name, value in changing.items()})
        ours, wanted = drawn(still.with_(**changing), time), drawn(fixed, time)
        np.testing.assert_array_equal(ours.rgb, wanted.rgb)
        assert told(ours) == told(wanted)
        np.testing.assert_array_equal(develop(ours).pixels, develop(wanted).pixels)


def test_ground_truth_has_the_shutter_of_its_time() -> None:
    moving = dg.Camera(lens="pinhole", shutter_time=dg.keys([(0, 0.0), (1, 0.2)]))
    fixed = dg.Camera(lens="pinhole", shutter_time=0.15)
    for moment in ("open", "close"):
        options: dict[str, Any] = {"resolution": SIZE, "spp": 1, "aovs": True, "gt_time": moment}
        ours = dg.render(scene().at(0.75), moving, **options)
        wanted = dg.render(scene().at(0.75), fixed, **options)
        for name in wanted.aovs:
            np.testing.assert_array_equal(ours.aovs[name], wanted.aovs[name])
