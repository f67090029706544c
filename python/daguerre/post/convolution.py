"""Convolution of linear pictures with large kernels: bloom, stars, diffraction, PSFs of lenses.

Light is spread from each pixel (not gathered): a kernel whose sum is 1 keeps all of it, but for
what leaves the frame, which is lost as in a camera. By FFT over tiles that overlap when they are
added (overlap-add: Stockham 1966, High-speed convolution and correlation).

A float FFT errs by some 1e-7 of the brightest lamp all over its tile. So a large kernel goes in two
parts: its middle with small tiles, where an error stays next to the lamp, and the faint rest with
large ones.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daguerre.errors import UsageError
from daguerre.fft import Complex, Fft2, Real, fast_sizes, thread_count

#: bytes that the spectra of kernels and of one tile may take together
SPECTRA_BYTES = 640 << 20
MIDDLE = 65  # px across, of the part of a large kernel that goes by itself
SMALL = 1 << 17  # points of a transform that is left to one thread


def convolve(image: ArrayLike, kernel: ArrayLike, *, threads: int = 0) -> Real:
    """A picture with each pixel's light spread by a kernel.

    Args:
        image: Linear, shape (H, W) or (H, W, C). NaN and infinite values spread no light and stay.
        kernel: Shape (h, w): the same for all channels; (h, w, C): one for each; (h, w, C, C): from
            each channel (last axis) to each (axis 2). Its middle is at (h // 2, w // 2).
        threads: 0: all cores.

    Returns:
        float32, the shape of the image.
    """
    picture = np.asarray(image, np.float32)
    planes = picture[:, :, None] if picture.ndim == 2 else picture
    count = planes.shape[2]
    k = np.asarray(kernel, np.float32)
    if k.ndim == 2:
        k = k[:, :, None]
    known = k.ndim in (3, 4) and k.shape[2] in (1, count) and (k.ndim < 4 or k.shape[3] == count)
    if not known:
        raise UsageError(
            f"convolve: kernel: wanted (h, w), (h, w, {count}) or (h, w, {count}, {count}), "
            f"got {np.shape(kernel)}"
        )
    out = np.empty(planes.shape, np.float32)
    if k.ndim == 4:
        out[:] = spread(planes, k[None, None], threads=threads)
    else:
        for c in range(count):
            one = k[None, None, :, :, c % k.shape[2], None, None]
            out[:, :, c] = spread(planes[:, :, c, None], one, threads=threads)[:, :, 0]
    return out.reshape(picture.shape)


def spread(planes: Real, kernels: Real, *, threads: int = 0) -> Real:
    """A picture with its light spread by kernels that change over the frame.

    Args:
        planes: Shape (H, W, I).
        kernels: Shape (Y, X, h, w, J, I): of points on a regular grid from edge to edge of the
            frame (its middle, of one), from channel i to j; between them they are blended linearly.
        threads: 0: all cores.

    Returns:
        Shape (H, W, J), float32; where a channel was not finite its value stays (J = I).
    """
    finite = np.isfinite(planes)
    whole = bool(finite.all())
    light = planes if whole else np.where(finite, planes, np.float32(0))
    out = np.zeros((*planes.shape[:2], kernels.shape[4]), np.float32)
    for part in _parts(kernels):
        _add(out, light, part, thread_count(threads))
    if not whole and out.shape == planes.shape:
        out[~finite] = planes[~finite]
    return out


def _parts(kernels: Real) -> Iterator[Real]:
    """The kernels, or their middle and the rest of them."""
    h, w = kernels.shape[2:4]
    if min(h, w) < 4 * MIDDLE:
        yield kernels
        return
    y, x = h // 2 - MIDDLE // 2, w // 2 - MIDDLE // 2
    middle = kernels[:, :, y : y + MIDDLE, x : x + MIDDLE]
    yield middle
    rest = kernels.copy()
    rest[:, :, y : y + MIDDLE, x : x + MIDDLE] = 0
    yield rest


@dataclass(frozen=True)
class _Tiles:
    """How a picture is cut: the transform's size, and the tile's that it leaves beside a kernel."""

    shape: tuple[int, int]
    tile: tuple[int, int]

    def places(self, height: int, width: int) -> Iterator[list[tuple[slice, slice]]]:
        """Tiles, by rows."""
        for y in range(0, height, self.tile[0]):
            rows = slice(y, min(y + self.tile[0], height))
            yield [
                (rows, slice(x, min(x + self.tile[1], width)))
                for x in range(0, width, self.tile[1])
            ]


def _tiles(picture: tuple[int, int], kernel: tuple[int, int], spectra: int) -> _Tiles:
    """The cheapest transforms whose spectra fit into memory; small kernels get small ones."""
    most = SPECTRA_BYTES // (4 * spectra)
    if max(kernel) <= MIDDLE:
        most = min(most, (4 * MIDDLE) ** 2)
    sizes = []
    for extent, reach in zip(picture, kernel, strict=True):
        lengths = [n for n in fast_sizes(4 * (extent + reach)) if n >= reach]
        enough = next(n for n in lengths if n >= extent + reach - 1)
        sizes.append([n for n in lengths if n <= enough and n % 2 == 0] or [enough])
    best, cost = (sizes[0][0], sizes[1][0]), math.inf
    for rows in sizes[0]:
        for columns in sizes[1]:
            if rows * columns > most:
                break
            tiles = math.ceil(picture[0] / (rows - kernel[0] + 1))
            tiles *= math.ceil(picture[1] / (columns - kernel[1] + 1))
            work = tiles * rows * columns * math.log2(rows * columns)
            if work < cost:
                best, cost = (rows, columns), work
    return _Tiles(best, (best[0] - kernel[0] + 1, best[1] - kernel[1] + 1))


def _add(out: Real, light: Real, kernels: Real, threads: int) -> None:
    """Adds the light spread by one part of the kernels."""
    zones = kernels.shape[:2]
    h, w, outs, ins = kernels.shape[2:]
    spectra = zones[0] * zones[1] * outs * ins + outs + 3
    cut = _tiles(light.shape[:2], (h, w), spectra)
    small = cut.shape[0] * cut.shape[1] <= SMALL
    fft = Fft2(cut.shape, 1 if small else threads)
    transforms: dict[tuple[int, int, int, int], Complex] = {}
    for y, x, j, i in np.ndindex(*zones, outs, ins):
        kernel = np.ascontiguousarray(kernels[y, x, :, :, j, i])
        if kernel.any():
            transforms[y, x, j, i] = fft.forward(kernel)
    weights = [_hats(n, zone) for n, zone in zip(light.shape[:2], zones, strict=True)]

    def tile(place: tuple[slice, slice]) -> list[Real | None]:
        return _spread_tile(fft, light[place], place, weights, transforms, (h, w, outs))

    for row in cut.places(*light.shape[:2]):
        # Tiles are added one after the other in their order: the bits do not depend on threads.
        if small and len(row) > 1 and threads > 1:
            with ThreadPoolExecutor(threads) as pool:
                made = list(pool.map(tile, row))
        else:
            made = [tile(place) for place in row] if small else []
        for k, place in enumerate(row):
            for j, values in enumerate(made[k] if small else tile(place)):
                if values is not None:
                    _put(out[:, :, j], values, place[0].start - h // 2, place[1].start - w // 2)


def _spread_tile(
    fft: Fft2,
    tile: Real,
    place: tuple[slice, slice],
    weights: list[NDArray[np.float32]],
    transforms: dict[tuple[int, int, int, int], Complex],
    size: tuple[int, int, int],
) -> list[Real | None]:
    """What a tile's light becomes, by channel, with the kernel's reach around it."""
    h, w, outs = size
    sums: list[Complex | None] = [None] * outs
    for y, x, i in sorted({(y, x, i) for y, x, _, i in transforms}):
        rows, columns = weights[0][y, place[0]], weights[1][x, place[1]]
        if not (rows.any() and columns.any()):
            continue
        share = tile[:, :, i]
        if len(weights[0]) > 1 or len(weights[1]) > 1:
            share = share * rows[:, None] * columns
        if not share.any():
            continue
        spectrum = fft.forward(share)
        for j in range(outs):
            transform = transforms.get((y, x, j, i))
            if transform is None:
                continue
            product = spectrum * transform
            total = sums[j]
            sums[j] = product if total is None else np.add(total, product, out=total)
    reach = (tile.shape[0] + h - 1, tile.shape[1] + w - 1)
    return [None if total is None else fft.inverse(total, reach) for total in sums]


def _hats(count: int, zones: int) -> NDArray[np.float32]:
    """Weights of zones over the pixels along an axis, shape (zones, count): they add up to 1."""
    if zones == 1:
        return np.ones((1, count), np.float32)
    at = (np.arange(count) + 0.5) / count * (zones - 1)
    hats = 1 - np.abs(at - np.arange(zones)[:, None])
    return np.asarray(np.maximum(hats, 0), np.float32)


def _put(plane: Real, values: Real, y: int, x: int) -> None:
    """Adds values at a place that may reach beyond the frame."""
    height, width = plane.shape
    y0, x0 = max(y, 0), max(x, 0)
    y1, x1 = min(y + values.shape[0], height), min(x + values.shape[1], width)
    if y1 > y0 and x1 > x0:
        plane[y0:y1, x0:x1] += values[y0 - y : y1 - y, x0 - x : x1 - x]
