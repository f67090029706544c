"""Bins Quad-Bayer mosaics to Bayer, which raw converters support (also X-Trans and mono)."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

import numpy as np

from daguerre.argument_checks import guarded
from daguerre.errors import InputError

if TYPE_CHECKING:
    from daguerre.frame.raw import Raw
    from daguerre.sensors import Sensor


def is_mono(raw: Raw) -> bool:
    """Whether a raw picture is monochrome."""
    return len(raw.sensor.channels) == 1


@guarded
def bayer_of(raw: Raw) -> Raw:
    """Bins a Quad-Bayer picture as cameras do; returns others unchanged.

    Four photosites of one colour become one of twice the pitch. Their values are added without
    loss if 16 bits hold the sum.
    """
    if not raw.sensor.pattern.name.startswith("quad-"):
        return raw
    height, width = (side // 4 * 4 for side in raw.mosaic.shape)
    if not height or not width:
        rows, columns = raw.mosaic.shape
        raise InputError(
            f"raw: mosaic: wanted at least 4 x 4 photosites for Quad-Bayer, got {columns} x {rows}"
        )
    four = raw.mosaic[:height, :width].reshape(height // 2, 2, width // 2, 2)
    numbers = four.sum(axis=(1, 3), dtype=np.uint32)
    shift = max(raw.sensor.bit_depth + 2 - 16, 0)
    clipped = raw.saturated[:height, :width].reshape(four.shape).any(axis=(1, 3))
    return dataclasses.replace(
        raw,
        mosaic=(numbers >> shift).astype(np.uint16),
        sensor=_binned_sensor(raw, shift),
        black_level=4 * raw.black_level >> shift,
        white_level=4 * raw.white_level >> shift,
        gain=raw.gain / 2**shift,
        clipped=np.asarray(clipped, np.bool_),
        luminance_exposure=None,
    )


def _binned_sensor(raw: Raw, shift: int) -> Sensor:
    """Sensor of the binned picture: twice the pitch, and the noise of four photosites."""
    sensor = raw.sensor
    columns, rows = sensor.resolution
    return sensor.with_(
        pattern=sensor.pattern.name.removeprefix("quad-"),
        pixel_pitch=2 * sensor.pixel_pitch,
        resolution=(max(columns // 2, 1), max(rows // 2, 1)),
        bit_depth=min(sensor.bit_depth + 2, 16),
        black_level=4 * sensor.black_level >> shift,
        full_well=4 * sensor.full_well,
        read_noise=tuple((iso, 2 * noise) for iso, noise in sensor.read_noise),
        dual_gain=None,
    )
