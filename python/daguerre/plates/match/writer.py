"""Writes camera files of plates: JSON of the schema ``daguerre-plate-camera/0.1``."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from daguerre.camera.camera import Camera
from daguerre.errors import OutputError
from daguerre.files.atomic import write_bytes
from daguerre.sensors import Sensor
from daguerre.sensors.writer import write as write_sensor

from .falloff import Falloff
from .grain import Grain
from .sharpness import Sharpness
from .transfer import Transfer

SCHEMA = "daguerre-plate-camera/0.1"
#: Elements of a symmetric 3 x 3 matrix that are written.
UPPER = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))


def write(
    path: str | os.PathLike[str],
    sensor: Sensor | None,
    members: Callable[[str | None], dict[str, Any]],
) -> None:
    """Writes a camera file, and its sensor file beside it, each atomically.

    Args:
        path: Path of the camera file.
        sensor: Sensor, if it has a file.
        members: Makes the members of the camera file from the name of the sensor's file.
    """
    file = Path(path)
    if not file.name:
        raise OutputError(f"{path or '(empty)'}: wanted the name of a file, got none")
    beside = None
    if sensor is not None:
        beside = file.with_name(f"{file.stem}.sensor.json")
        write_sensor(beside, sensor)
    made = members(None if beside is None else beside.name)
    write_bytes(file, (json.dumps(made, indent=1) + "\n").encode("utf-8"))


def camera_members(camera: Camera) -> dict[str, Any]:
    """Members of the camera."""
    lens = camera.lens
    focus = camera.focus_distance
    return {
        "lens": lens if lens is None or isinstance(lens, str) else lens.name,
        "focal_length_mm": camera.focal_length,
        "zoom_mm": camera.zoom,
        "f_stop": camera.f_stop,
        "exposure_f_stop": camera.exposure_f_stop,
        "focus_m": "inf" if focus is not None and math.isinf(focus) else focus,
        "shutter_s": camera.shutter_time,
        "iso": camera.iso,
        "responsivity": camera.responsivity,
        "sensor_size_mm": list(camera.sensor_size),
        "white_balance": _white(camera.white_balance),
    }


def _white(white: object) -> Any:
    return list(white) if isinstance(white, tuple) else white


def noise_members(noise: Transfer | Grain | None) -> dict[str, Any] | None:
    """Members of the noise."""
    if noise is None:
        return None
    if isinstance(noise, Transfer):
        error = noise.read_noise_error
        return {
            "kind": "raw",
            "gain_dn_per_e": noise.gain,
            "gain_error": noise.gain_error,
            "read_noise_e": noise.read_noise,
            "read_noise_error": error if math.isfinite(error) else None,
            "prnu": noise.prnu,
            "flat_blocks": noise.blocks,
            "darkest_e": noise.darkest,
            "gain_by_channel": [None if math.isnan(g) else g for g in noise.by_channel],
        }
    return {
        "kind": "linear" if noise.linear else "display",
        "levels": _rounded(noise.levels, 6),
        "deviations": _rounded(noise.deviations, 7),
        "spectra": [_rounded(noise.spectra[:, :, i, j], 5) for i, j in UPPER],
        "grain_px": round(noise.size, 3),
    }


def sharpness_members(found: Sharpness | None) -> dict[str, Any] | None:
    """Members of the sharpness."""
    if found is None:
        return None
    return {
        "frequency": found.frequency.tolist(),
        "response": _rounded(found.response, 5),
        "mtf50": found.mtf50 if math.isfinite(found.mtf50) else None,
        "edges": found.edges,
        "blur": {"sigma_px": found.blur.sigma, "sharpen": found.blur.sharpen},
    }


def falloff_members(found: Falloff | None) -> dict[str, Any] | None:
    """Members of the vignetting."""
    if found is None:
        return None
    lens = None if found.lens is None else list(found.lens)
    return {"k": list(found.terms), "lens_k": lens, "rest": found.rest}


def _rounded(values: object, digits: int) -> Any:
    return np.round(np.asarray(values, np.float64), digits).tolist()
