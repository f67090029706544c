"""Channels of a sensor: summed on the film, or computed from wavelength bands afterwards.

A frame's channel is the integral of radiance times the sensor's response, scaled so that D65 of
luminance 1 gives 1 (``Sensor.sensitivity`` with other units of radiance). The film sums it sample
by sample, as exactly as XYZ. Bands keep the mean radiance within each. Any sensor's channels are
weighted sums of bands, exact as far as spectra are constant within a band.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from daguerre.color.spectra import rgb_from_xyz
from daguerre.errors import InputError
from daguerre.files.value import BriefRecord
from daguerre.sensors.bands import weights_of_bands

if TYPE_CHECKING:
    from daguerre.sensors.fit import Seeing
    from daguerre.sensors.sensor import Sensor

    from .frame import Frame

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, repr=False)
class Seen(BriefRecord):
    """Planes of a frame, and their weights in the channels of a sensor or a film stock.

    Attributes:
        planes: Planes of the frame, shape (H, W, P).
        channels: Weights of the planes in each channel, shape (C, P).
        source: Kind of the planes: "channels", "bands" or "xyz".
    """

    planes: NDArray[np.float32]
    channels: FloatArray
    source: str


def seen_of(frame: Frame, sensor: Seeing) -> Seen:
    """Chooses the best planes of a frame: channels of this sensor, else bands, else XYZ."""
    from daguerre.sensors.fit import channels_from_xyz

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
    """Metadata of a frame with the channels of a sensor."""
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
