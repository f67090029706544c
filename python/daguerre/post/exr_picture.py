"""Reads pictures in OpenEXR files by rows; channels other than colour pass through unchanged.

Effects work in linear Rec.709. Colours of a file that states other primaries are converted, and
back where the file is written.
"""

from __future__ import annotations

import os
from collections.abc import Mapping

import numpy as np

from daguerre.convolution.rows import Rows
from daguerre.errors import InputError, UsageError
from daguerre.files.json_item import clean
from daguerre.pictures.exr.parts import Planes
from daguerre.pictures.exr.reader import ExrReader
from daguerre.pictures.stated_colors import of_exr

from .picture import Band, Canvas, Image


class ExrPicture:
    """First part of an OpenEXR file; NaN and infinite values are counted and kept."""

    def __init__(self, path: str | os.PathLike[str], roles: Mapping[str, str] = {}) -> None:
        """Opens a file.

        Raises:
            UsageError: The name does not end in .exr.
            InputError: The file cannot be read, or has no colour channels.
        """
        check_linear(path)
        self.reader = ExrReader(path)
        reader = self.reader
        colors = _colors(list(reader.channels), str(path))
        corner = tuple(a - b for a, b in zip(reader.corner, reader.full_corner, strict=True))
        self.canvas = Canvas(
            reader.width,
            reader.height,
            (corner[0], corner[1]),
            reader.full_size,
            colors,
            tuple(name for name in reader.channels if name not in colors),
            reader.facts,
            str(path),
            roles,
        )
        self._colors = of_exr(reader.facts, colors[:3])
        self._counted = np.zeros(reader.height, bool)
        self.bad_pixels = 0

    @property
    def converts(self) -> bool:
        """Whether colours are converted for the effects, and back for the file."""
        return len(self.canvas.colors) > 2 and not self._colors.is_plain

    @property
    def remarks(self) -> list[str]:
        """Notes on the file's colours."""
        if not self.converts:
            return list(self._colors.remarks)
        return [f"{self._colors.sentence}; a written .exr has the file's again"]

    def rows(self, rows: Rows) -> Band:
        """Reads rows, in linear Rec.709."""
        found = self.reader.rows(rows.begin, rows.end)
        image = np.stack([found[name] for name in self.canvas.colors], axis=2, dtype=np.float32)
        if self.converts:
            image[..., :3] = self._colors.light(image[..., :3])
        new = ~self._counted[rows.begin : rows.end]
        if new.any():
            self.bad_pixels += int((~np.isfinite(image[new])).any(axis=2).sum())
            self._counted[rows.begin : rows.end] = True
        return Band(rows, image, {name: found[name] for name in self.canvas.planes})

    def planes(self, band: Band) -> Planes:
        """Converts a band to channels of the file, in their types; halves are clamped."""
        types = self.reader.channels
        out = dict(band.planes)
        image = band.image
        if self.converts:
            numbers = self._colors.numbers(image[..., :3])
            image = np.concatenate([numbers, image[..., 3:]], axis=2)
        for k, name in enumerate(self.canvas.colors):
            out[name] = _typed(image[..., k], types[name])
        return {name: _typed(plane, types[name]) for name, plane in out.items()}


def check_linear(path: str | os.PathLike[str]) -> None:
    """Checks that a source is OpenEXR, as effects need scene-linear light.

    Raises:
        UsageError: The source has another format.
    """
    suffix = os.path.splitext(path)[1].lower()  # noqa: PTH122 - may be any path-like
    if suffix != ".exr":
        raise UsageError(
            f"{path}: wanted a scene-linear .exr, got {suffix or 'no suffix'}: other pictures are "
            "not proportional to light and are clipped at white; convert it to linear OpenEXR first"
        )


def check_target(path: str | os.PathLike[str]) -> None:
    """Checks that a target is .exr, or .png for viewing.

    Raises:
        UsageError: The target has another format.
    """
    suffix = os.path.splitext(path)[1].lower()  # noqa: PTH122 - may be any path-like
    if suffix != ".exr":
        raise UsageError(
            f"{path}: wanted .exr, or .png for viewing only, got {suffix or 'no suffix'}"
        )


def _colors(names: list[str], where: str) -> tuple[str, ...]:
    for colors in (("R", "G", "B"), ("Y",)):
        if all(name in names for name in colors):
            return (*colors, "A") if "A" in names else colors
    raise InputError(
        f"{where}: channels: wanted R, G, B or Y, got {', '.join(map(clean, names[:24]))}"
    )


def _typed(plane: Image, dtype: str) -> Image:
    """Converts to a type; float16 is clamped to 65504, so that light does not become infinite."""
    if dtype == "float16" and plane.dtype == np.float32:
        finite = np.isfinite(plane)
        plane = np.where(finite, np.clip(plane, -65504, 65504), plane)
    return plane.astype(dtype, copy=False)
