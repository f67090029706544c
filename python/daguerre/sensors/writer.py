"""Writes sensor files: JSON of the schema ``daguerre-sensor/0.1``, as ``reader`` reads them."""

from __future__ import annotations

import json
import os
from typing import Any

import numpy as np

from daguerre.files.atomic import write_bytes

from .curve import Curve
from .reader import SCHEMA
from .sensor import Sensor


def write(path: str | os.PathLike[str], sensor: Sensor) -> None:
    """Writes a sensor file atomically, without the serial number.

    Raises:
        OutputError: The file cannot be written.
    """
    write_bytes(path, (json.dumps(members(sensor), indent=1) + "\n").encode("utf-8"))


def members(sensor: Sensor) -> dict[str, Any]:
    """Members of a sensor's file."""
    dark, hot, dual = sensor.dark_current, sensor.hot_pixels, sensor.dual_gain
    made: dict[str, Any] = {
        "schema": SCHEMA,
        "name": sensor.name,
        "make": sensor.make,
        "model": sensor.model,
        "source": sensor.source,
        "licence": sensor.licence,
        "measured": list(sensor.measured),
        "fitted": list(sensor.fitted),
        "assumed": list(sensor.assumed),
        "note": sensor.note or None,
        "pixel_pitch_um": sensor.pixel_pitch,
        "resolution": list(sensor.resolution),
        "size_mm": list(sensor.size),
        "fill_factor": sensor.fill_factor,
        "pattern": sensor.pattern.name,
        "wavelengths_nm": sensor.wavelengths.tolist(),
        "quantum_efficiency": {
            name: row.tolist()
            for name, row in zip(sensor.channels, sensor.quantum_efficiency, strict=True)
        },
        "infrared_cut": _curve(sensor.infrared_cut),
        "cover_glass": _curve(sensor.cover_glass),
        "full_well_e": sensor.full_well,
        "read_noise_e": [list(row) for row in sensor.read_noise],
        "dual_gain": dual and {"iso": dual.iso, "full_well_e": dual.full_well},
        "dark_current": {
            "rate_e_per_s": dark.rate,
            "temperature_c": dark.temperature,
            "doubling_k": dark.doubling,
        },
        "prnu": sensor.prnu,
        "dsnu_e": sensor.dsnu,
        "hot_pixels": {"share": hot.share, "rate_e_per_s": hot.rate},
        "black_level_dn": sensor.black_level,
        "bit_depth": sensor.bit_depth,
        "base_iso": sensor.base_iso,
        "iso_range": list(sensor.iso_range),
        "crosstalk": sensor.crosstalk,
        "low_pass_um": sensor.low_pass,
    }
    return {name: value for name, value in made.items() if value is not None}


def _curve(curve: Curve | None) -> dict[str, Any] | None:
    if curve is None:
        return None
    columns = (np.asarray(values).tolist() for values in (curve.wavelengths, curve.values))
    return dict(zip(("wavelengths_nm", "transmittance"), columns, strict=True))
