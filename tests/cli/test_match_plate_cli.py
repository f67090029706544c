"""``daguerre match-plate`` and ``render --like-plate``, from a photograph to its objects."""

import json

import numpy as np
import pytest
from scipy import ndimage

import daguerre as dg
from daguerre.cli import main
from daguerre.plates.files import read
from tests.support.formats.make_gltf import triangle
from tests.support.pictures.plate_edges import squares
from tests.support.pictures.plate_frames import of_light, wedge

LENS = {"lensMake": "Canon", "lensModel": "EF85mm f/1.8 USM", "nominalFocalLength": 85.0}
SHAPE = (400, 600)
LIGHT = np.concatenate([squares((200, 600), 0.8), wedge((200, 600))])


def raw(**facts):
    told = {"isoSpeed": 400, "focus": 3.0} | LENS | facts
    return of_light(LIGHT, 0.5 * 78 / 400, **told).expose("sony-a7r-ii", 400, seed=1)


@pytest.fixture
def plate(tmp_path):
    raw().save(tmp_path / "plate.dng")
    return tmp_path / "plate.dng"


def run(*words):
    return main(["match-plate", *map(str, words)])


def test_a_photograph_becomes_a_camera_file(plate, tmp_path, capsys):
    assert run(plate) == 0
    told = capsys.readouterr()
    for text in ("canon-ef-85mm-f1.8 at 85 mm", "f/5.6, 1/125 s, ISO 400", "DN/e-", "MTF50"):
        assert text in told.out
    assert f"wrote {tmp_path / 'plate.camera.json'}" in told.err
    found = dg.read_plate_camera(tmp_path / "plate.camera.json")
    assert found.sensor.gain(400) == pytest.approx(raw().gain, rel=0.03)
    assert dg.sensors.load(tmp_path / "plate.camera.sensor.json") == found.sensor


def test_json_is_what_the_file_holds(plate, tmp_path, capsys):
    assert run(plate, "-o", tmp_path / "c.json", "--json", "-q") == 0
    told = capsys.readouterr()
    assert json.loads(told.out) == json.loads((tmp_path / "c.json").read_text())
    assert told.err == ""


def test_flags_say_what_the_photograph_does_not(tmp_path, capsys):
    raw(lensModel=None, lensMake=None, nominalFocalLength=None).develop().save(tmp_path / "x.png")
    path = tmp_path / "x.png"
    assert run(path) == 3
    assert "--focal-length" in capsys.readouterr().err
    assert run(path, "--focal-length", "50", "--shutter", "1/60", "--f-stop", "f/4", "--wb", "5000",
               "--sensor", "apsc", "--focus", "250cm", "--look", "film") == 0  # fmt: skip
    camera = dg.read_plate_camera(tmp_path / "x.camera.json").camera
    assert (camera.focal_length, camera.f_stop, camera.focus_distance) == (50, 4, 2.5)
    assert camera.shutter_time == pytest.approx(1 / 60)
    assert (camera.sensor_size, camera.white_balance) == ((23.6, 15.7), 5000)
    assert dg.read_plate_camera(tmp_path / "x.camera.json").look == "film"


@pytest.mark.parametrize(
    ("words", "code", "wanted"),
    [
        (["none.dng"], 3, "no such file"),
        (["plate.dng", "-o", "x.txt"], 2, "ending in .json"),
        (["plate.dng", "-o", "no/x.json"], 5, "no such folder"),
        (["plate.dng", "--lens", "canon-ef-85"], 3, "did you mean"),
        (["plate.dng", "--flat", "none.dng"], 3, "none.dng: no such file"),
        (["plate.dng", "--f-stop", "1.2"], 3, "wanted f/1.8 or narrower"),
        (["plate.dng", "--iso", "-5"], 2, "iso: wanted a number above 0"),
        (["plate.dng", "--look", "sepia"], 2, "look (--look): wanted one of"),
    ],
)
def test_errors_are_one_line(plate, tmp_path, monkeypatch, capsys, words, code, wanted):
    monkeypatch.chdir(tmp_path)
    assert run(*words) == code
    told = capsys.readouterr().err
    assert wanted in told
    assert told.count("\n") == 1
    assert not list(tmp_path.glob("*.json"))


def render(folder, *words):
    scene = folder / "scene.glb"
    triangle().glb(scene)
    few = () if "--spp" in words else ("--spp", "2")
    return main(["render", str(scene), *map(str, words), *few, "--sky", "20,20,20", "--quiet"])


def sky_of(frame, numbers):
    """Numbers of pixels, one in two each way, that see the sky alone."""
    seen = ndimage.minimum_filter(frame.alpha == 0, 5)
    return numbers[::2, 1::2][seen[::2, 1::2]].astype(float)


