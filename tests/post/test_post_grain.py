"""Film grain: the mean of light stays, variance and spectrum are those of the"""

from __future__ import annotations

import numpy as np
import pytest

import daguerre as dg
from daguerre import _core
from daguerre.errors import UsageError
from daguerre.post.effects.grain import relative_variance, sharpness

FILM = {"sensor": (36.0, 24.0)}


def grey(light: float, side: int = 400) -> np.ndarray:
    return np.full((side, side, 3), light, np.float32)


@pytest.mark.parametrize("light", [0.02, 0.18, 1.0, 30.0])
def test_light_keeps_its_mean_and_has_the_variance_of_the_boolean_model(light: float) -> None:
    # 90 um a pixel, grains of 9 um: 127 of them would cover a pixel
    out = dg.post.grain(grey(light), size=9, **FILM)
    count = out.size
    wanted = relative_variance(np.array(light)) * np.pi * 0.05**2
    spread = np.sqrt(wanted / count)
    assert out.mean(dtype=float) == pytest.approx(light, rel=5 * spread)
    assert out.var(dtype=float) / light**2 == pytest.approx(wanted, rel=0.02)


def test_the_variance_is_that_of_grains_thrown_on_a_film() -> None:
    """Discs thrown by chance on many pixels, at one grain over a point; the light read back."""
    rng = np.random.default_rng(1)
    radius, pixel, fine, q = 1.0, 8, 4, 1.0
    side = 48 * pixel
    count = rng.poisson(q / (np.pi * radius**2) * (side + 4) ** 2)
    covered = np.zeros((side * fine, side * fine), bool)
    reach = int(radius * fine) + 1
    for x, y in rng.uniform(-2, side + 2, (count, 2)) * fine:
        x0, x1 = max(int(x) - reach, 0), min(int(x) + reach + 2, side * fine)
        y0, y1 = max(int(y) - reach, 0), min(int(y) + reach + 2, side * fine)
        if x0 < x1 and y0 < y1:
            dx = np.arange(x0, x1) + 0.5 - x
            dy = np.arange(y0, y1)[:, None] + 0.5 - y
            covered[y0:y1, x0:x1] |= dx**2 + dy**2 <= (radius * fine) ** 2
    block = pixel * fine
    share = covered.reshape(48, block, 48, block).mean(axis=(1, 3))
    assert share.mean() == pytest.approx(1 - np.exp(-q), abs=0.01)
    light = share.var() / np.exp(-q) ** 2  # d(light) = d(share) / (1 - share)
    r = radius / pixel
    wanted = relative_variance(np.array(q)) * np.pi * r**2 * sharpness(r)
    assert light == pytest.approx(wanted, rel=0.12)  # 2304 pixels; some grains lie on two


def test_grain_is_the_same_in_a_crop_and_another_with_another_seed() -> None:
    noisy = dg.post.grain(grey(0.5, 90), **FILM)
    assert (noisy == dg.post.grain(grey(0.5, 90), **FILM)).all()
    assert (noisy != dg.post.grain(grey(0.5, 90), **FILM, seed=1)).mean() > 0.99
    assert abs(np.corrcoef(noisy[..., 0].ravel(), noisy[..., 1].ravel())[0, 1]) < 0.06
    mono = dg.post.grain(grey(0.5, 90), **FILM, colour=False)
    assert (mono[..., 0] == mono[..., 1]).all()


def test_the_spectrum_is_that_of_a_grain() -> None:
    side, radius = 512, 2.0
    power = np.abs(np.fft.fft2(_core.grain_pattern(0, 0, side, side, radius, 3, 0))) ** 2 / side**2
    f = np.hypot(*np.meshgrid(np.fft.fftfreq(side), np.fft.fftfreq(side)))
    rings = [power[(f >= k / 40) & (f < (k + 1) / 40)].mean() for k in range(12)]
    fine = (np.arange(9 * 16) + 0.5) / 16 - 4.5
    disc = (fine[:, None] ** 2 + fine**2 <= radius**2).reshape(9, 16, 9, 16).sum(axis=(1, 3))
    disc = disc / np.sqrt((disc.astype(float) ** 2).sum())
    shape = np.abs(np.fft.fft2(disc, (side, side))) ** 2
    wanted = [shape[(f >= k / 40) & (f < (k + 1) / 40)].mean() for k in range(12)]
    assert rings == pytest.approx(wanted, rel=0.12, abs=0.02)


def test_black_alpha_and_what_is_no_number_stay() -> None:
    image = np.ones((20, 20, 4), np.float32)
    image[3, 3, :3] = 0
    image[4, 4, 0] = np.nan
    image[5, 5, 1] = -0.25
    out = dg.post.grain(image, **FILM, size=50)
    assert (out[..., 3] == 1).all()
    assert (out[3, 3, :3] == 0).all()
    assert np.isnan(out[4, 4, 0])
    assert np.isfinite(np.delete(out.ravel(), (4 * 20 + 4) * 4)).all()
    with pytest.raises(UsageError, match="sensor: the file has none; give its size"):
        dg.post.grain(image)
