"""Joins crops of a picture into one file, in bands of rows, to need little memory."""

from __future__ import annotations

import os
import struct
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import InputError, MismatchError
from daguerre.files.atomic import atomic_path
from daguerre.files.json_item import clean

from .header import ExrHeader
from .reader import ExrReader
from .rows import ExrWriter

BAND = 64  # rows at a time
Box = tuple[int, int, int, int]  # first column and row, and last column and row plus 1
#: Attributes that may differ between crops: counts are added, adaptive sampling and light
#: paths stay if all crops agree, other attributes are left out.
COUNTS = ("daguerre:bad_samples", "daguerre:motion_missing")
IF_ALIKE = ("daguerre:light_paths", "daguerre:noise", "daguerre:denoised_noise")
ADAPTIVE = ("daguerre:samples", "daguerre:samples_min", "daguerre:samples_max")
OWN = (
    *COUNTS, "dataWindow", "compression", "lineOrder", "chunkCount", "type", "version",
    "daguerre:bad_sample_places", "daguerre:key", "daguerre:ranges", "daguerre:metadata",
    "daguerre:words", "daguerre:pass",
)  # fmt: skip


def join_crops(paths: Sequence[str | os.PathLike[str]], out: str | os.PathLike[str]) -> Box:
    """Joins crops into a picture with the same pixels, bit for bit, and the attributes they share.

    Args:
        paths: Crops of one picture (``.exr``) that fill a rectangle, without overlaps.
        out: File to write; it may be one of the crops.

    Returns:
        Box of the joined pixels.

    Raises:
        InputError: A file cannot be read.
        MismatchError: Crops belong to different pictures, overlap, or leave a gap.
        OutputError: The file cannot be written.
    """
    if not paths:
        raise InputError("merge: no crops given")
    with ExitStack() as stack:
        crops = [stack.enter_context(ExrReader(path)) for path in paths]
        for other in crops[1:]:
            _check_alike(crops[0], other)
        window = _window(crops)
        crops.sort(key=lambda crop: (crop.corner[1], crop.corner[0]))
        with atomic_path(out) as temp, ExrWriter(temp, _header(crops, window)) as writer:
            for top in range(window[1], window[3], BAND):
                writer.write(_rows(crops, window, top, min(top + BAND, window[3])))
    return window


def box_of(crop: ExrReader) -> Box:
    """Box of the pixels in a file."""
    x, y = crop.corner
    return x, y, x + crop.width, y + crop.height


def _check_alike(first: ExrReader, other: ExrReader) -> None:
    a, b = first.header.attributes, other.header.attributes
    free = {*OWN, *IF_ALIKE, *(ADAPTIVE if ADAPTIVE[1] in a and ADAPTIVE[1] in b else ())}
    names = sorted(n for n in {*a, *b} - free if a.get(n) != b.get(n))
    if names:
        raise MismatchError(
            f"{other.path}: not a crop of the same picture as {first.path}; they differ in: "
            + ", ".join(_difference(name, first, other) for name in names)
        )


def _difference(name: str, first: ExrReader, other: ExrReader) -> str:
    """Name of an attribute, with both values if they are short."""
    values = [str(crop.facts.get(name, "none")) for crop in (other, first)]
    short = all(len(value) <= 40 for value in values) and values[0] != values[1]
    return f"{clean(name)} ({values[0]}, wanted {values[1]})" if short else clean(name)


def _window(crops: list[ExrReader]) -> Box:
    """Rectangle that the crops fill; checks for overlaps and gaps."""
    boxes = [box_of(crop) for crop in crops]
    for i, a in enumerate(boxes):
        for k, b in enumerate(boxes[:i]):
            if max(a[0], b[0]) < min(a[2], b[2]) and max(a[1], b[1]) < min(a[3], b[3]):
                raise MismatchError(f"{crops[i].path}: overlaps {crops[k].path}")
    lefts, tops, rights, bottoms = zip(*boxes, strict=True)
    x0, y0, x1, y1 = min(lefts), min(tops), max(rights), max(bottoms)
    area, filled = (x1 - x0) * (y1 - y0), sum((b[2] - b[0]) * (b[3] - b[1]) for b in boxes)
    if area != filled:
        raise MismatchError(
            f"merge: wanted crops that fill {x1 - x0} x {y1 - y0} px at ({x0}, {y0}), "
            f"got gaps of {area - filled} px"
        )
    return x0, y0, x1, y1


def _header(crops: list[ExrReader], window: Box) -> ExrHeader:
    header = crops[0].header
    alike = {k for k, v in header.attributes.items() if all(_value(c, k) == v for c in crops)}
    kept = {k: v for k, v in header.attributes.items() if k in alike and k not in OWN}
    kept["compression"] = header.attributes["compression"]
    x0, y0, x1, y1 = window
    kept["dataWindow"] = ("box2i", struct.pack("<4i", x0, y0, x1 - 1, y1 - 1))
    for name in COUNTS:
        if name in header.attributes:
            count = sum(int(crop.facts.get(name, 0)) for crop in crops)
            kept[name] = ("int", struct.pack("<i", count))
    return replace(header, attributes=kept)


def _value(crop: ExrReader, name: str) -> tuple[str, bytes] | None:
    return crop.header.attributes.get(name)


def _rows(crops: list[ExrReader], window: Box, top: int, bottom: int) -> dict[str, NDArray[Any]]:
    """Reads rows [top, bottom) of the picture, by channel."""
    shape = bottom - top, window[2] - window[0]
    planes = {name: np.empty(shape, dtype) for name, dtype in crops[0].channels.items()}
    for crop in crops:
        x0, y0, x1, y1 = box_of(crop)
        begin, end = max(top, y0), min(bottom, y1)
        if begin >= end:
            continue
        found = crop.rows(begin - y0, end - y0)
        columns = slice(x0 - window[0], x1 - window[0])
        for name, plane in planes.items():
            plane[begin - top : end - top, columns] = found[name]
    return planes


def are_crops(paths: Sequence[str | os.PathLike[str]]) -> bool:
    """Whether files have different boxes of pixels, so that ``merge`` joins and does not add them.

    If a file cannot be read: False; the next reader gives the error.
    """
    boxes = set()
    for path in paths:
        try:
            with ExrReader(path) as reader:
                boxes.add(box_of(reader))
        except InputError:
            return False
    return len(boxes) > 1
