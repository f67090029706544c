"""Relative illumination of a lens over a picture, by colour."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from daguerre.color.spaces import LUMINANCE_709
from daguerre.convolution.rows import Rows
from daguerre.errors import InputError

from .optics import Plane, offsets
from .picture import Canvas

if TYPE_CHECKING:
    from daguerre.analysis.bench import Bench

FloatArray = NDArray[np.float64]
#: Function that returns the falloff of some rows, shape (rows, W), or (rows, W, C) by channel.
Falloff = Callable[[Rows], NDArray[np.float32]]

HEIGHTS = 33  # image heights sampled for lenses with axial symmetry
ACROSS, DOWN = 13, 9  # points of the frame sampled for other lenses
RAYS = 64  # rays across the pupil for each of these points
WAVELENGTHS = 5


def lens_light(canvas: Canvas, film: Plane, lens: Bench, *, color: bool) -> Falloff:
    """Illumination of the film relative to the axis, from exact rays through the whole pupil.

    By colour, each channel is relative to white on the axis, so that white stays white there.
    Pictures without red, green and blue get the falloff of luminance.
    """
    mixes = _mixes(by_channel=color and canvas.colors[:3] == ("R", "G", "B"))
    if lens.lens.prescription.is_axially_symmetric:
        return _around_axis(canvas, film, lens, mixes)
    return _over_frame(canvas, film, lens, mixes)


def _mixes(*, by_channel: bool) -> tuple[FloatArray, FloatArray]:
    """Wavelengths (L,), nm, and the contribution of each to the channels of white light, (L, C)."""
    from daguerre.color.spectra import rgb_mixes

    nm, mixes = rgb_mixes(WAVELENGTHS)
    white = mixes.sum(axis=2)
    return nm, white if by_channel else (white @ LUMINANCE_709)[:, None]


def _relative(
    lens: Bench, film_mm: FloatArray, mixes: tuple[FloatArray, FloatArray], rays: int
) -> NDArray[np.float32]:
    """Illumination at film points (N, 2) relative to the axis, shape (N, C)."""
    from daguerre.analysis.illumination import spectral_illumination

    nm, white = mixes
    points = np.vstack([np.zeros((1, 2)), film_mm])
    light = spectral_illumination(lens, points, nm, grid=rays) @ white
    if not (light[0] > 0).all():
        raise InputError(f"{lens.lens.name}: vignetting: no light reaches the film on the axis")
    return np.asarray(np.maximum(light[1:] / light[0], 0), np.float32)


def _around_axis(
    canvas: Canvas, film: Plane, lens: Bench, mixes: tuple[FloatArray, FloatArray]
) -> Falloff:
    """Falloff as a function of the distance from the axis."""
    ends = [film.radii(canvas, Rows(y, y + 1))[0, [0, -1]] for y in (0, canvas.height - 1)]
    heights = np.linspace(0, float(np.max(ends)), HEIGHTS)
    light = _relative(lens, np.column_stack([0 * heights, heights]), mixes, 96)

    def falloff(rows: Rows) -> NDArray[np.float32]:
        radii = film.radii(canvas, rows)
        each = [np.interp(radii, heights, channel) for channel in light.T]
        return np.stack(each, axis=2, dtype=np.float32, casting="same_kind")

    return falloff


def _over_frame(
    canvas: Canvas, film: Plane, lens: Bench, mixes: tuple[FloatArray, FloatArray]
) -> Falloff:
    """Falloff interpolated between points of the frame, from edge to edge."""
    x, y = (
        offset.ravel()[[0, -1]] * film.pitch_mm
        for offset in offsets(canvas, Rows(0, canvas.height), film.center)
    )
    # The picture is upside down on the film, and the film's y is up: both signs flip.
    points = np.meshgrid(-np.linspace(x[0], x[1], ACROSS), np.linspace(y[0], y[1], DOWN))
    light = _relative(lens, np.stack(points, axis=-1).reshape(-1, 2), mixes, RAYS)
    return CubicGrid(light.reshape(DOWN, ACROSS, -1), canvas.width, canvas.height)


class CubicGrid:
    """Cubic interpolation between nodes; the outer nodes are the centres of the outer pixels.

    Keys' cubic, a = -1/2, is exact for parabolas, and continues as a parabola beyond the nodes.
    """

    def __init__(self, nodes: NDArray[np.float32], width: int, height: int) -> None:
        """Takes nodes of shape (rows, columns, C)."""
        self._down = _Taps(height, nodes.shape[0])
        self._across = _Taps(width, nodes.shape[1])
        taller = _continued(nodes)
        self._nodes = _continued(taller.swapaxes(0, 1)).swapaxes(0, 1)

    def __call__(self, rows: Rows) -> NDArray[np.float32]:
        """Returns the values of rows, shape (rows, W, C); at least 0."""
        lines = self._down.mixed(self._nodes, slice(rows.begin, rows.end))
        found = self._across.mixed(lines.swapaxes(0, 1), slice(None)).swapaxes(0, 1)
        return np.asarray(np.maximum(found, 0))


class _Taps:
    """The four nodes near each pixel and their weights.

    The nodes are added in sequence, as a product of matrices may round by the number of its rows.
    """

    def __init__(self, pixels: int, nodes: int) -> None:
        at = np.linspace(0, nodes - 1, pixels)
        # Nodes have one more on either side, so node k stands at k + 1.
        self._first = np.clip(np.floor(at).astype(int), 0, max(nodes - 2, 0))
        d = np.abs(at[:, None] - (self._first[:, None] + np.arange(-1, 3)))
        near, far = (1.5 * d - 2.5) * d * d + 1, ((-0.5 * d + 2.5) * d - 4) * d + 2
        self._weights = np.where(d < 1, near, np.where(d < 2, far, 0)).astype(np.float32)

    def mixed(self, nodes: NDArray[np.float32], pixels: slice) -> NDArray[np.float32]:
        """Interpolates nodes (N, ...) along their first axis at some pixels, (pixels, ...)."""
        first, weights = self._first[pixels], self._weights[pixels]
        last = len(nodes) - 1
        total = np.zeros((len(first), *nodes.shape[1:]), np.float32)
        for k in range(4):
            total += (
                weights[:, k].reshape(-1, *[1] * (nodes.ndim - 1))
                * nodes[np.minimum(first + k, last)]
            )
        return total


def _continued(values: NDArray[np.float32]) -> NDArray[np.float32]:
    """Adds a node on either side, by the parabola through three."""
    first = 3 * values[:1] - 3 * values[1:2] + values[2:3]
    last = 3 * values[-1:] - 3 * values[-2:-1] + values[-3:-2]
    return np.concatenate([first, values, last])
