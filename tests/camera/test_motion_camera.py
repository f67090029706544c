"""Camera parameters over time: which may, where they are kept, and what changes do to them."""

from __future__ import annotations

import numpy as np
import pytest

import daguerre as dg
from daguerre.errors import UsageError


def test_a_parameter_over_time_is_kept_beside_its_value():
    pull = dg.keys([(1, 2.0), (2, 4.0)])
    camera = dg.Camera(focus_distance=pull, f_stop=2.8, blades=dg.keys([(0, 5), (1, 7)], "step"))
    assert camera.motion["focus_distance"] is pull
    assert (camera.focus_distance, camera.f_stop, camera.blades) == (2.0, 2.8, 5)
    later = camera.frozen_at(1.5)
    assert (later.focus_distance, later.blades, later.motion) == (3.0, 7, {})
    assert isinstance(later.blades, int)
    moved = camera.evaluated_at(1.5)
    assert moved.focus_distance == 3.0
    assert moved.motion == camera.motion


def test_a_camera_that_stays_is_itself():
    camera = dg.Camera()
    assert camera.frozen_at(3.0) is camera


def test_transform_and_one_of_two_numbers():
    end = np.eye(4)
    end[0, 3] = 2
    camera = dg.Camera(
        transform=dg.keys([(0, np.eye(4)), (1, end)]), shift=(0.0, dg.keys([(0, 0), (1, 8)]))
    )
    assert camera.frozen_at(0.25).shift == (0.0, 2.0)
    assert camera.frozen_at(0.25).transform[0, 3] == 0.5
    assert np.array_equal(camera.transform, np.eye(4))


def test_a_change_replaces_the_motion():
    camera = dg.Camera(f_stop=dg.keys([(0, 2), (1, 4)]), focal_length=dg.keys([(0, 20), (1, 40)]))
    assert camera.with_(iso=200).motion.keys() == {"f_stop", "focal_length"}
    assert camera.with_(f_stop=8).frozen_at(1).f_stop == 8
    wide = camera.with_(aperture_diameter=5.0)
    assert wide.motion.keys() == {"focal_length"}
    assert camera.with_(lens="double-gauss-50mm-f2").motion.keys() == {"f_stop"}
    focused = camera.with_(focus_distance=dg.keys([(0, 1), (1, 2)]))
    assert focused.frozen_at(0.5).focus_distance == 1.5
    assert focused.with_(focus_on="node").motion.keys() == camera.motion.keys()


@pytest.mark.parametrize("name", ["lens", "fps", "focus_on", "shutter_type", "aperture_image"])
def test_what_stays(name):
    with pytest.raises(UsageError, match=f"camera: {name}: cannot change over time"):
        dg.Camera(**{name: dg.keys([(0, 1), (1, 2)])})
