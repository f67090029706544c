"""Reads, checks and merges photographs of one view."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import InputError, UsageError
from daguerre.files.notes import Notes

from . import response
from .alignment import check_aligned
from .exposures import Exposures, exposures_of
from .latlong import FloatArray
from .merge import Merged, merge
from .shots import Shot, White, check_together, read_shot


@dataclass(frozen=True)
class SetView:
    """A view of the set.

    Attributes:
        merged: Merged light.
        shots: Photographs of the view.
        exposures: Exposures of the photographs.
        curve: Response curve of the photographs: ``recovered``, ``srgb`` or ``linear``.
    """

    merged: Merged
    shots: list[Shot]
    exposures: Exposures
    curve: str

    @property
    def path(self) -> Path:
        """Path of the first photograph."""
        return self.shots[0].path

    def facts(self) -> list[dict[str, Any]]:
        """File and exposure of each photograph."""
        stops = self.exposures.stops
        return [
            {"file": shot.path.name, "exposure_ev": round(ev, 4)}
            for shot, ev in zip(self.shots, stops, strict=True)
        ]


@dataclass(frozen=True)
class Reading:
    """Options of reading: white of raw files, curve of others, luminance of a value of 1."""

    white: White
    response: str
    scale: float | None
    notes: Notes


def read_view(paths: Sequence[str | Path], ev: Sequence[float] | None, how: Reading) -> SetView:
    """Reads the photographs of one view and merges them.

    Raises:
        InputError: A photograph cannot be read, they do not belong together, or all is clipped.
    """
    shots = [read_shot(path, how.white, how.notes, len(paths)) for path in paths]
    check_together(shots)
    exposures = exposures_of(shots, ev, how.scale, how.notes)
    if len(shots) > 1:
        check_aligned(shots, exposures.stops)
    curve, kind = _curve(shots, exposures.stops, how)
    merged = merge(shots, exposures, curve)
    if merged.clipped.mean() > 0.98:
        raise InputError(
            f"{shots[0].path}: nearly all light is clipped; take it with less exposure"
        )
    if not merged.light.any():
        raise InputError(f"{shots[0].path}: the picture is black; take it with more exposure")
    if merged.negative:
        how.notes.add("pixel outside the Rec.709 gamut: negative light set to 0", merged.negative)
    return SetView(merged, shots, exposures, kind)


def _curve(shots: list[Shot], stops: tuple[float, ...], how: Reading) -> tuple[FloatArray, str]:
    """Response curve of encoded photographs, and its kind."""
    srgb = response.srgb_curve()
    if not shots[0].coded:
        return srgb, "linear"
    if how.response == "linear":
        return np.repeat(np.linspace(0, 1, response.NODES)[:, None], 3, axis=1), "linear"
    apart = max(stops) - min(stops) >= 0.3
    if how.response == "recover" and not apart:
        raise UsageError(
            "--response recover needs photographs at least 0.3 EV apart, got "
            + ("one" if len(shots) == 1 else f"{max(stops) - min(stops):.1f} EV")
        )
    if how.response == "srgb" or not apart:
        how.notes.add("pixels are decoded as sRGB; a camera's own curve may differ by up to a stop")
        return srgb, "srgb"
    return response.recover([_eight_bits(shot.numbers) for shot in shots], stops), "recovered"


def _eight_bits(numbers: NDArray[Any]) -> NDArray[np.uint8]:
    if numbers.dtype == np.uint8:
        return numbers
    return np.rint(numbers.astype(np.float32) / 257).astype(np.uint8)
