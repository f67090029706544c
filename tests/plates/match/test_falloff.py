"""Vignetting of photographs of even surfaces."""

from pathlib import Path

import numpy as np
import pytest

from daguerre import lenses
from daguerre.analysis.bench import set_up
from daguerre.analysis.illumination import relative_illumination
from daguerre.errors import InputError
from daguerre.plates.files import read
from daguerre.plates.match.falloff import falloff_of, polynomial, radii_squared
from daguerre.plates.match.lens_model import lens_falloff
from daguerre.plates.photograph import Photograph
from daguerre.post import vignette
from tests.support.pictures.plate_frames import of_light

SHAPE = (600, 900)
TERMS = (-0.6, 0.25, -0.1)


@pytest.mark.parametrize("ending", ["dng", "png", "exr"])
def test_known_falloff_comes_back(tmp_path, ending):
    light = polynomial(TERMS, radii_squared(*SHAPE))
    frame = of_light(light, 0.25)
    path = tmp_path / f"flat.{ending}"
    if ending == "exr":
        frame.save(path)
    elif ending == "dng":
        frame.expose("sony-a7r-ii", 200, seed=1).save(path)
    else:
        frame.expose("sony-a7r-ii", 200, seed=1).develop(ev=-0.5).save(path)
    found = falloff_of(read(path))
    made = polynomial(found.terms, radii_squared(*SHAPE))
    np.testing.assert_allclose(made, light, rtol=0.004)
    assert found.corner_ev == pytest.approx(np.log2(1 + sum(TERMS)), abs=0.01)


def test_it_is_the_polynomial_of_the_darkroom():
    k1, k2, k3 = TERMS
    white = np.ones((*SHAPE, 3), np.float32)
    made = vignette(white, model="polynomial", k1=k1, k2=k2, k3=k3)[..., 0]
    np.testing.assert_allclose(polynomial(TERMS, radii_squared(*SHAPE)), made, atol=1e-5)


def linear(light):
    pixels = light[:, :, None].astype(np.float32).repeat(3, axis=2)
    return Photograph(Path("flat.exr"), "linear", pixels, None, {})


def test_light_from_one_side_is_left_out():
    x = np.linspace(-1, 1, SHAPE[1])
    light = polynomial(TERMS, radii_squared(*SHAPE)) + 0.1 * x
    np.testing.assert_allclose(falloff_of(linear(light)).terms, TERMS, atol=0.01)


@pytest.mark.parametrize(
    ("light", "wanted"),
    [
        (np.random.default_rng(0).random((48, 72)), "even surface"),
        (np.zeros((48, 72)), "light everywhere"),
    ],
)
def test_surfaces_that_are_not_even(light, wanted):
    with pytest.raises(InputError, match=wanted):
        falloff_of(linear(np.kron(light, np.ones((8, 8)))))


def test_clipped_flats(tmp_path):
    of_light(np.full(SHAPE, 1.0), 5.0).expose("sony-a7r-ii", 400).save(tmp_path / "x.dng")
    with pytest.raises(InputError, match="clipped"):
        falloff_of(read(tmp_path / "x.dng"))


def test_falloff_of_a_lens():
    """Three terms follow mounts that cut the pupil within 2 % of the light on the axis."""
    bench = set_up(lenses.load("double-gauss-50mm-f2"), f_stop=2.8)
    terms = lens_falloff(bench, (36, 24))
    heights = np.array([0, 8, 14, 20.0])
    wanted = relative_illumination(bench, heights).relative
    r2 = (heights / np.hypot(18, 12)) ** 2
    np.testing.assert_allclose(polynomial(terms, r2), wanted, atol=0.025)
