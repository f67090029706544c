"""Exposure of scenes written for other renderers: they show what ours shows, or a note tells."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import daguerre as dg
from daguerre.exposure.lux_seconds import display_gain

MANUAL: dict[str, Any] = {"exposure": "manual", "f_stop": 4.0, "shutter_time": 0.02, "iso": 400.0}
CAMERAS: dict[str, dict[str, Any]] = {
    "light": {"iso": 1600.0, "shutter_time": 0.5},
    "light and EV": {"exposure_compensation": -1.5},
    "manual": MANUAL,
    "manual and EV": MANUAL | {"exposure_compensation": 2.0, "exposure_time": 0.25},
    "pinhole": {"exposure": "manual", "lens": "pinhole", "shutter_time": 0.02},
    "glass": {"lens": "double-gauss-50mm-f2", "f_stop": 2.8, "exposure_compensation": 1.0},
    "glass, manual": MANUAL | {"lens": "double-gauss-50mm-f2"},
}


def world(**fields: Any) -> dg.Scene:
    scene = dg.Scene()
    scene.set_environment(color=(0.1, 0.1, 0.1))
    scene.add_camera("main", dg.Camera(**{"focus_distance": 5.0} | fields))
    return scene


def gain_of(scene: dg.Scene) -> float:
    """Display-linear value of 1 in the picture of a scene's camera."""
    return display_gain(dg.render(scene, resolution=(6, 4), spp=1).metadata)


@pytest.mark.parametrize("name", CAMERAS)
def test_pbrt_shows_what_ours_shows(name: str, tmp_path: Path) -> None:
    """By its imaging ratio, which our reader takes for an EV; the lens file has other glass."""
    scene = world(**CAMERAS[name])
    notes = dg.export_scene(scene, tmp_path / "a.pbrt")
    assert not [note for note in notes if "exposure" in note and "left out" in note]
    again = dg.load(tmp_path / "a.pbrt")
    assert again.camera().exposure == "light"
    exact = "glass" not in name
    assert gain_of(again) == pytest.approx(gain_of(scene), rel=2e-6 if exact else 5e-3)


def test_an_automatic_exposure_is_noted(tmp_path: Path) -> None:
    scene = world(exposure="auto", exposure_compensation=1.0)
    notes = dg.export_scene(scene, tmp_path / "a.pbrt")
    assert "exposure auto is left out: the file has the mode light (1 use)" in notes
    assert dg.load(tmp_path / "a.pbrt").camera().exposure_compensation == pytest.approx(1)


def test_mitsuba_has_no_exposure_and_a_note_tells(tmp_path: Path) -> None:
    told = "exposure is left out: a film has none; ours multiplies the light by 2 (1 use)"
    assert told in dg.export_scene(world(exposure_compensation=1.0), tmp_path / "a.xml")
    notes = dg.export_scene(world(iso=800.0), tmp_path / "a.xml")
    assert not [note for note in notes if "exposure" in note]


def test_a_frozen_shutter_has_no_exposure_to_write(tmp_path: Path) -> None:
    with pytest.raises(dg.InputError, match="the shutter was frozen: exposure_time sets it"):
        dg.export_scene(world(exposure="manual", shutter_time=0.0), tmp_path / "a.pbrt")
    assert not list(tmp_path.iterdir())
