"""Diffraction: Parseval, Airy, sinc^2, stars of blades, colour, and the PSF of the bench."""

from __future__ import annotations

import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import daguerre as dg
from daguerre import analysis, lenses
from daguerre.analysis import diffraction
from daguerre.analysis.diffraction import PlainPupil, far_field, window_of
from daguerre.analysis.iris import Iris
from daguerre.analysis.lens_pupil import lens_pupil, zone_pupils
from daguerre.analysis.psf import psf_of
from daguerre.color import spectra as colour
from daguerre.errors import UsageError
from daguerre.post.starburst import starburst

NM = 550.0


def blades(count: int, rotation: float = 0, curvature: float = 0) -> Iris:
    return Iris(count, rotation, curvature)


@pytest.mark.parametrize(
    "iris",
    [
        Iris(),
        blades(7, 11, 0.4),
        blades(5, 3, -0.5),
        Iris(mask=np.random.default_rng(3).random((64, 64), np.float32)),
    ],
)
def test_the_light_of_a_period_is_that_of_the_pupil(iris: Iris) -> None:
    """Parseval: all points of a whole period have all of the light, to 1e-6."""
    pupil = PlainPupil(8, iris)
    span = pupil.high[0] - pupil.low[0]
    step, length = diffraction._raster(span, 300 * 0.002 / (1e-6 * NM), 2.0)
    length += 1 - length % 2  # odd: every point once
    axis = ((np.arange(math.ceil(span / step) + 3)) * step + pupil.low[0] - step).astype(np.float32)
    waves = pupil.amplitude(axis, axis, NM)
    half = (length - 1) // 2
    with ThreadPoolExecutor(2) as pool:
        for real in (True, False):  # perfect waves have half of the plane
            lines, _ = diffraction._along(waves if real else waves + 0j, length, half)
            light = diffraction._intensity([lines], length, half, pool).astype(np.float64)
            right = light[:, diffraction.TAPS :]
            found = right[:, 0].sum() + 2 * right[:, 1:].sum() if real else light.sum()
            assert found == pytest.approx((waves.astype(float) ** 2).sum(), rel=1e-6)
    # And a window that holds almost all of it has almost all.
    assert far_field(pupil, NM, 0.002, 511).sum() == pytest.approx(1, abs=0.03)


@dataclass(frozen=True)
class Slanted(PlainPupil):
    """A wave that converges beside the middle, at ``shift`` (mm, to the right and up)."""

    shift: tuple[float, float] = (0.0, 0.0)

    @property
    def perfect(self) -> bool:
        return False

    def amplitude(self, x: Any, y: Any, wavelength_nm: float) -> NDArray[Any]:
        turns = (x[None, :] * self.shift[0] + y[:, None] * self.shift[1]) / (1e-6 * wavelength_nm)
        return super().amplitude(x, y, wavelength_nm) * np.exp(-2j * np.pi * turns)


