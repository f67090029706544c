"""Matt balls under known light: soft light of order 2 and a sun."""

from __future__ import annotations

import math

import numpy as np
import pytest

import daguerre as dg
from daguerre.color.spectra import luminance_of_rgb
from daguerre.errors import UsageError
from tests.support.pictures.light_probes import ball_picture, exposure, grid, save

FOV = math.degrees(2 * math.atan(240 / 600))
SUN = np.array([0.5, 0.6, 0.4]) / np.linalg.norm([0.5, 0.6, 0.4])
COLOUR = np.array([30.0, 27.0, 22.0])


def soft_light(d):
    """Soft light of order 2 that is nowhere negative."""
    x, y, z = np.moveaxis(d, -1, 0)
    shape = 1 + 0.5 * y + 0.15 * x + 0.2 * (y * y - 1 / 3) + 0.1 * x * z
    return shape[..., None] * (4.0, 5.0, 7.0)


def soft_irradiance(n):
    """Its irradiance by the factors pi, 2 pi / 3 and pi / 4 of the orders."""
    x, y, z = np.moveaxis(n, -1, 0)
    shape = (
        math.pi
        + 2 * math.pi / 3 * (0.5 * y + 0.15 * x)
        + math.pi / 4 * (0.2 * (y * y - 1 / 3) + 0.1 * x * z)
    )
    return shape[..., None] * (4.0, 5.0, 7.0)


def matt(sun=SUN, colour=COLOUR, reflectance=0.18):
    def surface(n, _):
        irradiance = soft_irradiance(n) + np.maximum(n @ sun, 0)[..., None] * colour
        return reflectance / np.pi * irradiance

    return surface


def noisy(picture, seed=0):
    rng = np.random.default_rng(seed)
    return np.maximum(picture * (1 + 0.01 * rng.normal(size=picture.shape)), 0).astype(np.float32)


def angle_deg(a, b):
    return math.degrees(math.acos(min(float(np.dot(a, b)), 1)))


@pytest.mark.parametrize(
    "sun", [(0.5, 0.6, 0.4), (-0.7, 0.3, 0.1), (0.2, 0.9, -0.3), (0.5, 0.3, -0.8), (0, 0.5, 0.8)]
)
def test_the_sun_by_its_terminator(tmp_path, sun):
    """Turns red with normals mirrored in x, without the factor pi, or if suns on opposite sides,
    which leave the same with soft light of either sign, are not told apart.
    """
    toward = np.array(sun) / np.linalg.norm(sun)
    picture = noisy(ball_picture(matt(toward)))
    made = dg.light_probe(save(tmp_path / "grey.exr", picture), ball="grey", fov=FOV)
    assert made.sun is not None
    assert angle_deg(made.sun.direction, toward) < 1.5
    assert made.sun.illuminance == pytest.approx(COLOUR, rel=0.05)
    seen = grid(1024, 512) @ (0, 0, 1) > 0.5
    soft = soft_light(grid(1024, 512)[seen])
    assert np.abs(made.rest[seen] / soft - 1).mean() < 0.08


def test_a_ball_seen_from_far_away(tmp_path):
    picture = noisy(ball_picture(matt(), focal=60000, middle=(0, 0, -500)))
    made = dg.light_probe(save(tmp_path / "grey.exr", picture), ball="grey", fov=0)
    assert angle_deg(made.sun.direction, SUN) < 1.5
    assert made.sun.illuminance == pytest.approx(COLOUR, rel=0.05)


def test_through_a_camera_with_brackets(tmp_path):
    """8 bits and a curve, in candela and lux."""
    light = ball_picture(matt()) * 300
    paths = []
    for seconds in (1 / 1000, 1 / 250, 1 / 60):
        codes = (np.clip(light * seconds * 100 / 64 / 70.7355, 0, 1)) ** (1 / 2.2)
        codes = np.rint(255 * codes).astype(np.uint8)
        paths.append(save(tmp_path / f"{seconds:.4f}.png", codes, exposure(seconds)))
    made = dg.light_probe(paths, ball="grey", fov=FOV)
    assert made.absolute
    assert angle_deg(made.sun.direction, SUN) < 2
    assert made.sun.lux == pytest.approx(float(luminance_of_rgb() @ COLOUR) * 300, rel=0.08)


def test_soft_light_alone_has_no_sun(tmp_path):
    picture = noisy(ball_picture(matt(colour=np.zeros(3))))
    made = dg.light_probe(save(tmp_path / "soft.exr", picture), ball="grey", fov=FOV)
    assert made.sun is None
    seen = grid(1024, 512) @ (0, 0, 1) > 0.5
    assert np.abs(made.image[seen] / soft_light(grid(1024, 512)[seen]) - 1).mean() < 0.05


def test_the_light_is_never_negative(tmp_path):
    """A ball lit from one side only: nothing but a sun."""

    def surface(n, _):
        return 0.18 / np.pi * np.maximum(n @ SUN, 0)[..., None] * COLOUR

    picture = ball_picture(surface, background=0.5)
    made = dg.light_probe(save(tmp_path / "hard.exr", picture), ball="grey", fov=FOV)
    assert (made.rest >= 0).all()
    assert angle_deg(made.sun.direction, SUN) < 1
    assert made.sun.illuminance == pytest.approx(COLOUR, rel=0.05)


def test_camera_yaw_turns_the_sun(tmp_path):
    path = save(tmp_path / "grey.exr", ball_picture(matt()))
    plain = dg.light_probe(path, ball="grey", fov=FOV)
    made = dg.light_probe(path, ball="grey", fov=FOV, ball_direction=90)
    x, y, z = plain.sun.direction
    assert made.sun.direction == pytest.approx((z, y, -x), abs=1e-3)


def test_one_side_alone(tmp_path):
    path = save(tmp_path / "grey.exr", ball_picture(matt()))
    with pytest.raises(UsageError, match="wanted one value for a grey ball"):
        dg.light_probe([path, path], ball="grey", ball_direction=(0, 90), ev=(0, 0))
