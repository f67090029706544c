"""Vignetting of brightness and saturation, lateral colour: formulas, lenses, and the way back."""

from __future__ import annotations

import math

import numpy as np
import pytest

import daguerre as dg
from daguerre import lenses
from daguerre.analysis.bench import set_up
from daguerre.analysis.chief import chief_rays
from daguerre.analysis.illumination import relative_illumination
from daguerre.errors import UsageError
from daguerre.post.effects.catalogue import EFFECTS
from daguerre.post.effects.distortion import CHANNEL_NM
from tests.post.test_post import planes, post, read, write
from tests.post.test_warp import soft


def radius(height: int, width: int) -> np.ndarray:
    """Radius of pixels, 1 in the corners."""
    y, x = np.mgrid[:height, :width] + 0.5
    return np.hypot(x - width / 2, y - height / 2) / math.hypot(width / 2, height / 2)


def colors(height: int = 60, width: int = 90) -> np.ndarray:
    return np.random.default_rng(5).exponential(1, (height, width, 4)).astype(np.float32)


def test_natural_vignetting_is_cos4():
    image = colors()
    dark = dg.post.vignette(image, focal_length=24, sensor=(36, 24))
    angle = np.arctan(radius(60, 90) * math.hypot(18, 12) / 24)
    assert dark[:, :, :3] == pytest.approx(image[:, :, :3] * np.cos(angle)[:, :, None] ** 4)
    assert np.array_equal(dark[:, :, 3], image[:, :, 3])  # alpha
    assert dg.post.unvignette(dark, focal_length=24, sensor=(36, 24)) == pytest.approx(image)


def test_polynomial_vignetting():
    numbers = {"model": "polynomial", "k1": -0.6, "k2": 0.2, "k3": -0.1}
    dark = dg.post.vignette(np.ones((60, 90, 3), np.float32), **numbers)
    r = radius(60, 90)
    assert dark[:, :, 1] == pytest.approx(1 - 0.6 * r**2 + 0.2 * r**4 - 0.1 * r**6, abs=1e-6)
    assert dg.post.unvignette(dark, **numbers) == pytest.approx(np.ones((60, 90, 3)), rel=1e-6)


def test_light_of_a_lens():
    setting = {"f_stop": 2.0, "focus": 2.0}
    grey = np.ones((20, 601, 1), np.float32)
    dark = dg.post.vignette(
        grey, model="lens", lens="double-gauss-50mm-f2", sensor=(40, 1.3311148), **setting
    )
    bench = set_up(lenses.load("double-gauss-50mm-f2"), f_stop=2.0, focus_m=2.0, by="paraxial")
    heights = np.array([0.0, 6.0, 12.0, 18.0])
    wanted = relative_illumination(bench, heights).relative
    at = 300.5 + heights / 40 * 601
    found = np.interp(at, np.arange(601) + 0.5, dark[10, :, 0])
    assert wanted[-1] < 0.6
    assert found == pytest.approx(wanted, abs=0.01)


def test_where_no_light_is_left_nothing_comes_back(tmp_path, capsys):
    source = write(tmp_path / "in.exr", planes())
    word = "vignetting:model=polynomial,k1=-2,inverse=1"
    assert dg.cli.main(["post", str(source), "-o", str(source), "--effect", word]) == 0
    assert "pixels that get no light are set to 0" in capsys.readouterr().err
    found = read(source)[0]["R"]
    assert found[0, 0] == 0
    assert np.isfinite(found).all()


def test_saturation_fades_and_luminance_stays():
    image = colors()
    pale = dg.post.vignette_saturation(image, k1=-0.8)
    weights = [0.2126, 0.7152, 0.0722]
    assert pale[:, :, :3] @ weights == pytest.approx(image[:, :, :3] @ weights, rel=1e-5)
    chroma = pale[:, :, 0] - pale[:, :, 2], image[:, :, 0] - image[:, :, 2]
    assert chroma[0] == pytest.approx(chroma[1] * (1 - 0.8 * radius(60, 90) ** 2), abs=1e-5)
    assert dg.post.unvignette_saturation(pale, k1=-0.8) == pytest.approx(image, rel=1e-4, abs=1e-5)
    assert np.array_equal(dg.post.vignette_saturation(image[:, :, :1]), image[:, :, :1])


def test_lateral_colour_by_numbers():
    ramp = np.repeat(np.arange(600, dtype=np.float32)[None], 400, 0) + 0.5
    image = np.stack([ramp] * 3, axis=2)
    fringed = dg.post.lateral_colour(image, red=0.5, red_corner=0.2, blue=-0.3)
    assert np.array_equal(fringed[:, :, 1], ramp)
    x = np.array([350.5, 420.5, 500.5])
    shown = fringed[200, x.astype(int)]
    unit = math.hypot(300, 200)
    source = shown - 300
    red = source[:, 0] * (1.005 + 0.002 * (np.hypot(source[:, 0], 0.5) / unit) ** 2)
    assert red == pytest.approx(x - 300, abs=2e-3)
    assert source[:, 2] * 0.997 == pytest.approx(x - 300, abs=2e-3)


@pytest.mark.parametrize(
    "values",
    [
        {"red": 0.4, "blue": -0.3, "blue_corner": 0.2},
        {"model": "lens", "lens": "canon-ef-11-24mm-f4", "sensor": (36, 24)},
    ],
)
def test_lateral_colour_goes_away_again(values):
    image = soft(300, 200)
    fringed = dg.post.lateral_colour(image, **values)
    moved = np.abs(fringed - image).max()
    assert moved > 1e-3
    back = dg.post.remove_lateral_colour(fringed, **values)
    assert np.abs(back - image)[8:-8, 8:-8].max() < 0.1 * moved


def test_lateral_colour_of_a_lens():
    ramp = np.repeat(np.arange(600, dtype=np.float32)[None], 400, 0) + 0.5
    fringed = dg.post.lateral_colour(
        np.stack([ramp] * 3, axis=2), model="lens", lens="canon-ef-11-24mm-f4", sensor=(36, 24)
    )
    bench = set_up(lenses.load("canon-ef-11-24mm-f4"), by="paraxial")
    height = math.hypot(250.5, 0.5) * 0.06  # of pixel (550, 200)
    angle = chief_rays(bench, [height], CHANNEL_NM[0]).angles[0]
    heights = height + np.linspace(-0.2, 0.2, 41)
    green = chief_rays(bench, heights, CHANNEL_NM[1]).angles
    wanted = np.interp(angle, green, heights) / height * 250.5  # where green shows the same
    assert abs(wanted - 250.5) > 0.05
    assert fringed[200, 550, 0] - 300 == pytest.approx(wanted, abs=2e-3)


def test_grey_has_no_lateral_colour():
    with pytest.raises(UsageError, match="wanted R, G and B, got grey"):
        dg.post.lateral_colour(np.ones((3, 3, 1), np.float32), red=1)


@pytest.mark.parametrize("name", ["lateral-colour:red=1", "saturation-vignetting"])
def test_on_the_command_line(tmp_path, name):
    source = write(tmp_path / "in.exr", planes())
    assert post(source, "-o", tmp_path / "out.exr", "--effect", name) == 0
    found = read(tmp_path / "out.exr")[0]
    assert not np.array_equal(found["R"], planes()["R"])
    assert name.split(":")[0] in EFFECTS