@pytest.mark.parametrize("shift", [(7, 0), (0, 7), (12, -4), (-9, -15)])
@pytest.mark.parametrize("nm", [450.0, 650.0])
def test_a_slanted_wave_lands_where_it_points(shift: tuple[int, int], nm: float) -> None:
    """Right is right, up is up, and a pixel is a pixel, at every wavelength."""
    pitch, size = 0.003, 61
    pupil = Slanted(8, blades(5, 7), (shift[0] * pitch, shift[1] * pitch))
    found = far_field(pupil, nm, pitch, size)
    row, column = np.unravel_index(found.argmax(), found.shape)
    assert (column - size // 2, size // 2 - row) == shift
    # All of the picture is moved: an odd number of blades has another picture upside down.
    still = far_field(PlainPupil(8, blades(5, 7)), nm, pitch, size)
    moved = np.roll(still, (-shift[1], shift[0]), (0, 1))
    np.testing.assert_allclose(found[20:41, 20:41], moved[20:41, 20:41], atol=2e-3 * still.max())


def test_an_iris_open_to_one_side_has_fringes_across_its_slits() -> None:
    """Two holes side by side, right of the middle: Young's fringes, lambda / distance apart."""
    holes = np.zeros((64, 64), np.float32)
    holes[30:34, 36:40] = holes[30:34, 56:60] = 1
    pitch, size, f_number = 0.001, 161, 16.0
    pupil = PlainPupil(f_number, Iris(mask=holes, mask_half=1.0))
    found = far_field(pupil, NM, pitch, size)
    apart = 20 / 32 / (2 * f_number)  # of the holes, in direction cosines
    x = (np.arange(size) - size // 2) * pitch
    row = found[size // 2]
    envelope = np.sinc(x * (4 / 32 / (2 * f_number)) / (1e-6 * NM)) ** 2
    wanted = envelope * np.cos(np.pi * x * apart / (1e-6 * NM)) ** 2
    assert np.corrcoef(row, wanted)[0, 1] > 0.99
    column = found[:, size // 2]
    assert column.min() > 0.2 * column.max() * envelope.min()  # and none across them


@pytest.mark.parametrize("f_number", [4.0, 16.0])
def test_the_airy_disc(f_number: float) -> None:
    """First zero at 1.22 lambda N, 83.8 % of the light within it (Born and Wolf, section 8.5)."""
    airy = 1.2197e-6 * NM * f_number
    pitch, size = airy / 40, 241
    spread = far_field(PlainPupil(f_number), NM, pitch, size)
    r = np.hypot(*np.mgrid[-120:121, -120:121]) * pitch
    assert spread.argmax() == size * size // 2
    ring = [spread[np.abs(r - q * airy) < 0.6 * pitch].mean() for q in np.arange(0.9, 1.1, 0.01)]
    assert 0.9 + 0.01 * np.argmin(ring) == pytest.approx(1, abs=0.015)
    assert spread[r < airy].sum() == pytest.approx(0.838, abs=0.004)
    # The kernel has unit area: P / (lambda N)^2 pi / 4 in the middle.
    peak = math.pi / 4 * (pitch / (1e-6 * NM * f_number)) ** 2
    assert spread.max() == pytest.approx(peak, rel=0.01)


def test_coarse_pixels_cost_no_more_than_fine_ones() -> None:
    """Pixels of hundreds of fringes: as many samples as for a fine kernel, and all the light."""
    pupil = PlainPupil(4, blades(6))
    for pitch in (1.0, 30.0):
        pattern = diffraction.pattern_of(pupil, 400, pitch, 3)
        assert pattern is not None
        assert len(pattern.light) < 1.1 * diffraction.SAMPLES * diffraction.MOST_FRINGES
    kernel = far_field(pupil, NM, 0.3, 5)
    assert kernel[2, 2] > 0.995
    assert kernel.sum() == pytest.approx(1, abs=1e-3)
    assert (kernel[2, :2] > 0).all()


def test_a_square_pupil_is_a_product_of_sinc_squared() -> None:
    half = math.sqrt(math.pi) / 2  # of the square whose area is pi, in units of the iris
    pupil = PlainPupil(10, blades(4, 45))
    pitch, size = 0.0004, 161
    spread = far_field(pupil, NM, pitch, size)
    side = 2 * half / (2 * 10)  # direction cosines across
    fine = (np.arange(size * 8) + 0.5) / 8 - size / 2
    line = (np.sinc(fine * pitch * side / (1e-6 * NM)) ** 2).reshape(size, 8).mean(axis=1)
    wanted = np.outer(line, line) * (pitch * side / (1e-6 * NM)) ** 2
    np.testing.assert_allclose(spread, wanted, atol=4e-3 * wanted.max())
    assert spread[size // 2, :].min() < 3e-3 * wanted.max()


def spikes(spread: NDArray[np.float32], inner: float, outer: float) -> list[float]:
    """Angles (deg) of the bright directions from the middle, about their axis."""
    n = len(spread) // 2
    y, x = np.mgrid[n : -n - 1 : -1, -n : n + 1]
    r, angle = np.hypot(x, y), np.degrees(np.arctan2(y, x)) % 360
    ring = (r > inner) & (r < outer)
    light, _ = np.histogram(angle[ring], 360, (0, 360), weights=spread[ring])
    around = light + np.roll(light, 1) + np.roll(light, -1)
    found = []
    for k in np.argsort(around)[::-1]:
        at = k + 0.5
        if around[k] < 0.25 * around.max():
            break
        if all(min(abs(at - f), 360 - abs(at - f)) > 8 for f in found):
            found.append(at)
    return sorted(found)


@pytest.mark.parametrize("count", [5, 6, 7, 8, 9])
def test_stars_have_as_many_spikes_as_blades_or_twice_as_many(count: int) -> None:
    """A spike stands across each edge, to both sides: those of opposite edges fall together."""
    rotation = 13.0
    spread = far_field(PlainPupil(16, blades(count, rotation)), NM, 0.004, 401)
    found = spikes(spread, 60, 190)
    across = {
        (rotation + 360 / count * (k + 0.5) + t) % 360 for k in range(count) for t in (0, 180)
    }
    wanted = sorted({round(a, 6) for a in across})
    assert len(wanted) == (count if count % 2 == 0 else 2 * count)
    assert len(found) == len(wanted)
    np.testing.assert_allclose(found, wanted, atol=1.6)


def test_a_round_iris_has_no_spikes() -> None:
    spread = far_field(PlainPupil(16), NM, 0.004, 401)
    n = 200
    y, x = np.mgrid[n : -n - 1 : -1, -n : n + 1]
    ring = np.abs(np.hypot(x, y) - 120) < 40
    angle = np.degrees(np.arctan2(y, x)) % 360
    light, _ = np.histogram(angle[ring], 36, (0, 360), weights=spread[ring])
    assert light.max() < 1.4 * light.min()


def test_a_hair_across_the_iris_makes_a_star_across_it() -> None:
    """Its light stands across the hair; the hair is upright, so left and right of the lamp."""
    hair = np.ones((128, 128), np.float32)
    hair[:, 62:66] = 0
    spread = far_field(PlainPupil(16, Iris(mask=hair)), NM, 0.004, 401)
    assert spread[198:203, 240:360].sum() > 5 * spread[240:360, 198:203].sum()


def test_a_slanted_hair_is_not_mirrored() -> None:
    """A hair from lower left to upper right lights the upper left and the lower right."""
    y, x = np.mgrid[0:128, 0:128]
    hair = np.where(np.abs((127 - y) - x) < 3, 0, 1).astype(np.float32)
    spread = far_field(PlainPupil(16, Iris(mask=hair)), NM, 0.004, 401)
    upper_left = sum(spread[200 - k, 200 - k] for k in range(40, 150))
    upper_right = sum(spread[200 - k, 200 + k] for k in range(40, 150))
    assert upper_left > 3 * upper_right


def test_narrow_stops_are_soft() -> None:
    """The transfer at 40 cycles / mm is that of the perfect lens, at f/22 and f/5.6."""
    pitch, size = 0.001, 801
    contrast = []
    for f_number in (5.6, 22.0):
        line = far_field(PlainPupil(f_number), NM, pitch, size).sum(axis=0)
        x = (np.arange(size) - size // 2) * pitch
        seen = (line * np.cos(2 * np.pi * 40 * x)).sum() / line.sum()
        pixel = np.sinc(40 * pitch)
        wanted = analysis.perfect_mtf([40], f_number, NM)[0] * pixel
        assert seen == pytest.approx(wanted, abs=0.004)
        contrast.append(seen)
    assert contrast[1] < 0.5 * contrast[0]


def test_wavelengths_are_one_pattern_at_their_scales() -> None:
    """At lambda' pixels as much larger have the same shares."""
    pupil = PlainPupil(11, blades(6))
    one = far_field(pupil, 450, 0.0045, 101)
    np.testing.assert_allclose(far_field(pupil, 650, 0.0065, 101), one, atol=1e-4 * one.max())


def test_white_light_keeps_its_colour_in_a_star() -> None:
    pupil = PlainPupil(16, blades(6))
    kernel = starburst(pupil, 0.006, 255)
    np.testing.assert_allclose(kernel.sum(axis=(0, 1)), np.eye(3), atol=2e-5)
    assert window_of(pupil, 0.006, 9999) > 1024
    ring = kernel[127, 127 + 12 : 127 + 40] @ np.ones(3)
    hue = ring / ring.sum(axis=1, keepdims=True)
    assert np.ptp(hue[:, 0]) > 0.02  # and beside the lamp it has colours


def test_band_colours_make_rgb_emitters_exact() -> None:
    nm = np.asarray(380 + (np.arange(16000) + 0.5) * 400 / 16000)
    seen, emitted = colour._tables(nm)
    for bands in (8, 16, 32):
        means = emitted.reshape(bands, -1, 3).mean(axis=1)
        xyz = colour.band_colors(bands).T @ means
        wanted = seen.T @ emitted * (400 / 16000)
        np.testing.assert_allclose(xyz, wanted, atol=2e-5)
        np.testing.assert_allclose(colour.rgb_from_xyz() @ xyz.sum(axis=1), 1, atol=3e-5)


def test_the_pupil_of_a_lens_is_that_of_the_bench() -> None:
    """The same light, from a grid of waves of the bench (psf.py) and from the fitted pupil."""
    bench = analysis.set_up(lenses.load("double-gauss-50mm-f2"), f_stop=2.8)
    light = analysis.pencil(bench, (0.0, 14.0))
    pupil = lens_pupil(bench, (0.0, 14.0), None, [NM])
    assert light is not None
    assert pupil is not None
    pitch, size = 0.002, 61
    wave = analysis.wavefront(light, NM, grid=160)
    assert wave is not None
    wanted = psf_of([wave], [1.0], 0.5 * size * pitch, size, np.zeros(2)).image
    # Bench: sagittal to the right, tangential (away from the axis) upward from row 0. At +14 mm of
    # film the picture's point lies below its middle: away from the axis is down there.
    found = far_field(pupil, NM, pitch, size)
    assert found.sum() == pytest.approx(wanted.sum(), abs=0.02)
    flipped = [wanted, wanted[::-1], wanted[:, ::-1], wanted[::-1, ::-1]]
    errors = [np.abs(found - w).sum() for w in flipped]
    assert min(errors) < 0.08
    down = found[size // 2 + 1 :].sum() - found[: size // 2].sum()
    up_bench = wanted[size // 2 + 1 :].sum() - wanted[: size // 2].sum()
    assert down == pytest.approx(up_bench, abs=0.02)  # tangential + is down in the picture
    assert abs(up_bench) > 0.1  # it is lopsided: coma


def test_large_aberrations_are_geometric() -> None:
    """Wide open and out of focus, waves fall where rays do."""
    bench = analysis.set_up(lenses.load("double-gauss-50mm-f2"), f_stop=2.8, focus_m=3)
    bench = bench.moved(bench.film_z + 0.3)
    pupil = lens_pupil(bench, (0.0, 8.0), None, [NM])
    light = analysis.pencil(bench, (0.0, 8.0))
    assert pupil is not None
    assert light is not None
    spread = far_field(pupil, NM, 0.004, 101)
    assert spread.sum() > 0.97
    rays = analysis.spot(light, [NM], [1.0], grid=128, jitter=True)
    y, x = np.mgrid[50:-51:-1, -50:51] * 0.004
    middle = [(spread * v).sum() / spread.sum() for v in (x, y)]
    # On the film, and so upside down: sagittal along +x, tangential along +y there.
    np.testing.assert_allclose(middle, -rays.centroid, atol=0.001)
    for axis, v in enumerate((x, y)):
        width = np.sqrt((spread * (v - middle[axis]) ** 2).sum() / spread.sum())
        wanted = np.sqrt(rays.weights @ (rays.points - rays.centroid)[:, axis] ** 2)
        assert wanted < width < 1.09 * wanted  # the edge's waves are a little wider


def test_mounts_cut_the_pupils_of_corners() -> None:
    bench = analysis.set_up(lenses.load("double-gauss-50mm-f2"))
    grid = zone_pupils(bench, (36, 24), 3)
    middle, corner = grid[1][1], grid[0][0]
    spans = [max(b - a for a, b in zip(p.low, p.high, strict=True)) for p in (middle, corner)]
    assert spans[1] < spans[0]
    ends = zip(corner.low, corner.high, strict=True)
    axis = [np.linspace(a, b, 301).astype(np.float32) for a, b in ends]
    light = corner.amplitude(axis[0], axis[1], NM) ** 2
    cell = (axis[0][1] - axis[0][0]) * (axis[1][1] - axis[1][0])
    full = math.pi / 4 * spans[0] ** 2
    assert 0.1 < light.sum() * cell / full < 0.7


def test_effects_of_waves_keep_light_and_colour() -> None:
    image = np.zeros((161, 161, 3), np.float32)
    image[80, 80] = (900, 700, 400)
    for effect, more in (("diffract", {}), ("star", {"share": 0.1})):
        out = getattr(dg.post, effect)(
            image, f_number=16, blades=6, sensor=(0.8, 0.8), size=101, **more
        )
        np.testing.assert_allclose(out.sum(axis=(0, 1)), image.sum(axis=(0, 1)), rtol=1e-4)
    assert out[80, 80, 0] > 800  # a star leaves the lamp sharp
    assert out[80, 100:120].sum() > 0


@pytest.mark.parametrize("rays", [pytest.param(False, marks=pytest.mark.slow), True])
def test_a_picture_through_a_lens_has_its_spot(rays: bool) -> None:
    """A point in the corner of a small film: middle and width are those of the bench."""
    image = np.zeros((81, 121, 3), np.float32)
    image[10, 20, 1] = 1
    sensor, lens = (6.05, 4.05), "double-gauss-50mm-f2"
    out = dg.post.through_lens(
        image, lens=lens, f_stop=2.8, defocus=1.0, sensor=sensor, zones=2, wavelengths=5,
        waves=not rays,
    )  # fmt: skip
    np.testing.assert_allclose(out.sum(axis=(0, 1)), (0, 1, 0), atol=0.03)
    bench = analysis.set_up(lenses.load(lens), f_stop=2.8)
    light = analysis.pencil(bench.moved(bench.film_z + 1), (2.0, -1.5))
    assert light is not None
    spot = analysis.spot(light, [NM], [1.0], grid=64)
    y, x = np.mgrid[10:-71:-1, -20:101] * 0.05
    green = out[:, :, 1]
    for k, v in enumerate((x, y)):
        width = math.sqrt((green * (v - (green * v).sum()) ** 2).sum())
        r = light.radial  # of sagittal and tangential on the film
        off = (spot.points - spot.centroid) @ np.array([[r[1], -r[0]], [r[0], r[1]]])
        assert width == pytest.approx(math.sqrt(spot.weights @ off[:, k] ** 2), rel=0.1)


def test_a_lens_far_out_of_focus_is_an_error() -> None:
    image = np.zeros((40, 40, 3), np.float32)
    with pytest.raises(UsageError, match="wanted a point spread of at most 79 px, got"):
        dg.post.through_lens(
            image, lens="double-gauss-50mm-f2", defocus=9.0, sensor=(1, 1), zones=1
        )
