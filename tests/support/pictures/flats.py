"""Frames of even light with a known exposure, for tests of sensors."""

from __future__ import annotations

from typing import Any

import numpy as np

from daguerre.color import illuminants
from daguerre.frame.frame import Frame
from daguerre.sensors import Sensor, load


def flat(lux_s: float, shape: tuple[int, int] = (64, 64), **facts: Any) -> Frame:
    """D65 of so many lux seconds everywhere."""
    white = illuminants.observer().T @ illuminants.d65()
    xyz = np.broadcast_to(white.astype(np.float32), (*shape, 3))
    metadata = {"luminance_exposure": lux_s, "expTime": 0.01, "aperture": 8.0} | facts
    return Frame(rgb=np.ones((*shape, 3), np.float32), xyz=np.array(xyz), metadata=metadata)


def lux_s_for(sensor: Sensor, electrons: float, channel: int = 0) -> float:
    """Exposure that makes so many electrons."""
    return electrons / float(sensor.electrons_per_lux_s()[channel])


def mono(**values: Any) -> Sensor:
    """A monochrome sensor of quantum efficiency 0.6, 12 bits and a well of 10000 e-."""
    given: dict[str, Any] = {
        **{"full_well": 1e4, "bit_depth": 12, "black_level": 100, "iso_range": (1, 1e6)},
        "quantum_efficiency": np.full((1, 401), 0.6),
    }
    sensor = load("ideal-mono").with_(**given | values)
    # The ISO at which the converter clips where the well does.
    return sensor.with_(base_iso=sensor.saturation_iso)
