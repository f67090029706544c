"""``composite`` and ``render --like-plate`` tell what does not go together."""

import json

import numpy as np
import pytest
from PIL import Image

import daguerre as dg
from daguerre.cli import main
from tests.support.formats.make_gltf import triangle
from tests.support.pictures.plate_frames import of_light
from tests.support.pictures.plate_textures import TEXTURES

SHAPE = (160, 240)
FACTS = {"nominalFocalLength": 35.0, "isoSpeed": 400, "focus": 3.0}


@pytest.fixture
def folder(tmp_path):
    """A plate, one of fabric with its camera file, and an object with and without alpha."""
    ramp = np.linspace(0.02, 0.9, SHAPE[1]) * np.ones((SHAPE[0], 1))
    for name, light in (("ok", ramp), ("weave", TEXTURES["weave"]()[: SHAPE[0], : SHAPE[1]])):
        raw = of_light(light, 0.5 * 78 / 400, **FACTS).expose("sony-a7r-ii", 400, seed=1)
        raw.save(tmp_path / f"{name}.png", look="standard")
    dg.match_plate(tmp_path / "weave.png").save(tmp_path / "weave.camera.json")
    clear = np.zeros(SHAPE, np.float32)
    clear[:40] = 1
    frame = of_light(0.1 * ramp, 0.5 * 78 / 400, **FACTS)
    frame.save(tmp_path / "covers.exr")
    frame.alpha = clear
    frame.save(tmp_path / "object.exr")
    return tmp_path


def told(capfd):
    return capfd.readouterr().err


def put(folder, plate, objects, *more):
    return main(
        [
            "composite",
            str(folder / plate),
            str(folder / objects),
            *more,
            "-o",
            str(folder / "out.png"),
        ]
    )


def test_what_goes_together_has_no_remark(folder, capfd):
    assert put(folder, "ok.png", "object.exr") == 0
    assert told(capfd).count("\n") == 1


def test_camera_of_another_plate(folder, capfd):
    assert (
        put(folder, "ok.png", "object.exr", "--like-plate", str(folder / "weave.camera.json")) == 0
    )
    text = told(capfd)
    assert "ok.png: the camera was matched to another file, weave.png" in text
    assert "no noise was measured in weave.png: objects get no grain" in text
    assert (
        put(folder, "weave.png", "object.exr", "--like-plate", str(folder / "weave.camera.json"))
        == 0
    )
    assert "another file" not in told(capfd)


def test_objects_without_alpha(folder, capfd):
    assert put(folder, "ok.png", "covers.exr") == 0
    assert (
        "covers.exr: alpha is missing or 1 everywhere, so the render covers the whole plate"
        in told(capfd)
    )


def test_alpha_of_the_plate(folder, capfd):
    picture = Image.open(folder / "ok.png").convert("RGBA")
    picture.putalpha(128)
    picture.save(folder / "alpha.png")
    assert put(folder, "alpha.png", "object.exr") == 0
    assert "alpha is ignored: 38400 of 38400 pixels are not opaque" in told(capfd)


def test_render_without_grain(folder, capfd):
    triangle().glb(folder / "s.glb")
    out = folder / "r.png"
    flags = ["--like-plate", str(folder / "weave.camera.json"), "--spp", "1", "-o", str(out)]
    assert main(["render", str(folder / "s.glb"), *flags]) == 0
    assert "no noise was measured in weave.png: objects get no grain" in told(capfd)
    assert json.loads((folder / "weave.camera.json").read_text())["noise"] is None
