"""Measures rendered or photographed charts: edges, stars, texture, patches."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daguerre.argument_checks import guarded
from daguerre.checks import line, numbers, rows, short, to_numbers, whole
from daguerre.errors import InputError, UsageError
from daguerre.files.value import BriefRecord

from .chart import Chart

FloatArray = NDArray[np.float64]
_FINER = 4  # bins of the edge's profile per pixel, as in ISO 12233


@guarded
@dataclass(frozen=True, repr=False)
class EdgeResponse(BriefRecord):
    """Response to an edge.

    Attributes:
        frequency: Cycles per pixel, shape (F,), from 0.
        response: Modulation at these frequencies, shape (F,), 1 at 0.
        angle: Angle of the edge against the rows or columns that it is nearer to, degrees.
        low: Light on the dark side.
        high: Light on the light side.
    """

    frequency: FloatArray
    response: FloatArray
    angle: float
    low: float
    high: float

    def at(self, frequency: ArrayLike) -> FloatArray:
        """Returns the response at frequencies (cycles per pixel), interpolated linearly."""
        return np.asarray(np.interp(np.asarray(frequency), self.frequency, self.response))

    @property
    def mtf50(self) -> float:
        """Frequency at which the response first falls to a half, cycles/px; infinite: never."""
        below = np.flatnonzero(self.response < 0.5)
        if not below.size or below[0] == 0:
            return np.inf
        i = int(below[0])
        (f0, f1), (r0, r1) = self.frequency[i - 1 : i + 1], self.response[i - 1 : i + 1]
        return float(f0 + (r0 - 0.5) / (r0 - r1) * (f1 - f0))


@guarded
def edge_response(region: ArrayLike, *, bend: int = 1) -> EdgeResponse:
    """Measures the spatial frequency response of a slanted edge by ISO 12233.

    The edge is located in each row. All rows together sample the edge's profile finer than pixels,
    and the Fourier transform of the profile's slope is the response. The effects of quarter-pixel
    bins and differences are divided out; the effect of the pixel's area is part of the response.

    Args:
        region: Linear light, shape (H, W), with one edge from side to side that is nearly, but not
            exactly, along the columns or the rows.
        bend: Degree of the polynomial fitted to the edge; above 1 if distortion bends it.

    Raises:
        InputError: There is no such edge in the region.
    """
    light, bend = plane(region, "edge: region", 8), whole(bend, "edge: bend", 1, 9)
    rows, columns = light.shape
    if abs(_slope(light, 0)) > abs(_slope(light, 1)):
        light = light.T
        rows, columns = columns, rows
    if light[:, : columns // 2].sum() > light[:, columns - columns // 2 :].sum():
        light = light[:, ::-1]
    place = _edge(light, bend)
    turned = np.gradient(place)
    if np.ptp(place) < 1:
        raise InputError(
            "edge: region: wanted an edge slanted by 1 px or more from end to end, got "
            f"{np.ptp(place):.2g} px"
        )
    across = np.cos(np.arctan(turned))[:, None]  # from along the row to across the edge
    distance = (np.arange(columns)[None] - place[:, None]) * across
    reach = min(float(np.quantile(place, 0)), columns - 1 - float(np.quantile(place, 1)))
    reach = max(reach - 1, 2.0)
    slope, low, high = _profile(distance, light, reach)
    n = len(slope)
    window = np.hamming(2 * n + 1)[1::2]
    spectrum = np.abs(np.fft.rfft(slope * window))
    frequency = np.asarray(np.fft.rfftfreq(n, 1 / _FINER), np.float64)
    with np.errstate(invalid="ignore"):
        # A bin is the mean of its samples, a difference spans one bin: two quarter boxes.
        response = spectrum / spectrum[0] / np.sinc(frequency / _FINER) ** 2
    wanted = frequency <= 1
    angle = float(np.degrees(np.arctan(np.mean(turned))))
    return EdgeResponse(frequency[wanted], response[wanted], angle, low, high)


def plane(values: ArrayLike, where: str, least: int = 2) -> FloatArray:
    """Checks for finite light, shape (H, W), with at least ``least`` pixels on a side."""
    what, _, name = where.partition(": ")
    light = to_numbers(values, what, name, "shape (H, W)").astype(np.float64)
    if light.ndim != 2 or min(light.shape) < least:
        raise InputError(
            f"{where}: wanted (H, W) of at least {least} x {least} pixels, got {light.shape}"
        )
    if not np.isfinite(light).all():
        raise InputError(
            f"{where}: wanted finite light, got NaN or infinity in "
            f"{(~np.isfinite(light)).sum()} pixels"
        )
    return light


def _slope(light: FloatArray, axis: int) -> float:
    """Increase of light from one side of the picture to the other."""
    half = light.shape[axis] // 2
    first, second = np.split(light, [half], axis)
    return float(second.mean() - first.mean())


def _edge(light: FloatArray, bend: int) -> FloatArray:
    """Position of the edge in each row: centre of its slope, then a fitted curve, iterated."""
    slope = np.diff(light, axis=1)
    at = np.arange(slope.shape[1]) + 0.5
    rows = np.arange(len(light))
    window = np.ones_like(slope)
    for _ in range(4):
        weights = slope * window
        total = weights.sum(axis=1)
        if not (total > 0.05 * np.abs(slope).sum(axis=1)).all():
            raise InputError("edge: wanted one edge from dark to light in each row of the region")
        middle = (weights * at).sum(axis=1) / total
        place = np.polyval(np.polyfit(rows, middle, bend), rows)
        width = max(4.0, 0.25 * slope.shape[1])
        window = np.exp(-0.5 * ((at[None] - place[:, None]) / width) ** 4)
    return np.asarray(place)


def _profile(
    distance: FloatArray, light: FloatArray, reach: float
) -> tuple[FloatArray, float, float]:
    """Differences of the edge's profile in bins of a quarter pixel, and the light on both sides."""
    half = int(reach * _FINER)
    bins = np.floor(distance * _FINER + 0.5).astype(int) + half
    inside = (bins >= 0) & (bins <= 2 * half)
    count = np.bincount(bins[inside], minlength=2 * half + 1)
    total = np.bincount(bins[inside], light[inside], minlength=2 * half + 1)
    filled = np.flatnonzero(count)
    profile = np.interp(np.arange(2 * half + 1), filled, total[filled] / count[filled])
    side = max(half // 2, 1)
    return np.diff(profile), float(profile[:side].mean()), float(profile[-side:].mean())


@guarded
def places(points: ArrayLike, metadata: Mapping[str, Any]) -> FloatArray:
    """Where points of a chart are in a rendered picture, if the lens does not distort, px.

    Args:
        points: m, in the chart's plane, shape (N, 2).
        metadata: Metadata of the frame: ``worldToNDC`` and ``resolution``.
    """
    try:
        matrix = np.asarray(metadata["worldToNDC"], np.float64)
        width, height = metadata["resolution"]
    except KeyError as error:
        raise InputError(f"chart: metadata: wanted {error}, got none") from None
    except (TypeError, ValueError):
        got = ", ".join(f"{key} = {short(metadata[key])}" for key in ("worldToNDC", "resolution"))
        raise InputError(
            "chart: metadata: wanted worldToNDC as a 4x4 matrix and resolution as two numbers, "
            f"got {got}"
        ) from None
    flat = rows(points, "places: points", 2)
    seen = np.c_[flat, np.zeros(len(flat)), np.ones(len(flat))] @ matrix
    ndc = seen[:, :2] / seen[:, 3:]
    return np.asarray((ndc * [1, -1] + 1) / 2 * [width, height])


@guarded
def means(
    picture: ArrayLike, chart: Chart, metadata: Mapping[str, Any], *, inner: float = 0.6
) -> FloatArray:
    """Returns the mean of each patch of a chart, in the order of its ground truth.

    Args:
        picture: Picture, shape (H, W, C) or (H, W).
        chart: Chart of kind ``color`` or ``step-wedge``.
        metadata: Metadata of the frame; see ``places``.
        inner: Share of a patch's side that is averaged.

    Returns:
        Means, shape (patches, C) or (patches,).
    """
    if "patches" not in chart.truth:
        raise InputError(f"chart: wanted patches (color or step-wedge), got {chart.name}")
    pixels = np.asarray(picture)
    if pixels.ndim not in (2, 3):
        raise UsageError(f"means: picture: wanted shape (H, W) or (H, W, C), got {pixels.shape}")
    found = []
    for patch in chart.truth["patches"]:
        half = inner * patch["side_m"] / 2
        center = np.asarray(patch["center_m"])
        corners = places([center - half, center + half], metadata)
        x0, y0 = np.ceil(corners.min(axis=0) - 0.5).astype(int)
        x1, y1 = np.floor(corners.max(axis=0) + 0.5).astype(int)
        part = pixels[max(y0, 0) : max(y1, 0), max(x0, 0) : max(x1, 0)]
        if part.size == 0:
            raise InputError(
                f"chart: patch {patch['name']!r}: wanted a patch inside the picture, got one "
                "outside"
            )
        found.append(part.reshape(-1, *part.shape[2:]).mean(axis=0))
    return np.asarray(found, np.float64)


@guarded
def star_modulation(
    picture: ArrayLike, center: ArrayLike, radii: ArrayLike, cycles: int
) -> FloatArray:
    """Modulation of a Siemens star around circles: the first harmonic over the mean (ISO 12233).

    Args:
        picture: Linear light, shape (H, W).
        center: Centre of the star, px (x right, y down, pixel centres at half).
        radii: px, shape (R,); the frequency there is cycles / (2 pi r) per pixel.
        cycles: Number of cycles around the star.

    Returns:
        Modulation, shape (R,).
    """
    light, cycles = plane(picture, "star: picture"), whole(cycles, "star: cycles", 1, 10_000)
    middle_x, middle_y = numbers(center, "star: center", 2, "x and y in px")
    rows, columns = np.indices(light.shape)
    x, y = columns + 0.5 - middle_x, rows + 0.5 - middle_y
    radius, angle = np.hypot(x, y), np.arctan2(y, x)
    found = []
    for r in line(radii, "star: radii"):
        ring = (np.abs(radius - r) < 0.75) & (r > 0)
        if ring.sum() < 3:
            raise InputError(
                f"star: radii: wanted circles in the picture, got a radius of {r:g} px"
            )
        basis = np.c_[
            np.ones(ring.sum()), np.cos(cycles * angle[ring]), np.sin(cycles * angle[ring])
        ]
        mean, a, b = np.linalg.lstsq(basis, light[ring], rcond=None)[0]
        if not mean > 0:
            raise InputError(f"star: picture: wanted light on the circle of {r:g} px, got none")
        found.append(np.hypot(a, b) / mean)
    return np.asarray(found)


@guarded
def texture_response(picture: ArrayLike, reference: ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Measures the modulation of texture against a reference, by frequency.

    It is the real part of the cross spectrum over the reference's spectrum. Noise, which does not
    correlate with the chart, drops out (Kirk, Herzer, Artmann and Kunz 2014, Description of texture
    loss using the dead leaves target, Proc. SPIE 9014).

    Args:
        picture: Linear light, shape (H, W).
        reference: The chart without lens and noise, with the same pixels, for example from
            ``chart.camera()``.

    Returns:
        Frequencies, cycles per pixel, from 0 to 0.5, and the response at them.
    """
    a, b = plane(picture, "texture: picture"), plane(reference, "texture: reference")
    if a.shape != b.shape:
        raise InputError(f"texture: reference: wanted the picture's shape {a.shape}, got {b.shape}")
    rows, columns = a.shape
    window = np.hanning(rows)[:, None] * np.hanning(columns)[None]
    if np.ptp(b) == 0:
        raise InputError("texture: reference: wanted texture, got uniform light")
    seen, wanted = (np.fft.fft2((p - p.mean()) * window) for p in (a, b))
    frequency = np.hypot(*np.meshgrid(np.fft.fftfreq(columns), np.fft.fftfreq(rows)))
    steps = min(rows, columns) // 2
    bins = np.minimum((frequency * 2 * steps).astype(int), steps)
    cross = np.bincount(bins.ravel(), (seen * wanted.conj()).real.ravel(), steps + 1)[:steps]
    power = np.bincount(bins.ravel(), (np.abs(wanted) ** 2).ravel(), steps + 1)[:steps]
    return (np.arange(steps) + 0.5) / (2 * steps), cross / power
