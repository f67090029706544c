"""Reads OpenEXR files as frames: Daguerre's own completely, others as far as they go.

The counterpart of :mod:`daguerre.io.exr.write`. Colours of other primaries become Rec.709, with
white adapted, so that (1, 1, 1) stays white.
"""

from __future__ import annotations

import math
import os
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.color.adaptation import adaptation_of_xyz
from daguerre.color.spectra import rgb_from_xyz, xyz_of
from daguerre.doors import guarded
from daguerre.errors import InputError
from daguerre.files.json_item import clean
from daguerre.frame.cryptomatte import taken
from daguerre.frame.frame import Frame

from . import write as exr
from .facts import read_facts
from .parts import Planes
from .reader import ExrReader


@guarded
def load_frame(path: str | os.PathLike[str]) -> Frame:
    """Reads a picture (.exr) of Daguerre or another program, with all channels and metadata.

    If a file has several parts, it reads the first.

    Args:
        path: An ``.exr`` file.

    Returns:
        The frame. ``xyz`` is computed from ``rgb``; other channels are in ``aovs``, by name. Half
        floats become floats.

    Raises:
        InputError: The file cannot be read, or has neither R, G, B nor Y.
    """
    with ExrReader(path) as reader:
        planes = reader.rows(0, reader.height)
        facts = reader.facts
        metadata = read_facts(facts)
        metadata |= _place(reader)
    planes = {name: _writable(plane) for name, plane in planes.items()}
    rgb = _rgb(planes, path)
    if (matrix := _to_rec709(reader.facts.get("chromaticities"))) is not None:
        rgb = np.asarray(rgb @ matrix.T.astype(np.float32))
    names = metadata.get("sensor_channels") or []
    bands = sorted(name for name in planes if name.startswith("bands."))
    samples = planes.pop("samples.Y", None)
    frame = Frame(
        rgb=rgb,
        xyz=xyz_of(rgb),
        alpha=planes.pop("A", np.empty((0, 0), np.float32)),
        variance=_group(planes, [f"variance.{c}" for c in "RGB"]),
        samples=None if samples is None else np.rint(samples).astype(np.uint32),
        metadata=metadata,
        flare=_group(planes, [f"flare.{c}" for c in "RGB"]),
        channels=_group(planes, [f"sensor.{name}" for name in names]),
        bands=_group(planes, bands),
        catcher=_group(planes, [f"catcher.{c}" for c in "RGB"]),
        catcher_ratio=_group(planes, [f"catcher_ratio.{c}" for c in "RGB"]),
        catcher_channels=_group(planes, [f"catcher_sensor.{name}" for name in names]),
        catcher_ratio_channels=_group(planes, [f"catcher_ratio_sensor.{name}" for name in names]),
        cryptomatte=taken(planes, facts, str(path)),
    )
    frame.aovs = planes
    count = metadata.get("bad_samples", 0)
    places = metadata.get("bad_sample_places", [])
    frame.bad_samples = (
        int(count) if math.isfinite(count) else 0,
        [(x, y, sample) for x, y, sample in places],
    )
    return frame


def _place(reader: ExrReader) -> dict[str, Any]:
    """Size of the whole picture, and the box in the file; overscan lies outside of the picture."""
    (x, y), (left, top) = reader.corner, reader.full_corner
    x0, y0 = x - left, y - top
    width, height = reader.full_size
    crop = (x0, y0, x0 + reader.width, y0 + reader.height)
    return {"resolution": (width, height), "crop": crop}


def _writable(plane: NDArray[Any]) -> NDArray[Any]:
    return plane if plane.dtype == np.uint32 else plane.astype(np.float32, copy=False)


def _group(planes: Planes, names: list[str]) -> NDArray[np.float32] | None:
    """Removes channels from ``planes`` and stacks them; None: no names, or one is missing."""
    if not names or not all(name in planes for name in names):
        return None
    return np.stack([planes.pop(name) for name in names], axis=2)


def _rgb(planes: Planes, path: str | os.PathLike[str]) -> NDArray[np.float32]:
    rgb = _group(planes, ["R", "G", "B"])
    if rgb is not None:
        return rgb.astype(np.float32, copy=False)
    if "Y" in planes:
        return np.repeat(planes.pop("Y")[:, :, None], 3, axis=2).astype(np.float32, copy=False)
    names = ", ".join(clean(name) for name in list(planes)[:12])
    raise InputError(f"{path}: channels: wanted R, G, B or Y, got {names}")


def _to_rec709(chromaticities: Any) -> NDArray[np.float64] | None:
    """Matrix to Rec.709 from other primaries and white; None: already Rec.709, or invalid."""
    if not isinstance(chromaticities, tuple) or len(chromaticities) != 8:
        return None
    if np.allclose(chromaticities, exr.REC709, atol=2e-4):
        return None
    x, y = np.reshape(chromaticities, (4, 2)).T
    if not (np.isfinite([x, y]).all() and (y > 0).all()):
        return None
    xyz = np.stack([x / y, np.ones(4), (1 - x - y) / y])
    try:
        primaries = xyz[:, :3] * np.linalg.solve(xyz[:, :3], xyz[:, 3])
        to_rgb = rgb_from_xyz()
        white = np.linalg.inv(to_rgb).sum(axis=1)
        return np.asarray(to_rgb @ adaptation_of_xyz(xyz[:, 3], white) @ primaries)
    except np.linalg.LinAlgError:
        return None
