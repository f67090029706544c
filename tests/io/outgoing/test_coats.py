"""Coats and sheets of other renderers, brought to ours."""

from __future__ import annotations

import numpy as np
import pytest

from daguerre.io.outgoing.coats import (
    base_below,
    head_on,
    mean_inside,
    mean_outside,
    seen_above,
    sheet_ior,
    smooth_share,
)


def fresnel(cosine: np.ndarray, eta: float) -> np.ndarray:
    """Reflectance of an interface; eta: index beyond / index here."""
    squared = 1 - (1 - cosine**2) / eta**2
    root = np.sqrt(np.maximum(squared, 0))
    s = (cosine - eta * root) / (cosine + eta * root)
    p = (eta * cosine - root) / (eta * cosine + root)
    return np.where(squared <= 0, 1.0, 0.5 * (s**2 + p**2))


@pytest.mark.parametrize("ior", [1.1, 1.5, 2.4])
def test_mean_reflectances_are_those_of_both_sides(ior: float) -> None:
    """The inside by its own integral, total reflection and all, not by reciprocity."""
    cosine = (np.arange(400_000) + 0.5) / 400_000
    assert mean_outside(ior) == pytest.approx((2 * fresnel(cosine, ior) * cosine).mean(), rel=1e-5)
    inside = (2 * fresnel(cosine, 1 / ior) * cosine).mean()
    assert mean_inside(ior) == pytest.approx(inside, rel=1e-5)
    assert mean_inside(1 / ior) == pytest.approx(mean_outside(ior))


def test_a_base_below_a_coat_sends_what_ours_sends() -> None:
    """By following the light between base and coat, bounce after bounce."""
    color, ior = (0.2, 0.5, 0.9), 1.5
    inside = mean_inside(ior)
    base = np.array(base_below(color, ior))
    left, sent = np.ones(3), np.zeros(3)
    for _ in range(400):
        left = left * base
        sent += left * (1 - inside)
        left = left * inside
    ours = np.array(color)  # (1 - E) c (1 - E) / (1 - mean E), without the interface's factors
    np.testing.assert_allclose(sent, ours, rtol=1e-9)
    np.testing.assert_allclose(seen_above(base_below(color, ior), ior), color, rtol=1e-9)


def test_a_sheet_reflects_as_one_interface() -> None:
    for ior in (1.2, 1.5, 2.0):
        once = float(fresnel(np.array([1.0]), sheet_ior(ior))[0])
        sheet = 2 * once / (1 + once)
        assert sheet == pytest.approx(((ior - 1) / (ior + 1)) ** 2)


def rough_albedo(cosine: float, alpha: float, ior: float = 1.5) -> float:
    """Share that a rough coat reflects, by GGX's visible normals (Heitz 2018)."""
    rng = np.random.default_rng(1)
    radius, turn = np.sqrt(rng.random(60_000)), 2 * np.pi * rng.random(60_000)
    toward = np.array([np.sqrt(1 - cosine**2), 0.0, cosine])
    stretched = toward * (alpha, 1, 1) / np.linalg.norm(toward * (alpha, 1, 1))
    across = np.array([0.0, 1.0, 0.0])
    x, y = radius * np.cos(turn), radius * np.sin(turn)
    share = 0.5 * (1 + stretched[2])
    y = (1 - share) * np.sqrt(1 - x**2) + share * y
    z = np.sqrt(np.maximum(0, 1 - x**2 - y**2))
    plane = np.stack([x, y, z], 1) @ np.stack([across, np.cross(stretched, across), stretched])
    normals = plane * (alpha, alpha, 1)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    along = normals @ toward
    away = (2 * along[:, None] * normals - toward)[:, 2]

    def masking(c: np.ndarray) -> np.ndarray:
        return (np.sqrt(1 + alpha**2 * (1 - c**2) / c**2) - 1) / 2

    seen = masking(np.array([cosine]))
    pass_ = (1 + seen) / (1 + seen + masking(np.maximum(away, 1e-6)))
    return float((fresnel(np.clip(along, 1e-6, 1), ior) * pass_ * (away > 0)).mean())


@pytest.mark.parametrize("alpha", [0.05, 0.1, 0.3, 0.6, 1.0])
def test_a_rough_coat_is_a_blend_of_a_smooth_one_and_a_constant(alpha: float) -> None:
    share = smooth_share(alpha)
    for cosine in (0.2, 0.5, 1.0):
        smooth = float(fresnel(np.array([cosine]), 1.5)[0])
        blend = share * smooth + (1 - share) * head_on(1.5, alpha)
        assert blend == pytest.approx(rough_albedo(cosine, alpha), abs=0.05)
    assert head_on(1.5, alpha) == pytest.approx(rough_albedo(0.999, alpha), abs=0.004)
