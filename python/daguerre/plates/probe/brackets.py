"""Photographs of one view, read, checked and merged."""

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
class View:
    """A view of the set.

    Attributes:
        merged: Its light.
        shots: Photographs of it.
        exposures: How they were exposed.
        curve: Kind of curve of their numbers: recovered, srgb or linear.
    """

    merged: Merged
    shots: list[Shot]
    exposures: Exposures
    curve: str

    @property
    def path(self) -> Path:
        """The first of its files."""
        return self.shots[0].path

    def facts(self) -> list[dict[str, Any]]:
        """Each photograph with its exposure."""
        stops = self.exposures.stops
        return [
            {"file": shot.path.name, "exposure_ev": round(ev, 4)}
            for shot, ev in zip(self.shots, stops, strict=True)
        ]


@dataclass(frozen=True)
class Reading:
    """How photographs are read: white of raw files, curve of others, luminance of a value of 1."""

    white: White
    response: str
    scale: float | None
    notes: Notes


def read_view(paths: Sequence[str | Path], ev: Sequence[float] | None, how: Reading) -> View:
    """Reads the photographs of one view and merges them.

    Raises:
        InputError: One cannot be read, they do not belong together, or all is clipped.
    """
    shots = [read_shot(path, how.white, how.notes, len(paths)) for path in paths]
    check_together(shots)
    exposures = exposures_of(shots, ev, how.scale, how.notes)
    if len(shots) > 1:
        check_aligned(shots, exposures.stops)
    curve, kind = _curve(shots, exposures.stops, how)
    merged = merge(shots, exposures, curve)
    if merged.clipped.mean() > 0.98:
        raise InputError(f"{shots[0].path}: wanted light that is not clipped, got none")
    if not merged.light.any():
        raise InputError(f"{shots[0].path}: wanted light, got a black picture")
    if merged.negative:
        how.notes.add("pixel of colours beyond Rec.709: negative light became 0", merged.negative)
    return View(merged, shots, exposures, kind)


def _curve(shots: list[Shot], stops: tuple[float, ...], how: Reading) -> tuple[FloatArray, str]:
    """Curve of coded numbers, and its kind."""
    srgb = response.srgb_curve()
    if not shots[0].coded:
        return srgb, "linear"
    if how.response == "linear":
        return np.repeat(np.linspace(0, 1, response.NODES)[:, None], 3, axis=1), "linear"
    apart = max(stops) - min(stops) >= 0.3
    if how.response == "recover" and not apart:
        raise UsageError(
            "--response: recover wants photographs at least 0.3 EV apart, got "
            + ("one" if len(shots) == 1 else f"{max(stops) - min(stops):.1f} EV")
        )
    if how.response == "srgb" or not apart:
        how.notes.add("numbers decoded as sRGB; a camera's own curve may be up to a stop off")
        return srgb, "srgb"
    return response.recover([_eight_bits(shot.numbers) for shot in shots], stops), "recovered"


def _eight_bits(numbers: NDArray[Any]) -> NDArray[np.uint8]:
    if numbers.dtype == np.uint8:
        return numbers
    return np.rint(numbers.astype(np.float32) / 257).astype(np.uint8)
