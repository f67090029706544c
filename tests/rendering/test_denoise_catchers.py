"""Layers of catchers are denoised: what is taken and what is added keep their light."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from daguerre.frame.frame import Frame
from daguerre.rendering.denoise import denoise
from daguerre.rendering.denoise_catchers import REACH, clean_catchers
from tests.support.program import fake_denoiser

Image = NDArray[np.float32]
SIZE = (40, 64)


def spread(image: Image) -> Image:
    """A filter that takes noise and keeps light: the mean of 3 x 3 pixels, around the edges."""
    moved = [np.roll(image, (y, x), (0, 1)) for y in (-1, 0, 1) for x in (-1, 0, 1)]
    return np.asarray(np.mean(moved, axis=0), np.float32)


def caught(channels: int = 3) -> Frame:
    """A noisy shadow (negative), sparks beside it (positive), and a half without any change."""
    rng = np.random.default_rng(3)
    change = np.zeros((*SIZE, 3), np.float32)
    change[10:30, 8:16] = -rng.exponential(0.3, (20, 8, 3))
    change[10:30, 16:24] = 4 * (rng.random((20, 8, 3)) < 0.05)
    rgb = np.full((*SIZE, 3), 0.5, np.float32)
    own = np.ascontiguousarray(change[..., :channels])
    return Frame(
        rgb=rgb,
        catcher=change,
        catcher_ratio=np.maximum(1 + change, 0),
        catcher_channels=own,
        catcher_ratio_channels=np.maximum(1 + own, 0),
    )


@pytest.mark.parametrize("channels", [1, 3, 4])
def test_a_filter_that_changes_nothing_leaves_every_layer(channels: int) -> None:
    frame = caught(min(channels, 3))
    if channels == 4:
        own = np.concatenate([frame.catcher, frame.catcher[..., :1]], axis=2)
        frame = Frame(rgb=frame.rgb, catcher_channels=own, catcher_ratio_channels=1 + own)
    made = clean_catchers(frame, lambda light: light.copy())
    assert made
    for name, layer in made.items():
        drawn = getattr(frame, name)
        np.testing.assert_allclose(
            layer, np.maximum(drawn, 0) if "ratio" in name else drawn, rtol=1e-5, atol=1e-6
        )


def test_noise_goes_and_light_stays() -> None:
    frame = caught()
    made = clean_catchers(frame, spread)
    assert set(made) == {
        "catcher",
        "catcher_ratio",
        "catcher_channels",
        "catcher_ratio_channels",
    }
    for name, layer in made.items():
        drawn = getattr(frame, name)
        neutral = 1.0 if "ratio" in name else 0.0
        assert layer.dtype == np.float32
        assert (layer - neutral).sum() == pytest.approx((drawn - neutral).sum(), rel=1e-4)
        inside = np.s_[13:27, 10:14]
        assert layer[inside].std() < 0.5 * drawn[inside].std()


def test_where_nothing_is_near_nothing_changes_to_the_bit() -> None:
    """A denoiser may leave a veil; a plate keeps its numbers where nothing was drawn."""

    def veil(light: Image) -> Image:
        return spread(light) + np.float32(1e-3)

    drawn = caught()
    assert drawn.catcher is not None
    added = np.abs(drawn.catcher)
    made = clean_catchers(Frame(rgb=drawn.rgb, catcher=added, catcher_ratio=1 + added), veil)
    far, near = np.s_[:, 24 + REACH :], np.s_[12:28, 25 : 24 + REACH]
    assert (made["catcher"][near] > 0).all()
    assert (made["catcher"][far] == 0).all()
    assert (made["catcher_ratio"][far] == 1).all()


def test_denoising_a_frame_cleans_its_layers(monkeypatch: pytest.MonkeyPatch) -> None:
    def box(images: dict[str, Image]) -> Image:
        return spread(images["color"])

    library = fake_denoiser.install(monkeypatch.setitem, monkeypatch.setattr, box)
    frame = caught()
    clean = denoise(frame)
    assert clean.catcher is not None
    assert frame.catcher is not None
    assert clean.catcher[13:27, 10:14].std() < 0.5 * frame.catcher[13:27, 10:14].std()
    assert len(library.runs) == 1 + 2 * 4  # the picture, and both parts of each layer


def test_a_frame_without_catchers_has_no_layers_to_clean() -> None:
    def never(light: Image) -> Image:
        raise AssertionError("nothing to filter")

    assert clean_catchers(Frame(rgb=caught().rgb), never) == {}
    still = np.zeros((*SIZE, 3), np.float32)
    made = clean_catchers(Frame(rgb=caught().rgb, catcher=still), never)
    assert np.array_equal(made["catcher"], still)
