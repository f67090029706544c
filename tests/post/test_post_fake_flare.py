"""The fake of lens flare: where its spots lie, and how much light they have."""

from __future__ import annotations

import numpy as np
import pytest

import daguerre as dg
from daguerre.post.effects.fake_flare import ghosts


def lamp(x: int = 230, y: int = 120, light: float = 1e6) -> np.ndarray:
    image = np.zeros((240, 320, 3), np.float32)
    image[y, x] = light
    return image


def centroid(plane: np.ndarray) -> tuple[float, float]:
    y, x = np.mgrid[: plane.shape[0], : plane.shape[1]]
    return (plane * x).sum() / plane.sum(), (plane * y).sum() / plane.sum()


@pytest.mark.parametrize("seed", [0, 3])
def test_a_ghost_lies_on_the_line_through_the_middle_with_two_reflections(seed: int) -> None:
    image = lamp(170, 125)
    out = dg.post.fake_flare(image, ghosts=1, reflectance=0.02, seed=seed) - image
    (ghost,) = ghosts(1, seed)
    assert out.sum() == pytest.approx(image.sum() * 0.02**2, rel=1e-3)
    for k in range(3):
        assert out[..., k].sum() == pytest.approx(1e6 * 0.02**2 * ghost.tint[k], rel=1e-3)
    x, y = centroid(out[..., 1])
    assert x == pytest.approx(159.5 + ghost.place * (170 - 159.5), abs=0.05)
    assert y == pytest.approx(119.5 + ghost.place * (125 - 119.5), abs=0.05)


def test_the_ring_lies_around_the_lamp() -> None:
    image = lamp(160, 120)
    out = dg.post.fake_flare(image, ghosts=0, halo=0.01, halo_radius=0.4) - image
    y, x = np.mgrid[:240, :320]
    radius = np.hypot(x - 160, y - 120)
    assert out[(radius < 70) | (radius > 90)].max() < 1e-6 * out.max() + 1e-4
    assert out.sum() == pytest.approx(0.01 * image.sum(), rel=1e-3)


def test_dark_pictures_alpha_and_what_is_no_number_stay() -> None:
    rng = np.random.default_rng(1)
    image = rng.random((60, 90, 4)).astype(np.float32)
    assert (dg.post.fake_flare(image) == image).all()
    image[30, 20, :3] = 1e7
    image[3, 3, 0] = np.nan
    out = dg.post.fake_flare(image)
    assert (out[..., 3] == image[..., 3]).all()
    assert np.isnan(out).sum() == 1
    assert np.isnan(out[3, 3, 0])
    assert (out[..., :3] > image[..., :3]).sum() > 1000


def test_large_pictures_are_flared_in_small() -> None:
    image = np.zeros((1100, 1500, 3), np.float32)
    image[400:403, 1000:1003] = 1e6
    out = dg.post.fake_flare(image, ghosts=4) - image
    assert out.sum() == pytest.approx(1e-4 * 9e6 * 4 * 3, rel=0.35)  # some lies outside
