"""Dust, scratches and grinding marks: what the glass of a real lens does to discs of blur."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre import lenses
from daguerre.setup.camera import set_up
from daguerre.setup.metadata import facts_of
from tests.camera.test_lens_models import LENS, rays
from tests.support.scene import scenes

ASPHERIC = "canon-rf-50mm-f1.2"


def white(**given: Any) -> np.ndarray:
    camera = dg.Camera(lens=LENS, focus_distance=math.inf, f_stop=2.8).with_(**given)
    frame = dg.render(scenes.furnace(), camera, resolution=(36, 24), spp=64, filter="box")
    return np.asarray(frame.xyz)[..., 1]


def disc(radius: float, inside: float) -> np.ndarray:
    """A spot in the middle, radius as a share of the picture's half side."""
    y, x = (np.mgrid[:256, :256] + 0.5) / 128 - 1
    return np.where(np.hypot(x, y) < radius, inside, 1).astype(np.float32)


@pytest.mark.parametrize("mask", ["front_mask", "iris_mask"])
def test_an_even_mask_takes_its_share_everywhere(mask: str) -> None:
    clean = white()
    np.testing.assert_allclose(
        white(**{mask: np.full((4, 4), 0.5, np.float32)}), 0.5 * clean, rtol=0.02
    )


def test_a_spot_at_the_iris_darkens_all_of_the_picture_by_its_area() -> None:
    order = lenses.load(LENS).first_order()
    spot = 0.3
    share = (spot * 2.8 / order.f_number) ** 2  # of the iris as it is open
    ratio = white(iris_mask=disc(spot, 0.0)) / white()
    assert ratio[11:13, 17:19].mean() == pytest.approx(1 - share, abs=0.02)
    assert ratio[2:5, 2:6].mean() == pytest.approx(1 - share, abs=0.08)


@pytest.mark.parametrize("mask", ["front_mask", "iris_mask"])
@pytest.mark.parametrize(("side", "axis"), [(np.s_[:, 32:], 0), (np.s_[:32], 1)])
def test_dust_shows_where_the_rays_cross_it(mask: str, side: Any, axis: int) -> None:
    """Half of it is shut: rays leave through the other half of the pupil alone."""
    shut = np.ones((64, 64), np.float32)
    shut[side] = 0
    camera = dg.Camera(lens=LENS, focus_distance=math.inf, f_stop=4.0)
    origins, _, weights = rays(camera.with_(**{mask: shut}), [(0.0, 0.0)], 1024)
    passed = weights[0, :, 0] > 0.9
    assert origins[0, passed, axis].max() < 5e-4
    assert 0.4 < passed.mean() < 0.6


def test_the_front_mask_is_as_wide_as_the_front() -> None:
    spot = 0.3
    camera = dg.Camera(lens=LENS, focus_distance=math.inf, f_stop=2.0, front_mask=disc(spot, 0.0))
    origins, _, weights = rays(camera, [(0.0, 0.0)], 4096)
    inner = 1e3 * np.hypot(*origins[0, weights[0, :, 0] > 0, :2].T).min()
    front = lenses.load(LENS).surfaces[0].semi_diameter
    assert front is not None
    assert inner == pytest.approx(spot * front, rel=0.04)


def test_grinding_marks_make_rings_and_move_no_light() -> None:
    """Rays lean by the slopes of grooves 2 nm high, and differently by ring."""
    camera = dg.Camera(lens=ASPHERIC, focus_distance=2.0, f_stop=1.4)
    marked = camera.with_(ripple=(2.0, 100.0, 3))
    film = [(0.0, 0.0), (9.0, 5.0)]
    _, plain, passed = rays(camera, film, 2048)
    _, bent, both = rays(marked, film, 2048)
    for i in range(2):  # the aim knows the polished lens, and serves the marked one as well
        ok = (passed[i, :, 0] > 0) & (both[i, :, 0] > 0)
        assert ok.mean() > 0.98 * (passed[i, :, 0] > 0).mean()
        lean = np.linalg.norm(bent[i, ok] - plain[i, ok], axis=1)
        assert 1e-6 < lean.mean() < 3e-4
        assert both[i].mean() == pytest.approx(passed[i].mean(), rel=0.01)
    facts = facts_of(set_up(dg.Scene(), marked, (36, 24), None))
    assert facts["ripple"] == [2.0, 100.0, 3]


@pytest.mark.parametrize(
    ("given", "wanted"),
    [
        ({"front_mask": np.full((2, 2), 2.0, np.float32)}, "front_mask: wanted values of 0 to 1"),
        ({"iris_mask": np.zeros((2, 2, 3), np.float32)}, r"iris_mask: wanted shape \(H, W\)"),
        (
            {"lens_model": "thick", "iris_mask": np.ones((2, 2))},
            "iris_mask: wanted lens_model",
        ),
        ({"lens_model": "thin", "ripple": (20.0, 100.0)}, "ripple: wanted lens_model exact"),
        ({"ripple": (2.0, 100.0)}, r"ripple: .* no aspheric surface"),
        ({"ripple": (2e5, 100.0)}, "ripple"),
        ({"ripple": 5.0}, "ripple"),
    ],
)
def test_what_cannot_be_is_refused(given: dict[str, Any], wanted: str) -> None:
    camera = dg.Camera(lens=LENS, focus_distance=3.0).with_(**given)
    with pytest.raises((dg.UsageError, dg.InputError), match=wanted):
        set_up(dg.Scene(), camera, (36, 24), None)
