"""Pupils as JSON, so that a pass file contains all that its diffraction needs.

Numbers are exact to the last bit, rasters have 8 bits. Sessions use pupils that went through this
form too, so a merged picture is bit-identical to a picture drawn at once.
"""

from __future__ import annotations

import base64
import math
import zlib
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.analysis.diffraction import PlainPupil, Pupil
from daguerre.analysis.iris import Iris
from daguerre.analysis.lens_pupil import LensPupil

MOST_SIDE = 4096  # px of a raster
MOST_DEGREE = 16

Pupils = list[list[Pupil]]


def to_json(pupils: Sequence[Sequence[Pupil]]) -> dict[str, Any]:
    """Converts rows of pupils that share an iris to JSON."""
    first: Any = pupils[0][0]
    return {"iris": _iris(first.iris), "pupils": [[_pupil(p) for p in row] for row in pupils]}


def from_json(value: Mapping[str, Any]) -> Pupils:
    """Reads pupils from JSON.

    Raises:
        ValueError: The JSON does not describe pupils.
    """
    try:
        iris = _read_iris(value["iris"])
        rows = [[_read_pupil(p, iris) for p in row] for row in value["pupils"]]
    except (KeyError, TypeError, AttributeError, OverflowError, zlib.error) as error:
        raise ValueError(f"pupils: {error}") from None
    if not 1 <= len(rows) <= 9 or any(len(row) != len(rows) for row in rows):
        raise ValueError("pupils: wanted a square of 1 to 9 a side")
    return rows


def _iris(iris: Iris) -> dict[str, Any]:
    out: dict[str, Any] = {
        "blades": iris.blades,
        "rotation": iris.rotation,
        "curvature": iris.curvature,
        "mask_half": iris.mask_half,
    }
    for name in ("picture", "mask"):
        raster = getattr(iris, name)
        out |= {} if raster is None else {name: _packed(raster)}
    return out


def _read_iris(value: Mapping[str, Any]) -> Iris:
    rasters = {name: _unpacked(value[name]) for name in ("picture", "mask") if name in value}
    half = value["mask_half"]
    iris = Iris(
        int(value["blades"]),
        _finite(value["rotation"]),
        _finite(value["curvature"]),
        **rasters,
        mask_half=None if half is None else max(_finite(half), 1e-3),
    )
    _ = iris.shape  # the core checks it
    return iris


def _pupil(pupil: Any) -> dict[str, Any]:
    if isinstance(pupil, PlainPupil):
        return {"f_number": pupil.f_number}
    return {
        "low": list(pupil.low),
        "high": list(pupil.high),
        "to_iris": pupil.to_iris.tolist(),
        "mounts": _packed(pupil.mounts),
    }


def _read_pupil(value: Mapping[str, Any], iris: Iris) -> Pupil:
    if "f_number" in value:
        f_number = _finite(value["f_number"])
        if not 0.1 <= f_number <= 1e4:
            raise ValueError(f"pupils: f-number: wanted 0.1 to 10000, got {f_number:g}")
        return PlainPupil(f_number, iris)
    low, high = (tuple(map(_finite, value[name])) for name in ("low", "high"))
    fit = np.array(value["to_iris"], np.float64)
    square = fit.ndim == 3 and fit.shape[0] == fit.shape[1] and fit.shape[2] == 2
    if not (square and 1 <= len(fit) <= MOST_DEGREE + 1 and np.isfinite(fit).all()):
        raise ValueError(f"pupils: wanted coefficients (D, D, 2), got {fit.shape}")
    if len(low) != 2 or len(high) != 2 or not all(1e-5 < b - a < 2 for a, b in zip(low, high)):  # noqa: B905
        raise ValueError(f"pupils: wanted cosines low < high, got {low}, {high}")
    return LensPupil((low[0], low[1]), (high[0], high[1]), iris, fit, _unpacked(value["mounts"]))


def _finite(value: float) -> float:
    number = float(value)
    if not math.isfinite(number):
        raise ValueError(f"pupils: wanted finite numbers, got {number}")
    return number


def _packed(raster: NDArray[np.float32]) -> dict[str, Any]:
    grey = np.rint(np.clip(raster, 0, 1) * 255).astype(np.uint8)
    words = base64.b64encode(zlib.compress(grey.tobytes(), 9)).decode("ascii")
    return {"size": list(grey.shape), "grey": words}


def _unpacked(value: Mapping[str, Any]) -> NDArray[np.float32]:
    height, width = (int(n) for n in value["size"])
    if not (2 <= height <= MOST_SIDE and 2 <= width <= MOST_SIDE):
        raise ValueError(f"pupils: wanted rasters of 2 to {MOST_SIDE} px a side")
    packed = base64.b64decode(value["grey"], validate=True)
    grey = zlib.decompressobj().decompress(packed, height * width)
    if len(grey) != height * width:
        raise ValueError("pupils: a raster is too short")
    values = np.frombuffer(grey, np.uint8).reshape(height, width)
    return np.asarray(values / np.float32(255), np.float32)
