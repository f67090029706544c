"""Convolution: against sums by hand, energy, zones, NaN, lamps beside the dark, and its effects."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

import daguerre as dg
from daguerre.convolution import overlap
from daguerre.convolution.convolve import convolve, spread
from daguerre.errors import InputError, UsageError
from daguerre.post import kernels

RNG = np.random.default_rng(7)


def by_hand(image: NDArray[np.float64], kernel: NDArray[np.float64]) -> NDArray[np.float64]:
    """Each pixel's light spread around it; what leaves the frame is lost."""
    (height, width), (h, w) = image.shape, kernel.shape
    out = np.zeros((height + h, width + w))
    for y in range(h):
        for x in range(w):
            out[y : y + height, x : x + width] += kernel[y, x] * image
    return out[h // 2 : h // 2 + height, w // 2 : w // 2 + width]


@pytest.mark.parametrize(
    ("size", "kernel"),
    [((40, 33), (9, 12)), ((300, 310), (65, 31)), ((70, 90), (261, 270)), ((7, 9), (31, 30))],
)
def test_a_convolution_is_the_sum_by_hand(
    size: tuple[int, int], kernel: tuple[int, int], monkeypatch: pytest.MonkeyPatch
) -> None:
    image, k = RNG.random(size), RNG.random(kernel)
    k /= k.sum()
    np.testing.assert_allclose(convolve(image, k), by_hand(image, k), atol=3e-6)
    monkeypatch.setattr(overlap, "SPECTRA_BYTES", 1 << 20)  # tiles
    np.testing.assert_allclose(convolve(image, k, threads=2), by_hand(image, k), atol=3e-6)


def test_threads_change_no_bit() -> None:
    image, kernel = RNG.random((300, 500, 3)), RNG.random((41, 41))
    one = convolve(image, kernel, threads=1)
    for threads in (2, 3):
        assert np.array_equal(one, convolve(image, kernel, threads=threads))


def test_light_is_kept_but_for_what_leaves_the_frame() -> None:
    image = np.zeros((101, 101))
    image[50, 50] = 5
    kernel = RNG.random((51, 51))
    kernel /= kernel.sum()
    assert convolve(image, kernel).sum() == pytest.approx(5, rel=1e-6)
    edge = np.zeros((101, 101))
    edge[0, 50] = 5
    kept = kernel[25:].sum()
    out = convolve(edge, kernel)
    assert out.sum() == pytest.approx(5 * kept, rel=1e-6)
    assert np.abs(out[60:]).max() < 1e-6  # nothing comes in again from below


def test_channels_each_have_their_kernel_or_are_mixed() -> None:
    image = RNG.random((30, 40, 3))
    each = RNG.random((5, 7, 3))
    mixed = RNG.random((5, 7, 3, 3))
    apart, together = convolve(image, each), convolve(image, mixed)
    for j in range(3):
        np.testing.assert_allclose(
            apart[:, :, j], by_hand(image[:, :, j], each[:, :, j]), rtol=1e-5
        )
        wanted = sum(by_hand(image[:, :, i], mixed[:, :, j, i]) for i in range(3))
        np.testing.assert_allclose(together[:, :, j], wanted, rtol=1e-5)
    with pytest.raises(UsageError, match=r"kernel: wanted .*\(h, w, 3, 3\), got \(5, 7, 2\)"):
        convolve(image, each[:, :, :2])


def test_zones_are_blended_and_keep_the_light() -> None:
    """Halfway between two points of the grid light is spread by the mean of their kernels."""
    kernels = RNG.random((1, 3, 9, 9, 1, 1)).astype(np.float32)
    kernels /= kernels.sum(axis=(2, 3), keepdims=True)
    image = np.zeros((41, 161, 1), np.float32)
    image[20, 40] = 1  # middle of 0.5 .. 160.5 of 161: a quarter of the way
    at = (40 + 0.5) / 161 * 2
    out = spread(image, kernels)[:, :, 0]
    wanted = (1 - at) * kernels[0, 0, :, :, 0, 0] + at * kernels[0, 1, :, :, 0, 0]
    np.testing.assert_allclose(out[16:25, 36:45], wanted, atol=1e-6)
    image[:] = 0
    image[15:25, 10:150] = RNG.random((10, 140, 1))
    assert spread(image, kernels).sum() == pytest.approx(image.sum(), rel=1e-5)


def test_nan_spreads_no_light_and_stays() -> None:
    image = RNG.random((40, 40, 3)).astype(np.float32)
    image[5, 6, 1], image[7, 8] = np.nan, np.inf
    before = image.copy()
    out = convolve(image, np.full((9, 9), 1 / 81))
    assert np.array_equal(np.isnan(out), np.isnan(image))
    assert np.array_equal(np.isinf(out), np.isinf(image))
    assert np.array_equal(image, before, equal_nan=True)
    dark = np.where(np.isfinite(image), image, 0)
    finite = np.isfinite(image)
    np.testing.assert_allclose(
        out[finite], convolve(dark, np.full((9, 9), 1 / 81))[finite], atol=1e-6
    )


def test_a_lamp_leaves_no_noise_in_the_dark() -> None:
    """A float transform errs by a part of the brightest value: the middle goes by itself."""
    image = np.zeros((900, 900))
    image[100, 100] = 1e7
    r = np.hypot(*np.mgrid[-320:321, -320:321])
    kernel = 1 / (1 + r**2) ** 2
    kernel /= kernel.sum()
    out = convolve(image, kernel)
    far = np.zeros(out.shape, bool)
    far[600:] = True
    assert np.abs(out[far]).max() < 1e-4
    seen = np.s_[350:420, 100]
    wanted = 1e7 * kernel[320 + 250 : 320 + 320, 320]
    np.testing.assert_allclose(out[seen], wanted, rtol=0.02)


@pytest.mark.parametrize(
    ("effect", "given"),
    [
        ("bloom", {"radius": 2, "share": 0.3}),
        ("halo", {"share": 0.2, "sensor": (2, 1.5)}),
        ("glare", {"share": 0.3, "sensor": (36, 24)}),
    ],
)
def test_glow_keeps_the_light_and_alpha(effect: str, given: dict[str, object]) -> None:
    image = np.zeros((241, 321, 4), np.float32)
    image[100:140, 150:170, :3] = 100
    image[:, :, 3] = RNG.random((241, 321))
    out = getattr(dg.post, effect)(image, **given)
    assert np.array_equal(out[:, :, 3], image[:, :, 3])
    lost = 1 - out[:, :, :3].sum() / image[:, :, :3].sum()
    assert -1e-5 < lost < (0.15 if effect == "glare" else 0.01)
    assert out[100, 130, 0] > 0


def test_half_of_a_bloom_lies_within_its_radius() -> None:
    image = np.zeros((801, 801, 1), np.float32)
    image[400, 400] = 1
    out = dg.post.bloom(image, radius=10, share=0.5)
    r = np.hypot(*np.mgrid[-400:401, -400:401])
    out[400, 400] -= 0.5
    assert out[r < 10].sum() / out.sum() == pytest.approx(0.5, abs=0.02)


@pytest.mark.parametrize("make", [kernels.bloom, lambda t, size: kernels.halation(t, 1.48, size)])
def test_a_glow_ends_in_no_square(make: Callable[[float, int], NDArray[np.float32]]) -> None:
    """About a lamp of ten thousand the end of the window would be seen."""
    kernel = make(5.0, 301)
    assert kernel.sum() == pytest.approx(1, abs=1e-5)
    assert kernel[150, 300] < 1e-3 * kernel[150, 250]
    assert kernel[0, 0] == 0


def test_halation_has_its_ring_at_the_critical_angle() -> None:
    """2 t / sqrt(n^2 - 1): beyond it all light is reflected."""
    image = np.zeros((301, 301, 1), np.float32)
    image[150, 150] = 1
    pitch, thickness, index = 0.01, 0.13, 1.48
    size = 301 * pitch
    out = dg.post.halo(image, share=1, thickness=thickness, index=index, sensor=(size, size))
    row = out[150, 150:, 0]
    ring = 2 * thickness / np.sqrt(index**2 - 1) / pitch
    assert np.argmax(np.diff(row)[3:]) + 3 == pytest.approx(ring, abs=1.5)


def test_an_own_kernel_must_fit_into_the_picture(tmp_path: object) -> None:
    import OpenImageIO as oiio

    path = f"{tmp_path}/kernel.exr"
    kernel = np.zeros((31, 5, 3), np.float32)
    kernel[15, 4] = 2
    output = oiio.ImageOutput.create(path)
    output.open(path, oiio.ImageSpec(5, 31, 3, "float"))
    output.write_image(kernel)
    output.close()
    image = RNG.random((40, 40, 3)).astype(np.float32)
    out = dg.post.spread_by(image, file=path)
    np.testing.assert_allclose(out[:, 2:], image[:, :-2], atol=1e-6)
    with pytest.raises(InputError, match=r"wanted at most the picture's size, 40 x 20 px, got 5 x"):
        dg.post.spread_by(image[:20], file=path)
