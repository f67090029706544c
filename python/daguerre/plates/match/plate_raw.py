"""Makes the raw picture of a matched sensor from a raw plate, for compositing."""

from __future__ import annotations

import numpy as np

from daguerre.errors import InputError
from daguerre.frame.raw import Raw
from daguerre.plates.photograph import Photograph

from .plate_camera import PlateCamera


def raw_of(photograph: Photograph, plate: PlateCamera) -> Raw:
    """Returns the values of a raw photograph, upright, with its matched sensor.

    Args:
        photograph: Plate, from ``plates.files.read``.
        plate: Matched camera of the plate.

    Raises:
        InputError: The photograph is not raw, or has another size than the matched photograph.
    """
    raw, sensor = photograph.raw, plate.sensor
    if raw is None or sensor is None:
        raise InputError(f"{photograph.path}: wanted a raw plate, got a {photograph.kind} one")
    if photograph.size != plate.resolution:
        raise InputError(
            f"{photograph.path}: wanted {plate.resolution[0]}x{plate.resolution[1]} px, the size "
            f"of the matched plate, got {photograph.size[0]}x{photograph.size[1]}"
        )
    iso = float(plate.camera.iso)
    return Raw(
        mosaic=raw.mosaic,
        sensor=sensor,
        iso=iso,
        black_level=sensor.black_level,
        white_level=sensor.white_level(iso),
        gain=sensor.gain(iso),
        neutral=np.asarray(sensor.neutral(raw.white_balance)),
        white_balance=raw.white_balance,
        metadata=dict(photograph.facts),
    )
