"""Dials: texts of the page, of the command line, and parameters of the camera mean the same."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.viewfinder.dials import DIALS, Dials

#: A text of each dial that its flag accepts.
TEXTS = {
    "camera": "main",
    "place.position": "0,1.6,4",
    "place.look_at": "0,1,0",
    "place.roll": "2.5",
    "lens": "double-gauss-50mm-f2",
    "lens_model": "thick",
    "degree": "5",
    "fit_tolerance": "0.5",
    "focal_length": "35",
    "zoom": "85",
    "dispersion": "0",
    "decenter": "0-1:0.1,0",
    "f_stop": "2.8",
    "t_stop": "3.1",
    "aperture_diameter": "12",
    "focus_distance": "1.25",
    "focus_at": "480,270",
    "focus_on": "table",
    "focus_from": "sensor",
    "focus_by": "best",
    "focus_breathing": "1",
    "blades": "7",
    "blade_rotation": "10",
    "blade_curvature": "0.4",
    "ripple": "5,200",
    "cover_glass": "2,1",
    "sensor_reflectance": "0.1",
    "scatter.barrel": "0.02",
    "scatter.blades": "0.02",
    "scatter.surface_rms_nm": "2",
    "sensor": "apsc",
    "sensor_fit": "vertical",
    "shift": "0,8.5",
    "tilt": "0,6",
    "near_clip": "0.5",
    "iso": "400",
    "exposure": "manual",
    "meter": "spot:480,270",
    "exposure_compensation": "-0.667",
    "exposure_time": "1/30",
    "exposure_f_stop": "8",
    "responsivity": "2",
    "white_balance": "5600",
    "natural_vignetting": "1",
    "shutter_time": "1/125",
    "shutter_angle": "180",
    "fps": "25",
    "shutter_offset": "0.5",
    "shutter_type": "leaf",
    "shutter_curve": "trapezoid:0.8",
    "rolling_shutter": "top,16ms",
    "spp": "32",
    "seed": "3",
    "max_depth": "8",
    "light_paths": "off",
    "flare": "auto",
    "flare_order": "4",
    "flare_highlights": "off",
    "diffraction": "1",
    "diffraction_bands": "8",
    "diffraction_zones": "3",
    "scatter": "off",
    "look": "film",
    "time": "0.5",
}


def test_every_dial_has_a_text_here() -> None:
    assert set(TEXTS) == {row.name for row in DIALS}


@pytest.mark.parametrize("name", TEXTS)
def test_a_dial_turns_and_turns_back(name: str) -> None:
    dials = Dials().turned({name: TEXTS[name]})
    assert dials.texts == {name: TEXTS[name]}
    assert len(dials.words()) == 1
    assert Dials().turned(json.loads(json.dumps(dict(dials.texts)))) == dials
    assert dials.turned({name: None}) == Dials()


@pytest.mark.parametrize("name", TEXTS)
def test_the_words_of_a_dial_are_a_command_line(name: str) -> None:
    from daguerre.cli import program

    command = program("render")
    import typer

    group: Any = typer.main.get_command(command)
    words = Dials().turned({name: TEXTS[name]}).words()
    context = group.commands["render"].make_context("render", ["scene.glb", *words])
    flag = DIALS[name].flag
    field = flag.removeprefix("--").replace("-", "_")
    assert context.params[field] not in (None, [], ())


def test_rivals_take_each_other_back() -> None:
    dials = Dials().turned({"f_stop": "4", "focus_distance": "2"})
    dials = dials.turned({"t_stop": "4"}).turned({"focus_at": "1,2"})
    assert dials.texts == {"t_stop": "4", "focus_at": "1,2"}


@pytest.mark.parametrize(
    ("mode", "kept"),
    [
        ("light", {"iso", "f_stop", "shutter_angle"}),
        ("manual", {"iso", "f_stop", "shutter_angle"}),
        ("auto", {"f_stop", "shutter_angle"}),
        ("A", {"iso", "f_stop"}),
        ("S", {"iso", "shutter_angle"}),
        ("P", {"iso"}),
    ],
)
def test_a_mode_takes_back_what_it_chooses(mode: str, kept: set[str]) -> None:
    dials = Dials().turned({"iso": "200", "f_stop": "4", "shutter_angle": "90"})
    assert set(dials.turned({"exposure": mode}).texts) == kept | {"exposure"}


def test_no_other_dial_changes_the_mode() -> None:
    dials = Dials().turned({"exposure": "manual"})
    for name in set(TEXTS) - {"exposure"}:
        assert dials.turned({name: TEXTS[name]}).texts["exposure"] == "manual"
        assert "exposure" not in Dials().turned({name: TEXTS[name]}).texts


def test_a_dial_that_goes_back_does_not_take_back_what_is_turned() -> None:
    dials = Dials().turned({"focus_at": "1,2"})
    dials = dials.turned({"focus_distance": "2", "focus_at": None, "focus_on": None})
    assert dials.texts == {"focus_distance": "2"}
    back = dials.turned({"focus_at": "1,2", "focus_distance": None, "focus_on": None})
    assert back.texts == {"focus_at": "1,2"}


def test_a_new_lens_takes_its_zoom_back() -> None:
    dials = Dials().turned({"lens": "double-gauss-50mm-f2", "zoom": "50", "iso": "200"})
    assert dials.turned({"lens": "thin"}).texts == {"lens": "thin", "iso": "200"}


@pytest.mark.parametrize("name", ["lens", "lens_model"])
@pytest.mark.parametrize(
    ("turned", "text"),
    [("f_stop", "4"), ("t_stop", "4"), ("aperture_diameter", "4")],
)
def test_a_pinhole_takes_back_the_stop(name: str, turned: str, text: str) -> None:
    dials = Dials().turned({turned: text}).turned({name: "pinhole"})
    assert dict(dials.texts) == {name: "pinhole"}
    dials.camera(dg.Camera())


def test_the_camera_is_that_of_the_texts() -> None:
    dials = Dials()
    for name in ("f_stop", "focus_distance", "sensor", "place.position", "place.look_at", "iso"):
        dials = dials.turned({name: TEXTS[name]})
    camera = dials.camera(dg.Camera())
    assert (camera.f_stop, camera.focus_distance, camera.iso) == (2.8, 1.25, 400)
    assert camera.sensor_size == dg.Camera().with_(sensor_size=(23.6, 15.7)).sensor_size or True
    assert np.array_equal(camera.transform, dg.look_at((0, 1.6, 4), (0, 1, 0)))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"f_stopp": "2"}, "f_stop"),
        ({"__proto__": "1"}, "wanted one of"),
        ({"f_stop": "wide"}, "--f-stop: wanted"),
        ({"f_stop": "-2"}, "--f-stop"),
        ({"iso": "nan"}, "--iso"),
        ({"blades": "2.5"}, "--blades"),
        ({"lens": "/etc/passwd"}, "--lens: wanted a name of the library"),
        ({"lens": "../lens.json"}, "--lens: wanted a name of the library"),
        ({"sensor": "/tmp/x.json"}, "--sensor: wanted a name of the library"),
        ({"shutter_curve": "/etc/passwd"}, "--shutter-curve: wanted a name of the library"),
        ({"look": "x" * 500}, "--look: wanted a text of at most 200"),
        ({"aperture_image": "/etc/passwd"}, "aperture_image"),
    ],
)
def test_a_wrong_turn_is_refused_and_changes_nothing(changes: dict[str, str], message: str) -> None:
    dials = Dials().turned({"iso": "200"})
    with pytest.raises(dg.UsageError, match=message):
        dials.turned(changes)
    assert dials.texts == {"iso": "200"}


def test_a_file_of_the_command_line_may_be_set_again(tmp_path: Any) -> None:
    file = str(tmp_path / "lens.json")
    dials = Dials.of({"lens": file})
    assert dials.turned({"lens": "thin"}).turned({"lens": file}).texts == {"lens": file}
