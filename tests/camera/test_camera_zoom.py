"""Zoom, best focus, T-stop and decentred elements: what a camera asks of its lens."""

from __future__ import annotations

import math
import re
from typing import Any

import numpy as np
import pytest

import daguerre as dg
import daguerre._core as _core
from daguerre import lenses
from daguerre.cli.info import camera_rows
from daguerre.setup.camera import set_up
from daguerre.setup.camera_facts import camera_facts
from daguerre.setup.metadata import facts_of
from tests.camera.test_lens_models import LENS
from tests.support.scene import scenes

ZOOM = "nikon-ai-25-50mm-f4"
GROUPS = "telephoto-200mm-f1.8"


def facts(camera: dg.Camera) -> dict[str, Any]:
    return facts_of(set_up(dg.Scene(), camera, (36, 24), None))


def thick(**given: Any) -> dg.Camera:
    return dg.Camera(lens=ZOOM, lens_model="thick", focus_distance=5.0).with_(**given)


@pytest.mark.parametrize("zoom", [26.0, 35.0, 48.0])
def test_a_zoom_stands_where_it_is_told(zoom: float) -> None:
    setup = set_up(dg.Scene(), thick(zoom=zoom, focus_distance=math.inf), (36, 24), None)
    assert setup.lens.effective_focal_length_mm == pytest.approx(zoom, rel=1e-3)
    assert setup.lens.pinhole_focal_length_mm == pytest.approx(zoom, rel=1e-3)
    assert facts_of(setup)["zoom_mm"] == zoom


def test_focal_lengths_that_a_lens_does_not_have_are_refused() -> None:
    with pytest.raises(dg.InputError, match=r"25.* 48.*\[lens-zoom\]"):
        facts(thick(zoom=70.0))
    with pytest.raises(dg.InputError, match="lens-zoom"):
        facts(thick(lens=LENS, zoom=60.0))
    with pytest.raises(dg.UsageError, match=r"focal_length: .*zoom lenses take zoom"):
        facts(dg.Camera(lens=ZOOM, focal_length=35.0))
    with pytest.raises(dg.UsageError, match="zoom: wanted a lens with a prescription"):
        facts(dg.Camera(zoom=35.0))


def test_a_zoom_that_turns_while_the_shutter_is_open_keeps_its_film_and_its_focus() -> None:
    swept = dg.keys([(0.0, 30.0), (1.0, 31.0)])
    camera = thick(zoom=swept, shutter_time=1.0, shutter_offset=0.0, fps=1.0, f_stop=8.0)
    frame = dg.render(scenes.furnace(), camera, resolution=(12, 8), spp=16, filter="box")
    assert np.asarray(frame.xyz)[4, 6, 1] == pytest.approx(1, abs=0.03)
    assert frame.metadata["camera"]["motion"]["zoom"]["close"] == 31.0
    assert frame.metadata["camera"]["zoom_mm"] == pytest.approx(30.5)


def test_a_lens_whose_groups_focus_breathes_as_its_groups_say() -> None:
    lens = lenses.load(GROUPS)
    near = dg.Camera(lens=GROUPS, lens_model="thick", focus_distance=4.0)
    found = facts(near)
    assert found["effective_focal_length_mm"] == pytest.approx(lens.focused(4.0).efl_mm)
    assert found["effective_focal_length_mm"] != pytest.approx(lens.first_order().efl, rel=1e-3)
    with pytest.raises(dg.InputError, match="lens-focus-near"):
        facts(near.with_(focus_distance=0.3))


@pytest.mark.skipif(
    not hasattr(_core.Prescription, "best_focus"), reason="the core searches no best focus yet"
)
def test_best_focus_is_the_smaller_spot() -> None:
    """RMS spot on the axis, wide open: that of the film which is asked for."""
    lens = lenses.load(LENS)
    spots = {}
    for by in ("paraxial", "best"):
        camera = dg.Camera(lens=LENS, lens_model="thick", focus_distance=3.0, f_stop=2.1)
        found = facts(camera.with_(focus_by=by))
        film = found["entrance_pupil_offset_mm"] + lens.first_order().entrance_pupil.z
        pupil = lens.first_order().entrance_pupil
        r = (
            np.sqrt((np.arange(200) + 0.5) / 200)
            * pupil.diameter
            / 2
            * lens.first_order().f_number
            / 2.1
        )
        start = np.array([0.0, 0.0, pupil.z - 3000.0])
        aims = np.stack([r, 0 * r, np.full_like(r, pupil.z)], axis=1) - start
        points = lens.trace(start, aims, image_z=film)
        spots[by] = math.sqrt(np.nanmean(points[:, 0] ** 2))
    assert spots["best"] < 0.7 * spots["paraxial"]


