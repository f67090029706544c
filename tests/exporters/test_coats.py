"""Coats and sheets of other renderers, brought to ours."""

from __future__ import annotations

import numpy as np
import pytest

from daguerre.exporters.outgoing.coats import (
    base_below,
    mean_inside,
    mean_outside,
    sheet_ior,
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


def test_a_sheet_reflects_as_one_interface() -> None:
    for ior in (1.2, 1.5, 2.0):
        once = float(fresnel(np.array([1.0]), sheet_ior(ior))[0])
        sheet = 2 * once / (1 + once)
        assert sheet == pytest.approx(((ior - 1) / (ior + 1)) ** 2)
