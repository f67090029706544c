"""Noise of developed pictures: measured, drawn again, and compared."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy import stats

from daguerre.plates.files import read
from daguerre.plates.match.grain import FOLDED, HALF, Grain
from daguerre.plates.match.grain_draw import with_grain
from daguerre.plates.match.grain_measure import grain_of
from daguerre.plates.photograph import Photograph, encoded
from tests.support.pictures.plate_edges import squares
from tests.support.pictures.plate_frames import of_light

ROWS, COLUMNS, PATCH = 3, 5, 192
#: Patches over six stops; the darkest are some hundredths of white.
LIGHT = np.kron(2.0 ** (-6 * np.arange(15).reshape(ROWS, COLUMNS) / 15), np.ones((PATCH, PATCH)))


def patches(pixels):
    """Patches without their borders, at pixels that are far apart: 7 is prime to the mosaic's 2."""
    return [
        pixels[y * PATCH + 8 : (y + 1) * PATCH - 8 : 7, x * PATCH + 8 : (x + 1) * PATCH - 8 : 7]
        for y in range(ROWS)
        for x in range(COLUMNS)
    ]


def clean(pixels):
    """Each patch's mean, everywhere in it."""
    blocks = pixels.reshape(ROWS, PATCH, COLUMNS, PATCH, 3).mean(axis=(1, 3))
    return np.asarray(np.kron(blocks, np.ones((PATCH, PATCH, 1))), np.float32)


def correlation(noise, step):
    """Mean over the patches, each relative to its variance."""
    rest = noise - np.kron(
        noise.reshape(ROWS, PATCH, COLUMNS, PATCH).mean(axis=(1, 3)), np.ones((PATCH, PATCH))
    )
    rest = rest.reshape(ROWS, PATCH, COLUMNS, PATCH)
    products = (rest[..., :-step] * rest[..., step:]).mean(axis=(1, 3))
    return float((products / (rest**2).mean(axis=(1, 3))).mean())


@pytest.fixture(scope="module", params=[("jpg", 1600, {}), ("png", 6400, {"sharpen": 0.5})])
def developed(request, tmp_path_factory):
    """A developed shot of the patches, its grain, and the same noise drawn on clean patches."""
    ending, iso, how = request.param
    path = tmp_path_factory.mktemp("grain") / f"x.{ending}"
    raw = of_light(LIGHT, 0.4 * 78 / iso).expose("sony-a7r-ii", iso, seed=1)
    raw.develop(look="standard", **how).save(path)
    plate = read(path)
    pixels = encoded(plate.pixels)
    grain = grain_of(plate)
    made = np.rint(np.clip(with_grain(clean(pixels), grain, seed=5), 0, 1) * 255)
    return np.rint(pixels * 255), made, grain


def test_object_and_plate_pass_kolmogorov_smirnov(developed):
    """45 tests at 1 %: more than 4 failures have a chance of 1 in 1000."""
    plate, made, _ = developed
    values = []
    for one, other in zip(patches(plate), patches(made), strict=True):
        for c in range(3):
            a, b = one[..., c].ravel(), other[..., c].ravel()
            values.append(stats.ks_2samp(a, b).pvalue)
            assert b.std() == pytest.approx(a.std(), rel=0.2)
    values = np.array(values)
    assert (values < 0.01).sum() <= 4
    assert np.median(values) > 0.15


def test_grain_is_as_coarse(developed):
    plate, made, _ = developed
    for c in range(3):
        for step in (1, 2, 4):
            a, b = (correlation(p[..., c], step) for p in (plate, made))
            assert b == pytest.approx(a, abs=0.06)


def test_planted_faults_are_seen(developed):
    """Noise that is a third too strong, or white, fails the tests above."""
    plate, _, grain = developed
    pixels = clean(plate / 255)
    strong = replace(grain, deviations=1.33 * grain.deviations)
    loud = np.rint(np.clip(with_grain(pixels, strong, 5), 0, 1) * 255)
    values = [
        stats.ks_2samp(a[..., 1].ravel(), b[..., 1].ravel()).pvalue
        for a, b in zip(patches(plate), patches(loud), strict=True)
    ]
    assert (np.array(values) < 0.01).sum() > 4
    white = replace(grain, spectra=np.broadcast_to(np.eye(3), grain.spectra.shape))
    flat = with_grain(pixels, white, 5)
    assert abs(correlation(flat[..., 1], 1)) < 0.05


