"""Records of a camera that is set up, and what files say of them."""

from __future__ import annotations

import dataclasses
import json
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.setup.camera import set_up
from daguerre.setup.metadata import camera_metadata, facts_of
from daguerre.setup.resolved import ResolvedCamera
from daguerre.setup.straight import straight_focal_px

SIZE = (36, 24)
GAUSS = "double-gauss-50mm-f2"


def resolved(**given: Any) -> ResolvedCamera:
    return set_up(dg.Scene(), dg.Camera(**{"focus_distance": 2.0} | given), SIZE, None)


def test_a_record_is_made_whole_and_stays() -> None:
    setup = resolved(lens=GAUSS, f_stop=4.0, shift=(1.0, -2.0))
    with pytest.raises(dataclasses.FrozenInstanceError):
        setup.frame_size_mm = (1.0, 1.0)  # type: ignore[misc]
    with pytest.raises(ValueError, match="read-only"):
        setup.world_from_camera[0, 0] = 2
    assert setup.shift_mm == (1.0, -2.0)
    assert (setup.lens.model, setup.lens.f_stop, setup.lens.focus_distance_m) == ("exact", 4.0, 2.0)
    assert setup.setting.f_stop == 4.0
    assert setup.lens.t_stop > 4.0  # type: ignore[operator]


@pytest.mark.parametrize(
    ("given", "model", "glass"),
    [
        ({"lens": "pinhole"}, "pinhole", False),
        ({"lens": "thin"}, "thin", False),
        ({"lens": GAUSS}, "exact", True),
        ({"lens": GAUSS, "lens_model": "pinhole"}, "pinhole", True),
        ({"lens": GAUSS, "lens_model": "thick"}, "thick", True),
        ({"lens": GAUSS, "lens_model": "polynomial", "fit_tolerance": 1e-6}, "exact", True),
    ],
)
def test_the_model_is_what_draws(given: dict[str, Any], model: str, glass: bool) -> None:
    setup = resolved(**given)
    assert setup.lens.model == model
    assert (setup.lens.glass is not None) == glass
    assert facts_of(setup)["lens_model"] == model


@pytest.mark.parametrize("lens", ["pinhole", "thin", GAUSS])
def test_facts_are_json_and_say_the_numbers_of_the_record(lens: str) -> None:
    setup = resolved(lens=lens)
    facts = facts_of(setup)
    assert json.loads(json.dumps(facts)) == facts
    assert facts["frame_size_mm"] == list(setup.frame_size_mm)
    assert facts["h0"] == setup.h0
    assert facts.get("f_stop") == setup.lens.f_stop
    assert facts.get("focus_distance_m") == setup.lens.focus_distance_m
    said = camera_metadata(setup.camera, setup, SIZE[0])
    assert said["pinholeFocalLength"] == setup.lens.pinhole_focal_length_mm
    assert said["camera"] == facts
    moved = dataclasses.replace(setup, shift_mm=(3.0, 1.0))
    assert facts_of(moved)["shift_mm"] == [3.0, 1.0]


def test_changes_are_named() -> None:
    turning = dg.keys([(0.0, (0.0, 0.0)), (1.0, (8.0, 0.0))])
    setup = resolved(lens="thin", tilt=turning, shutter_time=1.0, shutter_offset=0.0)
    assert list(setup.changes) == ["tilt"]
    assert setup.changes["tilt"].close == [8.0, 0.0]
    assert facts_of(setup)["motion"]["tilt"]["open"] == [0.0, 0.0]
    assert setup.camera.tilt == (4.0, 0.0)  # mid-shutter


def test_the_focal_length_of_a_straight_picture_is_read_back() -> None:
    setup = resolved(lens="pinhole", focal_length=50.0)
    said = camera_metadata(setup.camera, setup, SIZE[0])
    assert straight_focal_px(said, "here") == pytest.approx(50.0 / (setup.frame_size_mm[0] / 36))
    skewed = dg.Projection("rectilinear", SIZE, (40.0, 50.0), (17.5, 11.5), ())
    setup = resolved(projection=skewed, focus_distance=None)
    said = camera_metadata(setup.camera, setup, SIZE[0])
    assert straight_focal_px(said, "here") == pytest.approx(40.0)
    with pytest.raises(dg.InputError, match=r"here: wanted a pinhole.* got exact"):
        straight_focal_px({"camera": {"lens_model": "exact"}}, "here")
    with pytest.raises(dg.InputError, match="here: wanted the camera's focal length"):
        straight_focal_px({"camera": {"lens_model": "pinhole"}}, "here")
    assert np.isfinite(setup.world_from_camera).all()


@pytest.mark.parametrize(
    ("given", "notes"),
    [
        ({"lens": "sigma-17-40mm-f1.8", "sensor_size": (23.5, 15.6)}, 0),
        ({"lens": "sigma-17-40mm-f1.8", "sensor_size": (24.6, 16.4)}, 1),
        ({"lens": GAUSS}, 0),
    ],
)
def test_a_frame_larger_than_the_stated_image_circle_is_noted(
    given: dict[str, Any], notes: int
) -> None:
    said = "larger than the image circle of Sigma 17-40 mm f/1.8 DC Art, 28.2 mm across"
    setup = resolved(zoom=30.0 if "sigma" in given["lens"] else None, f_stop=8.0, **given)
    assert sum(said in note for note in setup.notes) == notes
