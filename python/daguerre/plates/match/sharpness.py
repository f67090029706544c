"""Measures the sharpness of a photograph at edges, and the blur that rendered pixels lack."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daguerre.charts.measure import EdgeResponse, edge_response
from daguerre.errors import InputError
from daguerre.files.value import BriefRecord
from daguerre.plates.photograph import Photograph

from .blur import Blur, fitted
from .edges import candidates
from .regions import centred, overview

FloatArray = NDArray[np.float64]
#: Frequencies at which responses are kept, cycles per pixel.
FREQUENCIES = np.arange(33) / 64
#: Least number of good edges, and largest number that is measured.
LEAST, _ENOUGH = 3, 60
#: Noise of the sides over the step, and contrast (light over dark, less 1), of good edges.
_NOISE, _CONTRAST = 0.08, 0.3
#: Edges count if their MTF50 is at least this share of the best tenth's; others are out of focus.
#: Using only the best edges would select them by noise.
_SHARPEST = 0.8


@dataclass(frozen=True, eq=False, repr=False)
class Sharpness(BriefRecord):
    """Sharpness of a photograph.

    Attributes:
        frequency: Frequencies, cycles per pixel, shape (F,).
        response: Modulation by lens, photosites and development, shape (F,).
        edges: Number of good edges.
        blur: Blur and sharpening that give rendered pixels this response.
    """

    frequency: FloatArray
    response: FloatArray
    edges: int
    blur: Blur

    @property
    def mtf50(self) -> float:
        """Frequency at which the response falls to a half, cycles/px; infinite: above 1/2."""
        return EdgeResponse(self.frequency, self.response, 0, 0, 0).mtf50


def sharpness_of(photograph: Photograph) -> Sharpness | None:
    """Measures sharpness at the sharpest edges; None: too few are good enough."""
    found: list[EdgeResponse] = []
    for one in _edges(photograph):
        found.append(one)
        if len(found) == _ENOUGH:
            break
    if len(found) < LEAST:
        return None
    halves = np.minimum([one.mtf50 for one in found], 1.0)
    sharp = halves >= _SHARPEST * np.quantile(halves, 0.9)
    best = [one.at(FREQUENCIES) for one, counts in zip(found, sharp, strict=True) if counts]
    response = np.median(best, axis=0)
    return Sharpness(FREQUENCIES, response, len(found), fitted(FREQUENCIES, response))


def _edges(photograph: Photograph) -> Iterator[EdgeResponse]:
    light, step = overview(photograph)
    for one in candidates(light):
        part = centred(photograph, one.y * step, one.x * step)
        if part is None:
            continue
        try:
            measured = edge_response(part)
        except InputError:
            continue
        if _is_good(measured, part, raw=photograph.raw is not None):
            yield measured


def _is_good(measured: EdgeResponse, part: NDArray[np.float32], *, raw: bool) -> bool:
    """Whether there is one edge between uniform sides, with enough contrast for its noise."""
    step = measured.high - measured.low
    if not step > 0 or not np.isfinite(measured.response[:40]).all():
        return False
    if not raw and step < _CONTRAST * max(measured.low, 1e-6):
        return False
    sides = np.minimum(np.abs(part - measured.low), np.abs(part - measured.high))
    rough = float(np.median(sides)) / step
    tail = measured.response[(measured.frequency > 0.6) & (measured.frequency < 0.9)]
    return rough < _NOISE and 2 < abs(measured.angle) < 25 and bool(tail.mean() < 0.35)
