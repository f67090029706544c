"""No wavelength, size, index or shape that Python hands to the core ends the process."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from daguerre import _core, analysis, lenses
from daguerre.errors import UsageError

from . import hostile

ROOT = Path(__file__).resolve().parents[2]
#: One case of so many is made in each run of the tests, and all that once ended a process.
FEW = 60


def ends(step: int) -> list[str]:
    """The cases that ended their process, of every so many, and the good ones that were refused."""
    found, begin = [], 0
    while True:
        run = subprocess.run(
            [sys.executable, "-m", "tests.core.hostile", str(begin), str(step)],
            cwd=ROOT, capture_output=True, text=True,
        )  # fmt: skip
        lines = run.stdout.splitlines()
        found += [line for line in lines if line.startswith("REFUSED")]
        if run.returncode == 0 and lines[-1] == "END":
            return found
        assert lines, run.stderr
        number, _, name = lines[-1].partition(" ")
        found.append(f"{number} {name}: exit {run.returncode}: {run.stderr[:500]}")
        begin = int(number) + 1


def test_a_few_hostile_calls() -> None:
    assert ends(FEW) == []


@pytest.mark.slow
def test_all_hostile_calls() -> None:
    assert ends(1) == []


def test_known_cases_are_cases() -> None:
    names = {name for name, _ in hostile.cases()}
    assert names >= hostile.KNOWN


def test_light_of_no_wavelength_has_no_way() -> None:
    """To the core 0 nm is a wavelength like others: glass has no index there, rays beside do."""
    lens = lenses.load(hostile.LENS).prescription
    origins, ahead = np.tile([0.0, 1.0, -50.0], (3, 1)), np.tile([0.0, 0.0, 1.0], (3, 1))
    alone = lens.rays(origins[:1], ahead[:1], np.array([550.0]), True)
    for first, good in ((0, 2), (2, 0)):
        nm = np.full(3, 550.0)
        nm[first] = 0
        points = lens.rays(origins, ahead, nm, True)[0]
        np.testing.assert_array_equal(points[good], alone[0][0])
    assert lens.rays(origins, ahead, np.zeros(3), True)[5].shape == (3,)
    bench = analysis.set_up(lenses.load(hostile.LENS))
    with pytest.raises(UsageError, match="wavelengths of 1 to 1e6 nm, got 0"):
        analysis.chief_rays(bench, [5.0], 0.0)


NOTHING = np.zeros((0, 2))
REFUSED: list[tuple[Callable[[], Any], str]] = [
    (
        lambda: hostile.fit().to_film(np.zeros((3, 3)), np.zeros((2, 3)), np.zeros(3)),
        "directions: wanted 3, got 2",
    ),
    (lambda: hostile.fit().to_film(np.zeros((3, 3)), np.zeros((3, 3)), np.zeros(1)), "wavelengths"),
    (
        lambda: hostile.fit().describe(np.zeros((3, 3)), np.zeros((0, 3))),
        "directions: wanted 3, got 0",
    ),
    (
        lambda: hostile.fit().seconds_a_ray(NOTHING, NOTHING, np.zeros(0), 1),
        "film points: wanted at least one",
    ),
    (lambda: _core.LensFit().evaluate(NOTHING, NOTHING, np.zeros(0)), "segments: wanted 1 to 16"),
    (
        lambda: _core.polynomial_propagation(1.0, 3, [480, 550, 620], [[0] * 4] * 2),
        "wanted one entry, or one for each wavelength, got 2",
    ),
    (lambda: _core.wavelength_nodes(400, 700, 0), "wavelengths: wanted at least one"),
    (lambda: _core.grain_pattern(0, 0, -10, -10, 1.5, 0, 0), "size: wanted 0 to"),
    (
        lambda: _core.Shutter(0.01, _core.OpeningCurve(), "top", 0.001, False, (8, 0)),
        "resolution: wanted at least 1 x 1 px, got 8 x 0",
    ),
    (
        lambda: _core.expose(
            np.ones((6, 8, 3), np.float32),
            _core.Shot(np.ones((2, 3), np.float32), np.full((1, 1), 2, np.uint8)),
        ),
        "cells: wanted channels, got 2",
    ),
]


@pytest.mark.parametrize(("call", "words"), REFUSED)
def test_what_does_not_fit_is_named(call: Callable[[], Any], words: str) -> None:
    with pytest.raises(_core.Error, match=words):
        call()


def test_a_plane_of_no_pixels_has_no_neighbours() -> None:
    assert _core.mean_of_next_colour(np.zeros((6, 0), np.float32), 2).size == 0
