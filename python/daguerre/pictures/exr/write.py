"""Writes frames as OpenEXR, with channels and attributes of the standard and of Daguerre.

Standard attributes follow OpenEXR's "Standard Optional Attributes"; others are ``daguerre:*``.
"""

from __future__ import annotations

import itertools
import json
import math
import os
from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import OutputError
from daguerre.files.atomic import atomic_path
from daguerre.frame import cryptomatte
from daguerre.frame.world import relative

from . import color_space
from .whole import WholePart, planes_of, write_whole

if TYPE_CHECKING:
    from daguerre.frame.frame import Frame

FLOATS = (
    "isoSpeed", "expTime", "aperture", "tStop", "focus", "nominalFocalLength",
    "effectiveFocalLength", "pinholeFocalLength", "entrancePupilOffset", "shutterAngle",
    "whiteLuminance", "pixelAspectRatio",
)  # fmt: skip
STRINGS = ("lensMake", "lensModel", "lensSerialNumber", "cameraMake", "cameraModel", "capDate")
VECTORS = (
    "sensorPhotositePitch", "sensorOverallDimensions", "sensorCenterOffset", "adoptedNeutral",
)  # fmt: skip
MATRICES = ("worldToCamera", "worldToNDC")
RATIONALS = ("captureRate",)
OWN_NUMBERS = (
    "samples", "samples_min", "samples_max", "noise", "denoised_noise", "seed", "h0",
    "luminance_exposure", "exposure_compensation", "time", "bad_samples", "motion_missing",
    "gt_rays", "bands",
)  # fmt: skip
OWN_STRINGS = (
    "version", "scene_hash", "filter", "denoised", "noise_of", "gt_time", "gt_lens",
    "light_paths", "flare", "scatter", "exposure", "metering",
    "diffraction", "sensor", "sensor_hash", "sensor_from", "overscan", "background",
    "colorspace",
)  # fmt: skip
OWN_JSON = ("bad_sample_places", "sensor_channels", "white_balance", "plate", "world_origin")

Channels = Mapping[str, NDArray[np.float32] | NDArray[np.uint32]]


class ExrPart(NamedTuple):
    """A part of a file."""

    name: str
    attributes: dict[str, Any]
    channels: Channels


def attributes(metadata: Mapping[str, Any]) -> dict[str, Any]:
    """Converts metadata to header attributes with the types of the standard.

    Args:
        metadata: Metadata by name, with the standard's units and frames (matrices act on row
            vectors). Unknown names and None are left out. ``colorspace`` names the space of
            colours; default: linear Rec.709.
    """
    found: dict[str, Any] = {
        **color_space.space_attributes(color_space.space_of(metadata)),
        "software": f"daguerre {metadata.get('version', '')}".strip(),
    }
    known = {key: value for key, value in metadata.items() if value is not None}
    found |= {key: float(known[key]) for key in FLOATS if key in known}
    found |= {key: str(known[key]) for key in STRINGS if known.get(key)}
    found |= {key: _pair(known[key]) for key in VECTORS if key in known}
    found |= {key: np.ascontiguousarray(known[key], np.float32) for key in MATRICES if key in known}
    found |= {
        key: _rational(known[key]) for key in RATIONALS if key in known and _positive(known[key])
    }
    found |= {f"daguerre:{key}": _number(known[key]) for key in OWN_NUMBERS if key in known}
    found |= {f"daguerre:{key}": str(known[key]) for key in OWN_STRINGS if key in known}
    found |= {
        f"daguerre:{key}": json.dumps(known[key], default=jsonable)
        for key in OWN_JSON
        if known.get(key)
    }
    if "camera" in known:
        camera = without_infinity(known["camera"])
        found["daguerre:camera"] = json.dumps(camera, sort_keys=True, default=jsonable)
    return found


def channels(frame: Frame) -> dict[str, NDArray[np.float32] | NDArray[np.uint32]]:
    """Returns all channels of a frame, by their names in the file.

    These are R G B A, AOVs, flare.R/G/B, catcher.R/G/B and catcher_ratio.R/G/B, variance.R/G/B,
    samples.Y, mattes (CryptoObject00.R), sensor channels (sensor.R; catcher_sensor.R,
    catcher_ratio_sensor.R) and wavelength bands (bands.0380-0405, nm). An array of three planes is
    three channels, which saves copies. Light is in the space that the
    metadata name (:mod:`.color_space`).
    """
    planes: dict[str, NDArray[np.float32] | NDArray[np.uint32]] = {"RGB": frame.rgb}
    planes["A"] = frame.alpha
    planes |= relative(frame.aovs, frame.metadata.get("world_origin"))
    if frame.channels is not None:
        names = frame.metadata["sensor_channels"]
        planes |= _per_channel("sensor", frame.channels, names)
    if frame.bands is not None:
        names = band_names(frame.bands.shape[2])
        planes |= {f"bands.{name}": frame.bands[..., i] for i, name in enumerate(names)}
    if frame.flare is not None:
        planes["flare"] = frame.flare
    if frame.catcher is not None and frame.catcher_ratio is not None:
        planes |= {"catcher": frame.catcher, "catcher_ratio": frame.catcher_ratio}
    if frame.catcher_channels is not None and frame.catcher_ratio_channels is not None:
        names = frame.metadata["sensor_channels"]
        planes |= _per_channel("catcher_sensor", frame.catcher_channels, names)
        planes |= _per_channel("catcher_ratio_sensor", frame.catcher_ratio_channels, names)
    planes |= cryptomatte.planes(frame.cryptomatte)
    if frame.variance is not None:
        planes["variance"] = frame.variance
    if frame.samples is not None:
        planes["samples.Y"] = frame.samples.astype(np.float32)
    planes = color_space.in_space(planes, color_space.space_of(frame.metadata))
    return {name: _plane(name, plane) for name, plane in planes.items()}


