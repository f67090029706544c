"""``daguerre light-probe``: files, facts and messages."""

from __future__ import annotations

import json
import math

import numpy as np
import OpenEXR
import pytest

from daguerre.cli import main
from daguerre.pictures.light import read_environment
from tests.support.pictures.light_probes import ball_picture, exposure, grid, mirror, save, world

SKY = np.array([0.3, 0.7, -0.4]) / np.linalg.norm([0.3, 0.7, -0.4])


@pytest.fixture
def pano(tmp_path):
    """A panorama with a sun, and EXIF that nothing needs."""
    d = grid(256, 128)
    disc = (d @ SKY > math.cos(math.radians(1.5)))[..., None]
    return save(tmp_path / "pano.exr", (1 + 900 * disc * np.ones(3)).astype(np.float32))


def run(capfd, *arguments):
    code = main(["light-probe", *map(str, arguments)])
    out, err = capfd.readouterr()
    return code, out, err


def test_what_is_said_and_written(tmp_path, capfd, pano):
    code, out, err = run(capfd, pano, "-o", tmp_path / "env.exr")
    assert code == 0
    assert "sun                  azimuth 36.8" in out
    assert "elevation 54." in out
    assert "clipped" in err  # an even disc may be a ceiling
    assert f"wrote {tmp_path / 'env.exr'}" in err
    image = read_environment(tmp_path / "env.exr")
    assert np.array_equal(image, read_environment(pano))
    with OpenEXR.File(str(tmp_path / "env.exr")) as file:
        kept = json.loads(file.header()["daguerre:light_probe"])
    assert kept["sun"]["elevation_deg"] == pytest.approx(54.5, abs=0.3)


def test_json_and_hdr_and_a_sun_of_its_own(tmp_path, capfd, pano):
    files = ("-o", tmp_path / "env.hdr", "--sun-out", tmp_path / "sun.glb")
    code, out, err = run(capfd, pano, *files, "--json", "-q")
    assert (code, err) == (0, "")
    facts = json.loads(out)
    assert facts["sun"]["share"] > 0.1
    assert read_environment(tmp_path / "env.hdr").max() == pytest.approx(1, rel=0.01)
    assert (tmp_path / "sun.glb").stat().st_size > 100


def test_flags_reach_the_ball(tmp_path, capfd):
    path = save(tmp_path / "ball.exr", ball_picture(mirror(world)))
    fov = math.degrees(2 * math.atan(240 / 600))
    code, out, _ = run(
        capfd, path, "-o", tmp_path / "env.exr", "--ball", "mirror", "--fov", fov,
        "--circle", "258.8,192.5,122.7", "--reflectance", "0.5", "--ball-direction", "30deg",
        "--pitch", 0, "--res", 64, "--sun", "off",
    )  # fmt: skip
    assert code == 0
    assert "ball, yaw 30         middle 258.8,192.5 px, radius 122.7 px\n" in out
    assert "hidden by the ball" in out
    image = read_environment(tmp_path / "env.exr")
    assert image.shape == (32, 64, 3)
    assert image.mean() == pytest.approx(4, rel=0.1)


@pytest.mark.parametrize(
    ("arguments", "code", "said"),
    [
        (["none.exr"], 3, "none.exr: no such file"),
        (["none.jpg"], 3, "none.jpg: no such file"),
        (["none.cr2"], 3, "none.cr2: no such file"),
        (["square.exr"], 3, "panorama: wanted a width of twice the height, got 64x64 px"),
        (["nan.exr"], 3, "nan.exr: pixel (5, 3): wanted finite light"),
        (["cut.jpg"], 3, "cut.jpg: cannot be decoded: JPEG error"),
        (["text.jpg"], 3, "text.jpg: cannot be decoded"),
        (["pano.exr", "--ball", "chrome"], 2, "ball (--ball): wanted mirror or grey, got 'chrome'"),
        (["pano.exr", "--ev", "1,2"], 2, "--ev: wanted 1, one for each photograph, got 2"),
        (["pano.exr", "--circle", "1,2,3"], 2, "--circle needs --ball mirror or --ball grey"),
        (["pano.exr", "--grey-circle", "9,9,9"], 2, "--grey-circle needs --grey"),
        (["pano.exr", "--ball", "mirror", "--circle", "1,2"], 2, "--circle: wanted"),
        (["pano.exr", "--ball", "mirror", "--circle", "999,2,30"], 3, "wanted a circle within"),
        (["pano.exr", "--ball", "mirror", "--fov", "200"], 2, "--fov: wanted an angle"),
        (
            ["pano.exr", "--ball", "mirror", "--reflectance", "1.5"],
            2,
            "reflectance (--reflectance): wanted one or",
        ),
        (
            ["pano.exr", "--ball", "mirror", "--ball-direction", "0,90"],
            2,
            "--ball-direction: wanted",
        ),
        (["pano.exr", "--res", "1"], 2, "res (--res): wanted 16 to 32768, got 1"),
        (
            ["pano.exr", "--illuminance", "-1"],
            2,
            "illuminance (--illuminance): wanted a number above 0",
        ),
        (["pano.exr", "--sun-out", "sun.gltf"], 2, "wanted a name ending in .glb"),
        (["pano.exr", "-o", "env.png"], 2, "wanted a name ending in .exr or .hdr"),
        (["pano.exr", "-o", "pano.exr"], 2, "pano.exr: cannot write: this command reads this file"),
        (["pano.exr", "-o", "no/env.exr"], 5, "cannot write: no such folder"),
        (["dark.exr", "--sun-out", "sun.glb"], 3, "no sun was found in the photographs"),
    ],
)
def test_bad_input(tmp_path, capfd, monkeypatch, pano, arguments, code, said):
    monkeypatch.chdir(tmp_path)
    ones = np.ones((64, 128, 3), np.float32)
    save(tmp_path / "square.exr", ones[:, :64])
    save(tmp_path / "dark.exr", ones)
    broken = ones.copy()
    broken[3, 5] = np.nan
    save(tmp_path / "nan.exr", broken)
    whole = save(tmp_path / "cut.jpg", np.full((64, 128, 3), 99, np.uint8), exposure(1))
    whole.write_bytes(whole.read_bytes()[:600])
    (tmp_path / "text.jpg").write_text("no picture")
    before = {path.name for path in tmp_path.iterdir()}
    if "-o" not in arguments:
        arguments = [*arguments, "-o", "env.exr"]
    got, _, err = run(capfd, *arguments)
    assert (got, err.count("\n")) == (code, 1)
    assert said in err
    assert {path.name for path in tmp_path.iterdir()} - before <= {"env.exr"}
