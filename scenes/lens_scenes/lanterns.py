"""Strings of lanterns across the arcade and along it, and lamps on the house behind."""

from __future__ import annotations

import numpy as np

from kit import shapes
from lens_scenes.hall import END, HALF_WIDTH
from night.stage import PALETTE, Stage


def add_lanterns(stage: Stage) -> None:
    """Lanterns are larger the farther they hang, so that near and far ones look alike."""
    rng = np.random.default_rng(23)
    for z in (-3.2, -5.8, -8.4, -12.3, -17.5, -24.0, -32.0):
        _add_string(stage, rng, z)
    for _ in range(90):
        x, y = rng.normal(0, 6.0), rng.uniform(-1.3, 1.0) + abs(rng.normal(0, 3.0))
        color = PALETTE[rng.choice(6, p=[0.34, 0.24, 0.16, 0.14, 0.07, 0.05])]
        radius = rng.uniform(0.10, 0.20)
        stage.lamp([x, y, END - 1.2 + rng.random()], radius, color, float(rng.choice([2, 4, 7])))


def _add_string(stage: Stage, rng: np.random.Generator, z: float) -> None:
    """A wire from column to column, with a lantern every so often on a thread of its own."""
    count = 11
    s = np.linspace(-1, 1, 6 * count + 1)
    path = np.stack([HALF_WIDTH * s, 1.55 - 0.45 * (1 - s**2), z + 0 * s], 1)
    stage.put("wire", shapes.tube(path, 0.0005 * -z, 5), stage.wire)
    radius = 0.0065 * -z + 0.004
    for k in range(count):
        top = path[6 * k + 3]
        drop = rng.uniform(0.05, 1.9)
        color = PALETTE[[0, 1, 0, 2, 0, 3][rng.integers(6)]]
        thread = np.array([top, top - (0, drop, 0)])
        stage.put("thread", shapes.tube(thread, 0.0002 * -z, 4), stage.wire)
        stage.lamp(thread[1] - (0, radius, 0), radius, color, float(rng.choice([4, 6, 10])))