def _per_channel(
    layer: str, values: NDArray[np.float32], names: list[str]
) -> dict[str, NDArray[np.float32]]:
    return {f"{layer}.{name}": values[..., i] for i, name in enumerate(names)}


def band_names(count: int) -> list[str]:
    """First and last wavelength of each band in whole nm, such as 0380-0405."""
    from daguerre.color.spectra import FIRST_NM, LAST_NM

    edges = np.rint(np.linspace(FIRST_NM, LAST_NM, count + 1)).astype(int).tolist()
    return [f"{a:04d}-{b:04d}" for a, b in itertools.pairwise(edges)]


def header(frame: Frame) -> dict[str, Any]:
    """Header attributes of a frame, with the names of its mattes."""
    return attributes(frame.metadata) | cryptomatte.attributes(frame.cryptomatte)


def write_exr(path: str | os.PathLike[str], frame: Frame) -> None:
    """Writes a frame atomically as one multichannel part, or as an ACES image container."""
    facts, planes = header(frame), channels(frame)
    if color_space.is_container(frame):
        facts |= color_space.container_attributes()
        planes = color_space.container_planes(planes)
    write_parts(path, [ExrPart("beauty", facts, planes)], frame)


def as_exr(path: str | os.PathLike[str], frame: Frame, tone: str = "srgb") -> None:
    """Writes all data of a frame; ``tone`` has no effect on linear files."""
    write_exr(path, frame)


def write_parts(path: str | os.PathLike[str], parts: list[ExrPart], frame: Frame) -> None:
    """Writes parts that share the windows of ``frame``.

    Raises:
        OutputError: The file cannot be written; no partial file is left.
    """
    _write(path, parts, _windows(frame.metadata, frame.rgb.shape))


def write_planes(
    path: str | os.PathLike[str],
    header: Mapping[str, Any],
    planes: Channels,
    metadata: Mapping[str, Any],
) -> None:
    """Writes channels that are not a picture; ``metadata`` gives resolution and crop.

    Raises:
        OutputError: The file cannot be written; no partial file is left.
    """
    windows = _windows(metadata, next(iter(planes.values())).shape)
    _write(path, [ExrPart("map", dict(header), planes)], windows)


def _write(path: str | os.PathLike[str], parts: list[ExrPart], windows: dict[str, Any]) -> None:
    whole = [
        WholePart(part.name, windows | part.attributes, planes_of(part.channels)) for part in parts
    ]
    with atomic_path(path) as temp:
        try:
            write_whole(temp, whole)
        except OSError as error:
            raise OutputError(f"{path}: cannot write: {error.strerror or error}") from error


def without_infinity(value: object) -> Any:
    """Replaces infinity, which JSON lacks, by the text "inf", which float() reads."""
    if isinstance(value, dict):
        return {key: without_infinity(inner) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return [without_infinity(inner) for inner in value]
    return str(value) if isinstance(value, float) and math.isinf(value) else value


def jsonable(value: object) -> Any:
    """Converts values that ``json`` does not know: arrays, numpy numbers, paths."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    return str(value) if isinstance(value, Path | Fraction) else repr(value)


def _windows(metadata: Mapping[str, Any], shape: tuple[int, ...]) -> dict[str, Any]:
    """Data and display window: a crop keeps its place; overscan extends outside of the display."""
    height, width = shape[:2]
    full_width, full_height = metadata.get("resolution") or (width, height)
    x0, y0 = (metadata.get("crop") or (0, 0))[:2]
    corner = np.array([x0, y0], np.int32)
    size = np.array([width - 1, height - 1], np.int32)
    full = np.array([full_width - 1, full_height - 1], np.int32)
    return {
        "dataWindow": (corner, corner + size),
        "displayWindow": (np.zeros(2, np.int32), full),
    }


def _plane(name: str, plane: NDArray[Any]) -> NDArray[np.float32] | NDArray[np.uint32]:
    if name.endswith("_id"):
        return np.ascontiguousarray(plane, np.uint32)
    return np.ascontiguousarray(plane, np.float32)


def _pair(value: object) -> NDArray[np.float32]:
    """Converts to a v2f; one number is used for both axes."""
    return np.ascontiguousarray(np.broadcast_to(np.asarray(value, np.float32), (2,)))


def _positive(value: Any) -> bool:
    number = float(_rational(value)) if isinstance(value, tuple | list) else float(value)
    return math.isfinite(number) and number > 0


def _rational(value: Any) -> Fraction:
    """Converts to a short fraction for ``rational``: 23.976... becomes 24000/1001."""
    if isinstance(value, tuple | list):
        return Fraction(int(value[0]), int(value[1]))
    fraction = Fraction(value)
    near = fraction.limit_denominator(1001)
    return near if abs(near - fraction) <= fraction / 10**6 else fraction.limit_denominator(10**6)


def _number(value: Any) -> int | float | str:
    """Converts a number; integers beyond 32 bits (seeds) become text, as EXR has only 32 bits."""
    if isinstance(value, int | np.integer):
        return int(value) if -(2**31) <= int(value) < 2**31 else str(int(value))
    return float(value)