def known_grain(size=1.0, linear=True):
    """Grain of linear light whose deviation is a tenth of the root of the light."""
    levels = np.tile(np.geomspace(0.01, 1, 9), (3, 1))
    f = FOLDED[:HALF] / 32
    power = np.exp(-((2 * np.pi * size) ** 2) * (f[:, None] ** 2 + f**2))
    whole = power[np.ix_(FOLDED, FOLDED)]
    mixing = np.array([[1, 0.5, 0.2], [0.5, 1, 0.5], [0.2, 0.5, 1]])
    spectra = (power / whole.mean())[:, :, None, None] * mixing
    return Grain(linear, levels, 0.1 * np.sqrt(levels), spectra)


def test_known_noise_comes_back():
    """Level, spectrum and correlation of channels, on a gradient, of linear light."""
    given = known_grain(0.6)
    light = np.geomspace(0.02, 0.9, 1536)[None, :, None] * np.ones((768, 1, 3))
    pixels = with_grain(light.astype(np.float32), given, 3)
    found = grain_of(Photograph(Path("x.exr"), "linear", pixels, None, {}))
    for c in range(3):
        wanted = 0.1 * np.sqrt(found.levels[c])
        np.testing.assert_allclose(found.deviations[c], wanted, rtol=0.06)
    assert found.size == pytest.approx(given.size, rel=0.1)
    low = (slice(0, 6), slice(0, 6))
    np.testing.assert_allclose(found.spectra[low], given.spectra[low], rtol=0.2, atol=0.3)


def test_noise_depends_on_place_and_seed_alone():
    given = known_grain()
    light = np.full((120, 160, 3), 0.3, np.float32)
    whole = with_grain(light, given, 7)
    part = with_grain(light[30:90, 40:120], given, 7, (40, 30))
    np.testing.assert_allclose(part, whole[30:90, 40:120], atol=2e-6)
    assert np.abs(with_grain(light, given, 8) - whole).max() > 0.01


def test_beyond_what_is_known():
    given = known_grain()
    found = given.deviation(0, np.array([0.0, 0.01, 1.0, 4.0], np.float32))
    np.testing.assert_allclose(found, [0.01, 0.01, 0.1, 0.2], rtol=1e-5)
    shown = replace(given, linear=False).deviation(0, np.array([4.0], np.float32))
    assert shown[0] == pytest.approx(0.1)


@pytest.mark.parametrize(
    "pixels",
    [
        np.full((512, 512, 3), 255, np.uint8),
        np.zeros((512, 512, 3), np.uint8),
        np.full((40, 40, 3), 99, np.uint8),
    ],
)
def test_nothing_flat(pixels):
    assert grain_of(Photograph(Path("x.png"), "display", pixels, None, {})) is None


def test_a_picture_without_noise_has_none():
    pixels = np.full((256, 256, 3), 99, np.uint8)
    found = grain_of(Photograph(Path("x.png"), "display", pixels, None, {}))
    assert found.deviations.max() == 0
    light = np.full((20, 20, 3), 0.4, np.float32)
    np.testing.assert_array_equal(with_grain(light, found, 1), light)


@pytest.mark.parametrize("sigma", [0.0, 0.8])
def test_edges_are_no_noise(sigma):
    """Levels that only edges have, between those of the squares, tell nothing."""
    light = squares((600, 900), sigma)[..., None] + 0.01 * np.random.default_rng(0).standard_normal(
        (600, 900, 3)
    )
    found = grain_of(Photograph(Path("x.exr"), "linear", light.astype(np.float32), None, {}))
    np.testing.assert_allclose(found.deviations, 0.01, rtol=0.15)
