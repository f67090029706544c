"""Edges of photographs, the blur that they tell, and pixels that get it."""

from pathlib import Path

import numpy as np
import pytest

from daguerre.plates.files import read
from daguerre.plates.match import blur, sharpness
from daguerre.plates.match.blur import Blur, gaussian
from daguerre.plates.match.sharpness import FREQUENCIES, sharpness_of
from daguerre.plates.photograph import Photograph
from tests.support.pictures.plate_edges import squares
from tests.support.pictures.plate_frames import of_light

SHAPE = (600, 900)
#: Frequencies that count: above, little is left of edges.
SEEN = FREQUENCIES <= 0.4


def shot(tmp_path, ending, sigma, iso, name="sony-a7r-ii", **how):
    raw = of_light(squares(SHAPE, sigma), 0.5 * 78 / iso).expose(name, iso, seed=1)
    path = tmp_path / f"x.{ending}"
    raw.save(path, **({} if ending == "dng" else {"look": "neutral"} | how))
    return sharpness_of(read(path))


@pytest.mark.parametrize("sigma", [0.3, 0.6, 1.0, 1.6])
@pytest.mark.parametrize(("iso", "error"), [(100, 0.02), (1600, 0.05)])
def test_edges_of_a_mosaic_tell_the_blur(tmp_path, sigma, iso, error):
    found = shot(tmp_path, "dng", sigma, iso)
    truth = np.sinc(FREQUENCIES) * gaussian(sigma, FREQUENCIES)
    np.testing.assert_allclose(found.response[SEEN], truth[SEEN], atol=error)
    assert found.blur.sigma == pytest.approx(sigma, abs=0.05)
    assert found.edges >= 20
    # The planted fault: without the pixel's own area the blur is another.
    bare = blur.fitted(FREQUENCIES, found.response, np.ones_like(FREQUENCIES))
    assert bare.sigma > found.blur.sigma + 0.015


def test_other_mosaics(tmp_path):
    for name in ("ideal-mono", "fujifilm-x-t4"):
        found = shot(tmp_path, "dng", 0.8, 400, name)
        assert found.blur.sigma == pytest.approx(0.8, abs=0.08), name


@pytest.mark.parametrize("sharpen", [0.0, 1.0])
def test_sharpening_of_development_is_found(tmp_path, sharpen):
    found = shot(tmp_path, "png", 0.7, 100, sharpen=sharpen)
    assert found.blur.sharpen == pytest.approx(sharpen, abs=0.12)
    assert found.blur.sigma == pytest.approx(0.7, abs=0.06)


@pytest.mark.parametrize("wanted", [Blur(0.5), Blur(1.0), Blur(0.8, 1.0)])
def test_pixels_with_that_blur_have_its_edges(wanted):
    sharp = squares(SHAPE, 0.0)[:, :, None].astype(np.float32).repeat(3, axis=2)
    made = wanted.applied(sharp)
    found = sharpness_of(Photograph(Path("x.exr"), "linear", made, None, {}))
    truth = np.sinc(FREQUENCIES) * wanted.response(FREQUENCIES)
    at = FREQUENCIES <= 0.35
    np.testing.assert_allclose(found.response[at], truth[at], atol=0.05)
    assert made.mean() == pytest.approx(sharp.mean(), rel=1e-3)


def test_blur_keeps_lamps_without_dark_rims():
    lamp = np.zeros((31, 31, 1), np.float32)
    lamp[15, 15] = 1e5
    for sigma in (0.1, 0.3, 0.6, 2.0):
        spread = Blur(sigma).applied(lamp)
        assert spread.min() >= 0
        assert spread.sum() == pytest.approx(1e5, rel=1e-4)
    assert Blur(0.6, 2.0).applied(lamp).min() >= 0
    assert Blur().applied(lamp) is lamp


def test_blur_scales_with_the_picture():
    step = np.zeros((9, 200, 1), np.float32)
    step[:, 100:] = 1
    wide = np.diff(Blur(1.0).applied(step, 2.0)[4, :, 0])
    at = np.arange(199) + 0.5
    width = np.sqrt((wide * (at - (wide * at).sum()) ** 2).sum())
    assert width == pytest.approx(2.0, rel=0.02)


def test_edges_that_are_out_of_focus_do_not_count():
    halves = [squares(SHAPE, 0.6), squares(SHAPE, 3.0)]
    light = np.concatenate(halves)[:, :, None].astype(np.float32).repeat(3, axis=2)
    found = sharpness_of(Photograph(Path("x.exr"), "linear", light, None, {}))
    assert found.blur.sigma == pytest.approx(0.6, abs=0.06)


@pytest.mark.parametrize(
    "light",
    [
        np.full(SHAPE, 0.5),
        np.random.default_rng(0).random(SHAPE),
        squares(SHAPE, 0.5, turn=0.0),
        squares(SHAPE, 0.5)[:20, :20],
    ],
)
def test_pictures_without_good_edges(light):
    pixels = light[:, :, None].astype(np.float32).repeat(3, axis=2)
    assert sharpness_of(Photograph(Path("x.exr"), "linear", pixels, None, {})) is None
    assert sharpness.LEAST == 3
