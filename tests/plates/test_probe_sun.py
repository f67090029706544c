"""The sun of a panorama: where it is, how bright, and what clipping took."""

from __future__ import annotations

import math

import numpy as np
import pytest

import daguerre as dg
from daguerre.color.spectra import luminance_of_rgb
from daguerre.errors import InputError, UsageError
from daguerre.plates.probe.latlong import solid_angles
from daguerre.plates.probe.restore import ground_illuminance
from tests.support.pictures.light_probes import ball_picture, grid, mirror, save

WIDTH, HEIGHT = 1024, 512
TOWARD = np.array([0.4, 0.5, -0.6]) / np.linalg.norm([0.4, 0.5, -0.6])
FOV = math.degrees(2 * math.atan(240 / 600))
LUMA = luminance_of_rgb()


def sky(d):
    """Soft sky over a darker ground, cd/m2."""
    shape = np.where(d[..., 1] > 0, 3000 + 2000 * d[..., 1], 1500)
    return shape[..., None] * (0.8, 1.0, 1.3)


def sunny(d, lux=80000.0, diameter=0.8, toward=TOWARD):
    """The sky with an even sun of an illuminance that faces it."""
    radius = math.radians(diameter) / 2
    disc = (d @ toward > math.cos(radius))[..., None] * np.array([1.05, 1.0, 0.9])
    # Integral of the cosine over the disc, by which a facing surface counts: pi sin^2.
    return sky(d) + disc * lux / (math.pi * math.sin(radius) ** 2) / float(LUMA @ (1.05, 1.0, 0.9))


def panorama(lux=80000.0, diameter=0.8):
    """Means over pixels of 4 x 4 places."""
    fine = sunny(grid(WIDTH * 4, HEIGHT * 4), lux, diameter)
    return fine.reshape(HEIGHT, 4, WIDTH, 4, 3).mean(axis=(1, 3)).astype(np.float32)


def total(image):
    return np.einsum("hwc,h->c", image.astype(np.float64), solid_angles(WIDTH, HEIGHT))


@pytest.fixture(scope="module")
def bright():
    return panorama()


@pytest.fixture
def file(tmp_path, bright):
    return save(tmp_path / "pano.exr", bright)


def angle_deg(a, b):
    return math.degrees(math.acos(min(float(np.dot(a, b)), 1)))


def test_sun_is_found_and_nothing_is_lost(file, bright):
    """Turns red if pixels near the poles count as those of the horizon."""
    made = dg.light_probe(file)
    assert made.sun is not None
    assert angle_deg(made.sun.direction, TOWARD) < 0.05
    assert made.sun.lux == pytest.approx(80000, rel=0.01)
    assert made.sun.diameter_deg == pytest.approx(0.8, rel=0.15)
    assert np.array_equal(made.image, bright)
    assert total(made.rest) + made.sun.illuminance == pytest.approx(total(bright), rel=1e-6)


def test_disc_has_the_energy_and_the_place(file, bright):
    made = dg.light_probe(file, sun="disc", sun_diameter=0.533)
    assert total(made.image) == pytest.approx(total(bright), rel=1e-6)
    extra = (made.image - made.rest).astype(np.float64) @ LUMA
    centre = np.einsum("hw,h,hwc->c", extra, solid_angles(WIDTH, HEIGHT), grid(WIDTH, HEIGHT))
    assert angle_deg(centre / np.linalg.norm(centre), TOWARD) < 0.05


def test_off_seeks_none(file):
    made = dg.light_probe(file, sun="off")
    assert made.sun is None


def test_even_light_has_no_sun(tmp_path):
    image = sky(grid(WIDTH, HEIGHT)).astype(np.float32)
    assert dg.light_probe(save(tmp_path / "sky.exr", image)).sun is None


def test_a_window_is_no_sun(tmp_path):
    d = grid(WIDTH, HEIGHT)
    window = (np.abs(d[..., 0]) < 0.3) & (np.abs(d[..., 1]) < 0.3) & (d[..., 2] < 0)
    image = np.where(window[..., None], 500 + 50 * d[..., :1], 1.0) * np.ones(3)
    assert dg.light_probe(save(tmp_path / "room.exr", image.astype(np.float32))).sun is None


def test_clipped_sun_is_warned_of(tmp_path, bright):
    made = dg.light_probe(save(tmp_path / "clipped.exr", np.minimum(bright, 30000)))
    assert made.sun is None or made.sun.clipped
    (text,) = made.warnings
    assert "of the sphere is clipped in every photograph, around azimuth 34" in text
    inner = (1 - math.cos(math.radians(0.4))) / 2
    assert inner < made.facts["clipped"]["share"] < 2.5 * inner


