"""Channels of a sensor on the film, and those that bands of wavelengths make afterwards.

A frame's channel is the integral of radiance times the sensor's response, of which D65 of luminance
1 makes 1 (``Sensor.sensitivity`` with other units of radiance). The film sums it sample by sample,
as exactly as XYZ. Bands keep the mean radiance within each: any sensor's channels are weighted sums
of them, right for the spectra that renders are made of, as far as these are even within a band.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .checks import whole
from .colour import (
    FINE,
    FIRST_NM,
    LAST_NM,
    band_weights,
    fine_wavelengths,
    rgb_from_xyz,
    unit_d65,
)
from .errors import InputError

if TYPE_CHECKING:
    from .frame import Frame
    from .sensors.fit import Seeing
    from .sensors.sensor import Sensor

FloatArray = NDArray[np.float64]
LEAST_BANDS, MOST_BANDS = 3, 64
MOST_CHANNELS = 4


def check_bands(value: Any, where: str = "bands") -> int:
    """A number of bands; 0: none."""
    if value in (0, None):
        return 0
    return whole(value, where, LEAST_BANDS, MOST_BANDS, f"{LEAST_BANDS} .. {MOST_BANDS}")


def responses(sensor: Seeing) -> FloatArray:
    """Weights of light on the film: at 380, 381 .. 780 nm, per nm, shape (C, 401).

    Raises:
        InputError: There are more channels than a film holds, or one that sees nothing.
    """
    nm = np.arange(FIRST_NM, LAST_NM + 1)
    with np.errstate(invalid="ignore", divide="ignore"):
        rows = sensor.sensitivity(nm)
    if len(rows) > MOST_CHANNELS:
        raise InputError(f"sensor: channels: wanted at most {MOST_CHANNELS}, got {len(rows)}")
    fine = fine_wavelengths(1)[0]
    white = unit_d65(fine) * ((LAST_NM - FIRST_NM) / FINE)
    totals = np.array([np.interp(fine, nm, row) @ white for row in rows])
    if not (totals > 0).all():
        raise InputError(
            f"sensor: channel {np.flatnonzero(~(totals > 0))[0]}: wanted some sensitivity between "
            f"{FIRST_NM:g} and {LAST_NM:g} nm, got none"
        )
    return np.ascontiguousarray(rows / totals[:, None])


def weights_of_bands(sensor: Seeing, bands: int) -> FloatArray:
    """Channels of unit mean radiance in each band, shape (bands, C)."""
    nm = np.arange(FIRST_NM, LAST_NM + 1)
    rows = responses(sensor)
    return band_weights(bands, lambda at: np.stack([np.interp(at, nm, r) for r in rows], axis=1))


def channels_from_bands(bands: NDArray[np.float32], sensor: Seeing) -> NDArray[np.float32]:
    """Converts a frame's bands to a sensor's channels, as if it had been named before the render.

    Args:
        bands: Bands of a frame, shape (H, W, N).
        sensor: Sensor whose channels are wanted.

    Returns:
        Channels, shape (H, W, C): D65 of luminance 1 is 1 in each.
    """
    return np.asarray(bands @ weights_of_bands(sensor, bands.shape[2]).astype(np.float32))


@dataclass(frozen=True)
class Seen:
    """A frame as a sensor or a film stock sees it.

    Attributes:
        planes: Planes of the frame, shape (H, W, P).
        channels: Weights of the planes in each channel, shape (C, P).
        source: Kind of the planes: "channels", "bands" or "xyz".
    """

    planes: NDArray[np.float32]
    channels: FloatArray
    source: str


def seen_of(frame: Frame, sensor: Seeing) -> Seen:
    """The best planes that a frame has: channels of this very sensor, else bands, else XYZ."""
    from .sensors.fit import channels_from_xyz

    if frame.channels is not None and frame.metadata.get("sensor_hash") == sensor.hash:
        wanted = (*frame.rgb.shape[:2], len(sensor.channels))
        if frame.channels.shape != wanted:
            raise InputError(f"frame: channels: wanted shape {wanted}, got {frame.channels.shape}")
        return Seen(frame.channels, np.eye(len(sensor.channels)), "channels")
    if frame.bands is not None:
        return Seen(frame.bands, weights_of_bands(sensor, frame.bands.shape[2]).T, "bands")
    from_xyz = channels_from_xyz(sensor)
    if frame.xyz is not None:
        return Seen(frame.xyz, from_xyz, "xyz")
    return Seen(frame.rgb, from_xyz @ np.linalg.inv(rgb_from_xyz()), "xyz")


def sensor_metadata(sensor: Sensor | None) -> dict[str, Any]:
    """Facts of a frame whose channels are those of a sensor."""
    if sensor is None:
        return {}
    return {
        "sensor": sensor.name,
        "sensor_hash": sensor.hash,
        "sensor_channels": list(sensor.channels),
        "sensor_from": "channels",
        "cameraMake": sensor.make,
        "cameraModel": sensor.model,
    }
