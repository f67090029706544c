"""Reads OpenEXR files as frames: Daguerre's completely, files of other programs as far as possible.

The counterpart of :mod:`daguerre.pictures.exr.write`. Colours that the file states become linear
Rec.709 (:mod:`daguerre.pictures.stated_colors`).
"""

from __future__ import annotations

import math
import os
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.argument_checks import guarded
from daguerre.color.spaces import LINEAR
from daguerre.color.spectra import xyz_of
from daguerre.errors import InputError
from daguerre.files.json_item import clean
from daguerre.frame.cryptomatte import taken
from daguerre.frame.frame import Frame
from daguerre.frame.world import in_world
from daguerre.pictures.stated_colors import of_exr

from .color_space import Converter, in_rec709
from .facts import read_facts
from .parts import Planes
from .reader import ExrReader, refuse_chroma


@guarded
def load_frame(path: str | os.PathLike[str]) -> Frame:
    """Reads a picture (.exr) of Daguerre or another program, with all channels and metadata.

    If a file has several parts, it reads the first.

    Args:
        path: An ``.exr`` file.

    Returns:
        The frame. ``xyz`` is computed from ``rgb``; other channels are in ``aovs``, by name. Half
        floats become floats. ``metadata["notes"]`` lists conversions of colours, if there are any.

    Raises:
        InputError: The file cannot be read, or has neither R, G, B nor Y.
    """
    with ExrReader(path) as reader:
        planes = reader.rows(0, reader.height)
        facts = reader.facts
        metadata = read_facts(facts)
        metadata |= _place(reader)
    planes = {name: _writable(plane) for name, plane in planes.items()}
    rgb = _light(planes, facts, metadata, path)
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
    frame.aovs = in_world(planes, metadata.get("world_origin"))
    count = metadata.get("bad_samples", 0)
    places = metadata.get("bad_sample_places", [])
    frame.bad_samples = (
        int(count) if math.isfinite(count) else 0,
        [(x, y, sample) for x, y, sample in places],
    )
    return frame


def _place(reader: ExrReader) -> dict[str, Any]:
    """Size of the whole picture, and the box in the file; overscan is outside of the picture."""
    (x, y), (left, top) = reader.corner, reader.full_corner
    x0, y0 = x - left, y - top
    width, height = reader.full_size
    crop = (x0, y0, x0 + reader.width, y0 + reader.height)
    return {"resolution": (width, height), "crop": crop}


def _writable(plane: NDArray[Any]) -> NDArray[Any]:
    return plane if plane.dtype == np.uint32 else plane.astype(np.float32, copy=False)


def _group(planes: Planes, names: list[str]) -> NDArray[np.float32] | None:
    """Removes channels from ``planes`` and stacks them; None: no names, or a channel is missing."""
    if not names or not all(name in planes for name in names):
        return None
    return np.stack([planes.pop(name) for name in names], axis=2)


def _light(
    planes: Planes, facts: dict[str, Any], metadata: dict[str, Any], path: str | os.PathLike[str]
) -> NDArray[np.float32]:
    """Takes the picture from ``planes``, and converts it and the layers of light to Rec.709."""
    rgb, names = _rgb(planes, path)
    colors = of_exr(facts, names)
    if colors.sentences:
        metadata["notes"] = colors.sentences
    own = metadata.pop("colorspace", None)
    if own in LINEAR:  # the frame is saved in the same space again
        metadata["colorspace"] = own
    if not colors.is_plain:
        space = Converter(own) if own in LINEAR else None
        in_rec709(planes, space.read if space else lambda _, light: colors.light(light))
    return colors.light(rgb)


def _rgb(
    planes: Planes, path: str | os.PathLike[str]
) -> tuple[NDArray[np.float32], tuple[str, ...]]:
    """The picture, and the names of its channels."""
    for names in (("R", "G", "B"), ("X", "Y", "Z")):
        if (found := _group(planes, list(names))) is not None:
            return found.astype(np.float32, copy=False), names
    refuse_chroma(list(planes), str(path))
    if "Y" in planes:
        grey = np.repeat(planes.pop("Y")[:, :, None], 3, axis=2)
        return grey.astype(np.float32, copy=False), ("Y",)
    listed = ", ".join(clean(name) for name in list(planes)[:12])
    raise InputError(f"{path}: channels: wanted R, G, B or Y, got {listed}")