@pytest.mark.parametrize("model", ["thin", "thick"])
def test_a_t_stop_counts_the_light_that_the_glass_lets_pass(model: str) -> None:
    camera = dg.Camera(lens=LENS, lens_model=model, focus_distance=3.0, t_stop=4.0)
    found = facts(camera)
    assert 0.5 < found["transmittance"] < 1
    assert found["f_stop"] == pytest.approx(4 * math.sqrt(found["transmittance"]))
    assert found["t_stop"] == 4.0
    plain = facts(camera.with_(f_stop=found["f_stop"]))
    assert plain["t_stop"] == pytest.approx(4.0)


def test_t_stops_that_cannot_be_are_refused() -> None:
    with pytest.raises(dg.InputError, match=r"t_stop: wanted 2\.\d+ or more, as .*lens-f-stop"):
        facts(dg.Camera(lens=LENS, lens_model="thick", t_stop=1.4))
    with pytest.raises(dg.UsageError, match="either f_stop or t_stop"):
        dg.Camera(lens=LENS).with_(f_stop=4.0, t_stop=4.0)
    with pytest.raises(dg.UsageError, match="t_stop: a pinhole has none"):
        dg.Camera().with_(lens="pinhole", t_stop=4.0)
    assert dg.Camera(f_stop=4.0).with_(t_stop=4.0).f_stop is None
    assert dg.Camera(lens=LENS, t_stop=4.0).with_(lens_model="pinhole").t_stop is None


@pytest.mark.parametrize(
    ("decenter", "wanted"),
    [
        ((((0, 99), (0, 0)),), r"wanted surfaces \(first, last\) within 0"),
        ((((1, 2),),), r"decenter\[0\]: wanted"),
        ((((1, 2), (0, math.inf)),), "two finite numbers"),
        (5, "decenter"),
    ],
)
def test_decentred_elements_that_cannot_be_are_refused(decenter: Any, wanted: str) -> None:
    with pytest.raises((dg.UsageError, dg.InputError), match=wanted):
        facts(dg.Camera(lens=LENS, focus_distance=3.0, decenter=decenter))


def test_a_model_without_elements_has_none_to_move() -> None:
    moved = (((1, 2), (0.1, 0.0)),)
    with pytest.raises(dg.UsageError, match="wanted lens_model exact"):
        facts(dg.Camera(lens=LENS, lens_model="thick", focus_distance=3.0, decenter=moved))
    assert dg.Camera(lens=LENS, decenter=moved).with_(lens="thin").decenter == ()


@pytest.mark.parametrize(
    ("camera", "wanted"),
    [
        (thick(), r"25.* to 48.* mm, set to"),
        (
            dg.Camera(lens=LENS, lens_model="thin", t_stop=4.0),
            r"T/4 of .* is f/3\.\d+: the glass transmits \d+",
        ),
        (dg.Camera(tilt=(6.0, 0.0), focal_length=50.0), r"6 deg: .* line 478 mm from the lens"),
    ],
)
def test_notes_say_what_a_picture_does_not_show(camera: dg.Camera, wanted: str) -> None:
    (note,) = set_up(dg.Scene(), camera.with_(focus_distance=3.0), (36, 24), None).notes
    assert re.search(wanted, note)


def test_info_has_rows_for_what_a_lens_can_do() -> None:
    camera = thick(zoom=35.0, tilt=(3.0, -1.0), t_stop=8.0)
    rows = camera_rows(camera_facts(camera, dg.Scene()), (960, 540))
    assert rows["zoom"].startswith("35 mm of 25.")
    assert rows["T-stop"] == "T/8 on the axis"
    assert rows["tilt"] == "3 deg about x, -1 deg about y"
    assert not {"squeeze", "decentred"} & set(rows)
    moved = dg.Camera(lens=LENS, focus_distance=3.0, decenter=(((1, 2), (0.1, 0.0)),))
    assert "1 group" in camera_rows(camera_facts(moved, dg.Scene()), (960, 540))["decentred"]
