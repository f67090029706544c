"""Light below Mitsuba's rough coats, and bases that make up for what it loses."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from daguerre.exporters.mitsuba.rough_plastic import (
    Loss,
    counted_inside,
    reflectance,
    transmittance,
)
from daguerre.exporters.outgoing.coats import mean_outside

IOR = 1.5


def through(alpha: float) -> float:
    """Share of diffuse light that passes facets, by GGX's visible normals (Heitz 2018)."""
    random = np.random.default_rng(5)
    share, radius, turn = random.random((3, 300_000))
    cosine = np.sqrt(share)
    toward = np.stack([np.sqrt(1 - cosine**2), 0 * cosine, cosine])
    stretched = toward * np.array([[alpha], [alpha], [1]])
    stretched /= np.linalg.norm(stretched, axis=0)
    across = np.array([[0.0], [1.0], [0.0]]) * np.ones_like(cosine)
    x, y = np.sqrt(radius) * np.cos(2 * np.pi * turn), np.sqrt(radius) * np.sin(2 * np.pi * turn)
    half = 0.5 * (1 + stretched[2])
    y = (1 - half) * np.sqrt(1 - x**2) + half * y
    z = np.sqrt(np.maximum(0, 1 - x**2 - y**2))
    normal = x * across + y * np.cross(stretched, across, axis=0) + z * stretched
    normal *= np.array([[alpha], [alpha], [1]])
    normal /= np.linalg.norm(normal, axis=0)
    seen = np.clip((normal * toward).sum(0), 0, 1)
    bent = np.sqrt(1 - (1 - seen**2) / IOR**2)
    s, p = (seen - IOR * bent) / (seen + IOR * bent), (IOR * seen - bent) / (IOR * seen + bent)
    down = np.maximum((toward / IOR + normal * (bent - seen / IOR))[2], 1e-6)
    free = 2 / (1 + np.sqrt(1 + alpha**2 * (1 - down**2) / down**2))
    return float(((1 - (s**2 + p**2) / 2) * free).mean())


@pytest.mark.parametrize("alpha", [0.1, 0.4, 1.0])
def test_facets_let_through_what_their_visible_normals_do(alpha: float) -> None:
    assert transmittance(IOR, alpha, "ggx") == pytest.approx(through(alpha), rel=2e-3)


def test_smooth_coats_let_through_what_they_do_not_reflect() -> None:
    for name in ("ggx", "beckmann"):
        found: float = transmittance(IOR, 0.003, name)  # type: ignore[arg-type]
        assert found == pytest.approx(1 - mean_outside(IOR), rel=1e-3)


@pytest.mark.parametrize("nonlinear", [False, True])
def test_a_base_is_as_bright_in_diffuse_light(nonlinear: bool) -> None:
    """Each by its own series of light between coat and base, and by a surface without a coat."""
    loss, alpha, base = Loss(IOR, 0.5, "ggx", nonlinear), 0.5, np.array([0.1, 0.5, 0.9])
    mean = reflectance(IOR, alpha, "ggx", correlated=True)
    inside = counted_inside(IOR, alpha, "ggx")
    keeps = 1 - (1 - mean) / IOR**2

    def sent(color: Any, let_in: float, back: float) -> Any:
        return let_in**2 * color / (IOR**2 * (1 - (color if nonlinear else 1) * back))

    shade = loss.shade(base)
    ours = sent(base, 1 - mean, keeps)
    assert sent(shade, transmittance(IOR, alpha, "ggx"), inside) == pytest.approx(ours)
    assert loss.bare(base) == pytest.approx(ours)