def test_clipped_sun_by_a_meter(tmp_path, bright):
    """The ground's illuminance becomes what the meter read; turns red without its cosine."""
    lux = ground_illuminance(bright)
    path = save(tmp_path / "clipped.exr", np.minimum(bright, 30000))
    made = dg.light_probe(path, illuminance=lux, res=WIDTH)
    assert ground_illuminance(made.image) == pytest.approx(lux, rel=0.002)
    assert made.sun.lux == pytest.approx(80000, rel=0.01)
    assert angle_deg(made.sun.direction, TOWARD) < 0.2
    assert made.sun.solved == "illuminance"
    assert made.sun.diameter_deg == pytest.approx(0.533)
    assert made.warnings == ()


def test_clipped_sun_by_a_grey_ball(tmp_path, bright):
    """Reflectance and exposure of the ball need not be known; the sun's colour comes back."""
    toward = grid(48, 24).reshape(-1, 3)
    light = sky(toward) * np.repeat(solid_angles(48, 24), 48)[:, None]
    # The sky is the same all around, so its irradiance depends on the normal's height alone.
    heights = np.linspace(-1, 1, 101)
    tilted = np.stack([np.sqrt(1 - heights**2), heights, np.zeros(101)], axis=1)
    soft_of = np.maximum(tilted @ toward.T, 0) @ light
    truth = np.array([1.05, 1.0, 0.9]) * 80000 / float(LUMA @ (1.05, 1.0, 0.9))

    def surface(n, _):
        soft = np.stack([np.interp(n[:, 1], heights, soft_of[:, c]) for c in range(3)], axis=1)
        return 1.7e-5 * (soft + np.maximum(n @ TOWARD, 0)[..., None] * truth)

    a = math.radians(60)
    turn = np.array([[math.cos(a), 0, math.sin(a)], [0, 1, 0], [-math.sin(a), 0, math.cos(a)]])
    picture = ball_picture(lambda n, d: surface(n @ turn.T, d), background=1e-4)
    grey = save(tmp_path / "grey.exr", picture)
    path = save(tmp_path / "clipped.exr", np.minimum(bright, 30000))
    made = dg.light_probe(path, grey=grey, grey_direction=60, fov=FOV)
    assert made.sun.illuminance == pytest.approx(truth, rel=0.01)
    with pytest.raises(InputError, match=r"--grey: the ball is not brighter toward the sun"):
        dg.light_probe(path, grey=grey, grey_direction=-120, fov=FOV)


def test_clipped_mirror_ball_by_a_meter(tmp_path):
    """A ball's mirror image of a sun, clipped, in a map of its own size."""
    toward = np.array([0.3, 0.7, 0.4]) / np.linalg.norm([0.3, 0.7, 0.4])
    picture = ball_picture(mirror(lambda d: sunny(d, 80000, 1.5, toward)))
    lux = ground_illuminance(sky(grid(WIDTH, HEIGHT)).astype(np.float32)) + 80000 * toward[1]
    path = save(tmp_path / "ball.exr", np.minimum(picture, 30000))
    made = dg.light_probe(path, ball="mirror", fov=FOV, illuminance=lux)
    assert angle_deg(made.sun.direction, toward) < 0.5
    assert made.sun.lux == pytest.approx(80000, rel=0.02)


def test_meter_scales_what_is_not_clipped(file, bright):
    made = dg.light_probe(file, illuminance=2 * ground_illuminance(bright))
    assert np.allclose(made.image, 2 * bright, rtol=1e-5)
    assert made.sun.lux == pytest.approx(160000, rel=0.01)


def test_meter_that_does_not_fit(tmp_path, bright):
    path = save(tmp_path / "clipped.exr", np.minimum(bright, 30000))
    with pytest.raises(
        InputError, match=r"wanted more than the 1.* lux of the map without its sun"
    ):
        dg.light_probe(path, illuminance=1000)
    with pytest.raises(UsageError, match="--grey and --illuminance: wanted one of them"):
        dg.light_probe(path, illuminance=1000, grey=path)


def test_meter_needs_units(tmp_path, bright):
    codes = np.clip(bright / 30000, 0, 1) ** (1 / 2.2)
    path = save(tmp_path / "clipped.png", np.rint(255 * codes).astype(np.uint8))
    with pytest.raises(InputError, match=r"--illuminance needs light in a known unit"):
        dg.light_probe(path, illuminance=100000)
    scaled = dg.light_probe(path, illuminance=ground_illuminance(bright), scale=30000)
    assert scaled.sun.lux == pytest.approx(80000, rel=0.03)


def test_panorama_turns(file, bright):
    made = dg.light_probe(file, rotate=90, sun="off")
    assert np.array_equal(made.image, np.roll(bright, -WIDTH // 4, axis=1))


def test_smaller_map_keeps_all_light(file, bright):
    made = dg.light_probe(file, res=300, sun="off")
    weights = solid_angles(300, 150)
    assert np.einsum("hwc,h->c", made.image, weights) == pytest.approx(total(bright), rel=1e-5)