def test_objects_have_camera_noise_and_mosaic_of_the_plate(plate, tmp_path):
    assert run(plate, "-q") == 0
    like = ("--like-plate", tmp_path / "plate.camera.json")
    outputs = ("-o", tmp_path / "o.dng", "-o", tmp_path / "o.exr", "-o", tmp_path / "o.png")
    assert render(tmp_path, *like, *outputs) == 0
    made, frame = read(tmp_path / "o.dng"), dg.load_frame(tmp_path / "o.exr")
    assert made.size == (frame.width, frame.height) == (600, 400)
    np.testing.assert_array_equal(made.raw.cells, read(plate).raw.cells)
    assert made.facts["aperture"] == pytest.approx(5.6)
    assert made.facts["isoSpeed"] == 400
    assert frame.metadata["plate"]["file"] == "plate.dng"
    assert frame.metadata["filter"] == "box"


#: Few pixels of many samples: the render's own noise is far below that of photons.
CLEAN = ("--res", "96x64", "--spp", "1024")


def test_noise_of_raw_objects_is_what_the_sensor_of_the_plate_makes(plate, tmp_path):
    assert run(plate, "-q") == 0
    like = ("--like-plate", tmp_path / "plate.camera.json")
    assert render(tmp_path, *like, *CLEAN, "-o", tmp_path / "o.dng", "-o", tmp_path / "o.exr") == 0
    frame, truth = dg.load_frame(tmp_path / "o.exr"), raw()
    sky = sky_of(frame, read(tmp_path / "o.dng").raw.mosaic)
    electrons = (sky.mean() - truth.black_level) / truth.gain
    assert sky.size > 500
    assert electrons > 100
    wanted = electrons + truth.sensor.read_noise_at(400) ** 2 + (0.004 * electrons) ** 2
    assert sky.var() == pytest.approx(truth.gain**2 * wanted, rel=0.15)


def test_given_flags_win(plate, tmp_path):
    assert run(plate, "-q") == 0
    words = ("--like-plate", tmp_path / "plate.camera.json", "-o", tmp_path / "o.exr")
    given = ("--lens", "thin", "--res", "60x40", "--t-stop", "4", "--focus", "2")
    given += ("--filter", "gaussian")
    assert render(tmp_path, *words, *given) == 0
    facts = dg.load_frame(tmp_path / "o.exr").metadata
    assert facts["resolution"] == (60, 40)
    assert facts["camera"]["focal_length_mm"] == pytest.approx(85)
    assert facts["focus"] == pytest.approx(2)
    assert facts["aperture"] == pytest.approx(4)
    assert facts["filter"].startswith("gaussian")


def test_a_camera_file_is_manual_unless_a_flag_names_another_mode(plate, tmp_path):
    assert run(plate, "-q") == 0
    words = ("--like-plate", tmp_path / "plate.camera.json", "-o", tmp_path / "o.exr")
    for given, mode in (
        ((), "manual"),
        (("--exposure", "light"), "light"),
        (("--ev", "1"), "manual"),
    ):
        assert render(tmp_path, *words, "--res", "6x4", *given) == 0
        facts = dg.load_frame(tmp_path / "o.exr").metadata
        assert (facts["exposure"], facts["isoSpeed"]) == (mode, 400)
        assert facts.get("exposure_compensation", 0) == ("--ev" in given)


def test_developed_plates_give_their_grain(tmp_path):
    raw().save(tmp_path / "plate.jpg")
    assert run(tmp_path / "plate.jpg", "-q") == 0
    like = ("--like-plate", tmp_path / "plate.camera.json")
    assert render(tmp_path, *like, *CLEAN, "-o", tmp_path / "o.png", "-o", tmp_path / "o.exr") == 0
    frame = dg.load_frame(tmp_path / "o.exr")
    sky = sky_of(frame, read(tmp_path / "o.png").pixels[..., 1])
    grain = dg.read_plate_camera(tmp_path / "plate.camera.json").noise
    level = np.array([sky.mean() / 255], np.float32)
    assert sky.std() == pytest.approx(255 * float(grain.deviation(1, level)[0]), rel=0.15)


@pytest.mark.parametrize(
    ("words", "wanted"),
    [
        (["--like-plate", "none.json", "-o", "o.exr"], "none.json: no such file"),
        (
            ["--like-plate", "plate.camera.json", "-o", "o.jpg", "--exposure", "auto"],
            "--exposure auto and --like-plate: wanted one of them, got both; the plate sets the "
            "ISO",
        ),
        (
            ["--like-plate", "plate.camera.json", "-o", "o.exr", "--exposure", "S"],
            "the plate sets the f-stop",
        ),
        (
            ["--like-plate", "plate.camera.json", "-o", "o.exr", "--background", "plate"],
            "wanted the exposure mode light, as a plate is exposed already, got manual; use "
            "--background transparent, then `daguerre composite`",
        ),
    ],
)
def test_what_like_plate_refuses(plate, tmp_path, monkeypatch, capsys, words, wanted):
    monkeypatch.chdir(tmp_path)
    assert run(plate, "-q") == 0
    assert render(tmp_path, *words) in (2, 3)
    assert wanted in capsys.readouterr().err
