"""Figures of the page of plates: shots of one light differ by their noise, and by nothing else."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg

GALLERY = Path(__file__).resolve().parents[2] / "script" / "docs" / "gallery"
SIZE = (128, 192)


@pytest.fixture
def program(monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.syspath_prepend(str(GALLERY))
    import plate_difference

    yield plate_difference
    for name in ("plate_difference", "plate_layers"):
        sys.modules.pop(name)


def shot(seed: int, times: float = 1.0) -> Any:
    """A grey ramp, as a sensor has it."""
    ramp = np.linspace(0.02, 0.2, SIZE[1], dtype=np.float32) * np.float32(times)
    rgb = np.broadcast_to(ramp[None, :, None], (*SIZE, 3)).copy()
    facts = {"expTime": 1 / 50, "aperture": 4.0, "tStop": 4.0}
    return dg.Frame(rgb=50 * rgb, metadata=facts).expose("sony-a7r-ii", iso=6400, seed=seed)


def test_two_shots_of_one_light_differ_by_noise_alone(program: Any) -> None:
    whole = np.ones(SIZE, bool)
    found = program.figures(shot(1), shot(2), {"all": whole})["all"]
    assert found["share"] == 1
    assert found["light"] == pytest.approx(1, abs=0.003)
    assert found["mean"] == pytest.approx(0, abs=0.02)
    assert found["rms"] == pytest.approx(1, abs=0.02)
    assert found["rms_of_squares"] == pytest.approx(1, abs=0.12)


def test_squares_show_an_error_that_photosites_hide(program: Any) -> None:
    left = np.zeros(SIZE, bool)
    left[:, :96] = True
    found = program.figures(shot(1, 1.04), shot(2), {"left": left, "right": ~left})
    for part in found.values():
        assert part["share"] == 0.5
        assert part["light"] == pytest.approx(1.04, abs=0.005)
        assert part["rms"] < 1.2
        assert part["rms_of_squares"] > 1.5
    assert found["left"]["mean"] < found["right"]["mean"]  # few electrons have more noise


def test_what_is_clipped_does_not_count(program: Any) -> None:
    bright, whole = shot(1, 4.0), np.ones(SIZE, bool)
    assert program.clipped(bright).mean() > 0.5
    found = program.figures(bright, shot(2, 4.0), {"all": whole})["all"]
    assert found["share"] < 0.5
    assert found["light"] == pytest.approx(1, abs=0.01)
