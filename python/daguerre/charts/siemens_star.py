"""Siemens star: spokes with a spatial frequency that grows toward the middle (ISO 12233)."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from daguerre.checks import number, whole
from daguerre.errors import UsageError

from .chart import Chart, Patch, grey

PROFILES = ("sine", "bar")
_PARTS = {
    "sine": 32,
    "bar": 2,
}  # of a cycle; 32 steps: harmonics below the 31st are under 0.5 %


def make(width: float = 0.9, cycles: int = 72, profile: str = "sine", white: float = 0.9) -> Chart:
    """Makes a Siemens star, 0.9 of the chart high; cycles / (2 pi r) per m at radius r.

    Args:
        width: Width of the chart, m.
        cycles: Number of cycles around the star, 4 to 360.
        profile: ``sine``, with light (white / 2) (1 + 0.95 cos), or ``bar``, with white and 0.025
            of it.
        white: Light of the star's white, as a share of the chart's white.
    """
    if profile not in PROFILES:
        raise UsageError(f"chart: profile: wanted sine or bar, got {profile!r}")
    cycles = whole(cycles, "chart: cycles", 4, 360)
    number(white, "chart: white", 0, 1, above=0)
    height = width / 1.5
    radius = 0.45 * height
    parts = _PARTS[profile]
    bounds = 2 * np.pi * np.arange(cycles * parts + 1) / (cycles * parts)
    light = _light(parts) * white
    patches = [
        Patch(
            "star",
            radius * np.array([[0, 0], [np.cos(a), np.sin(a)], [np.cos(b), np.sin(b)]]),
            grey(float(light[i % parts])),
        )
        for i, (a, b) in enumerate(pairwise(bounds))
    ]
    facts = {
        "cycles": cycles,
        "profile": profile,
        "center_m": [0.0, 0.0],
        "radius_m": radius,
        "modulation": modulation(profile),
        "mean": float(light.mean()),
    }
    return Chart("siemens-star", (width, height), tuple(patches), grey(white / 2), facts)


def _light(parts: int) -> np.ndarray:
    """Light of the parts of a cycle: means of the sine over each, so that sums are exact."""
    if parts == 2:
        return np.array([1.0, 0.025])
    middle = 2 * np.pi * (np.arange(parts) + 0.5) / parts
    return np.asarray(0.5 * (1 + 0.95 * np.sinc(1 / parts) * np.cos(middle)))


def modulation(profile: str) -> float:
    """Modulation of the first harmonic of a cycle, over the mean.

    Light in steps of 1 / n cycle that are means of a sine of amplitude m has a first harmonic of
    m sinc(1 / n)^2; a bar has 4 / pi of its contrast.
    """
    parts = _PARTS[profile]
    light = _light(parts)
    first = np.abs(np.sum(light * np.exp(-2j * np.pi * np.arange(parts) / parts))) * 2 / parts
    return float(first * np.sinc(1 / parts) / light.mean())
