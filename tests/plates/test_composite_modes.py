"""Objects in a plate are as bright as the exposure mode of their frame shows them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from daguerre.color import srgb
from daguerre.exposure.lux_seconds import display_gain
from daguerre.frame.picture import Picture
from daguerre.plates.composite.composite import composite
from daguerre.plates.composite.in_raw import composite_raw
from tests.support.pictures.plate_frames import of_light

SHAPE = (16, 24)
LUX_S, ISO = 0.4 * 10 / 0.18 / 400, 400.0
#: Facts of a frame, and the display-linear value of its value of 1.
MODES: dict[str, tuple[dict[str, Any], float]] = {
    "light": ({"exposure": "light"}, 1.0),
    "light, +1 EV": ({"exposure": "light", "exposure_compensation": 1.0}, 2.0),
    "manual": ({"exposure": "manual"}, 0.4),
    "manual, -1 EV": ({"exposure": "manual", "exposure_compensation": -1.0}, 0.2),
    "none": ({}, 0.4),
}


@pytest.mark.parametrize("name", MODES)
def test_a_developed_plate(name: str, tmp_path: Path) -> None:
    facts, gain = MODES[name]
    Picture(np.full((*SHAPE, 3), 0.5, np.float32), "srgb").save(tmp_path / "plate.png")
    frame = of_light(np.full(SHAPE, 0.25), LUX_S, isoSpeed=ISO, **facts)
    value = float(frame.rgb.mean())
    half = replace(frame, alpha=np.full(SHAPE, 0.5, np.float32), channels=None)
    made = composite(tmp_path / "plate.png", half)
    assert isinstance(made, Picture)
    wanted = 0.5 * float(srgb.to_linear(np.array(128 / 255))) + display_gain(half.metadata) * value
    assert srgb.to_linear(made.pixels).mean() == pytest.approx(wanted, rel=1e-3)
    assert display_gain(half.metadata) == pytest.approx(gain, rel=0.01)


@pytest.mark.parametrize("name", MODES)
def test_a_raw_plate_gets_the_electrons_of_a_shot(name: str) -> None:
    facts, gain = MODES[name]
    frame = of_light(np.full(SHAPE, 0.25), LUX_S, isoSpeed=ISO, **facts)
    alone = replace(frame, alpha=np.ones(SHAPE, np.float32), channels=None)
    shot = frame.expose("ideal", ISO, seed=1)
    dark = of_light(np.zeros(SHAPE), LUX_S, isoSpeed=ISO, **facts).expose("ideal", ISO, seed=2)
    made = composite_raw(dark, alone, seed=3)
    assert made.electrons().mean() == pytest.approx(shot.electrons().mean(), rel=0.03)
    plain = of_light(np.full(SHAPE, 0.25), LUX_S, isoSpeed=ISO, exposure="light")
    share = shot.electrons().mean() / plain.expose("ideal", ISO, seed=1).electrons().mean()
    assert share == pytest.approx(gain, rel=0.03)
