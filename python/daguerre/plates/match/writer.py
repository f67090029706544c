"""Writes camera files of plates: JSON of the schema ``daguerre-plate-camera/0.1``."""

from __future__ import annotations

import json
import math
import os
from pathlib import Path
from typing import Any

import numpy as np

from daguerre.errors import OutputError
from daguerre.files.atomic import write_bytes
from daguerre.sensors.writer import write as write_sensor

from .grain import Grain
from .plate_camera import PlateCamera
from .transfer import Transfer

SCHEMA = "daguerre-plate-camera/0.1"
#: Elements of a symmetric 3 x 3 matrix that are written.
UPPER = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))


def write(path: str | os.PathLike[str], plate: PlateCamera) -> None:
    """Writes a camera file, and its sensor file beside it, each atomically."""
    file = Path(path)
    if not file.name:
        raise OutputError(f"{path or '(empty)'}: wanted the name of a file, got none")
    beside = None
    if plate.sensor is not None:
        beside = file.with_name(f"{file.stem}.sensor.json")
        write_sensor(beside, plate.sensor)
    made = members(plate, None if beside is None else beside.name)
    write_bytes(file, (json.dumps(made, indent=1) + "\n").encode("utf-8"))


def members(plate: PlateCamera, sensor: str | None) -> dict[str, Any]:
    """Members of the file; ``sensor``: name of the sensor's own."""
    return {
        "schema": SCHEMA,
        "plate": {
            "file": plate.plate,
            "sha256": plate.sha256,
            "kind": plate.kind,
            "resolution": list(plate.resolution),
            "focal_length_mm": plate.focal_length,
        },
        "camera": _camera(plate),
        "sensor": sensor,
        "noise": _noise(plate.noise),
        "sharpness": _sharpness(plate),
        "vignetting": _vignetting(plate),
        "development": {"look": plate.look},
        "notes": list(plate.notes),
    }


def _camera(plate: PlateCamera) -> dict[str, Any]:
    camera = plate.camera
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


def _white(white: Any) -> Any:
    return list(white) if isinstance(white, tuple) else white


def _noise(noise: Transfer | Grain | None) -> dict[str, Any] | None:
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


def _sharpness(plate: PlateCamera) -> dict[str, Any] | None:
    found = plate.sharpness
    if found is None:
        return None
    return {
        "frequency": found.frequency.tolist(),
        "response": _rounded(found.response, 5),
        "mtf50": found.mtf50 if math.isfinite(found.mtf50) else None,
        "edges": found.edges,
        "blur": {"sigma_px": found.blur.sigma, "sharpen": found.blur.sharpen},
    }


def _vignetting(plate: PlateCamera) -> dict[str, Any] | None:
    found = plate.falloff
    if found is None:
        return None
    lens = None if found.lens is None else list(found.lens)
    return {"k": list(found.terms), "lens_k": lens, "rest": found.rest}


def _rounded(values: Any, digits: int) -> Any:
    return np.round(np.asarray(values, np.float64), digits).tolist()
