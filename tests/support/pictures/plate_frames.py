"""Frames for plates: grey wedges, ramps, texture and edges of known light."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from daguerre.frame.frame import Frame
from daguerre.frame.raw import Raw
from daguerre.plates.photograph import RawNumbers
from tests.support.pictures.flats import flat

FACTS: dict[str, Any] = {
    "expTime": 1 / 125,
    "aperture": 5.6,
    "nominalFocalLength": 50.0,
    "sensorOverallDimensions": (36.0, 24.0),
}


def of_light(light: NDArray[Any], lux_s: float, **facts: Any) -> Frame:
    """A grey frame of D65: shares of so many lux seconds, shape (H, W)."""
    frame = flat(lux_s, light.shape, **FACTS | facts)
    frame.rgb = np.asarray(frame.rgb * light[..., None], np.float32)
    assert frame.xyz is not None
    frame.xyz = np.asarray(frame.xyz * light[..., None], np.float32)
    return frame


def wedge(shape: tuple[int, int], steps: int = 12, stops: float = 8.0) -> NDArray[np.float64]:
    """Even steps in stops from left to right, and darkness below."""
    y, x = np.mgrid[: shape[0], : shape[1]] / np.reshape(shape, (2, 1, 1))
    light = 2.0 ** (-stops * np.floor(x * steps) / steps)
    light[y > 0.85] = 0
    return light


def ramp(shape: tuple[int, int]) -> NDArray[np.float64]:
    """A gradient along both sides, from darkness."""
    y, x = np.mgrid[: shape[0], : shape[1]] / np.reshape(shape, (2, 1, 1))
    return np.asarray(x * (0.4 + 0.6 * y))


def partly_textured(shape: tuple[int, int]) -> NDArray[np.float64]:
    """A gradient, and texture over two thirds of it."""
    y, x = np.mgrid[: shape[0], : shape[1]] / np.reshape(shape, (2, 1, 1))
    rough = ndimage.gaussian_filter(np.random.default_rng(0).standard_normal(shape), 1.5)
    return np.asarray(0.8 * x * np.where(np.floor(6 * y) % 3 < 2, np.exp(rough), 1))


def numbers_of(raw: Raw) -> RawNumbers:
    """A raw picture as it comes from a file."""
    sensor = raw.sensor
    black = np.full(len(sensor.channels), float(raw.black_level))
    return RawNumbers(
        raw.mosaic, sensor.pattern.cells, sensor.channels, black, raw.white_level, (0.3127, 0.329)
    )
