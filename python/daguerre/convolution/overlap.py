"""Cuts pictures into tiles for transforms, and adds the results.

A float32 FFT has an error of about 1e-7 of the brightest lamp all over its tile. So a large kernel
is split in two: its centre uses small tiles, where the error stays next to the lamp, and the faint
rest uses large tiles.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .fft import Complex, Fft2, Real, around, fast_sizes
from .rows import Rows

#: Most bytes for the spectra of all kernels and of one tile.
SPECTRA_BYTES = 640 << 20
MIDDLE = 65  # width of the centre of a large kernel, px
SMALL_TILE = 4 * MIDDLE  # most points across transforms for small kernels
ROWS = 1024  # most rows that a band reads, or twice the kernel's if that is more
SMALL = 1 << 17  # most points of a transform that uses one thread

Size = tuple[int, int]


def parts_of(kernels: Real, picture: Size, threads: int, *, banded: bool) -> list[Part]:
    """Returns the transformed kernels; a large kernel gives two parts, its centre and the rest."""
    h, w = kernels.shape[2:4]
    if min(h, w) < 4 * MIDDLE:
        return [Part(kernels, picture, threads, banded=banded)]
    y, x = h // 2 - MIDDLE // 2, w // 2 - MIDDLE // 2
    inner = np.s_[y : y + MIDDLE, x : x + MIDDLE]
    middle = kernels[:, :, *inner]
    return [
        Part(middle, picture, threads, banded=False),
        Part(kernels, picture, threads, banded=banded, without=inner),
    ]


class Tile(NamedTuple):
    """A rectangle of the picture."""

    rows: slice
    columns: slice


class Part:
    """One part of the kernels, transformed.

    Args:
        kernels: Shape (Y, X, h, w, J, I).
        picture: Rows and columns of the picture.
        threads: Number of threads.
        banded: Whether one tile has all rows that are read for a block of rows.
        without: Area of the kernels that is set to zero.
    """

    def __init__(
        self,
        kernels: Real,
        picture: Size,
        threads: int,
        *,
        banded: bool,
        without: tuple[slice, slice] | None = None,
    ) -> None:
        self._size = kernels.shape[2], kernels.shape[3]
        zones, self._outs = (kernels.shape[0], kernels.shape[1]), kernels.shape[4]
        self._weights = [hats(n, zone) for n, zone in zip(picture, zones, strict=True)]
        channels = kernels.shape[5], self._outs
        most = max(ROWS, 2 * self._size[0]) if banded else None
        shape, (self.block, self._width) = plan(
            picture, self._size, zones, channels, most_rows=most
        )
        small = shape[0] * shape[1] <= SMALL
        self._threads = threads if small else 1
        self._fft, self._banded = Fft2(shape, 1 if small else threads), banded
        self._transforms: dict[tuple[int, int, int, int], Complex | Real] = {}
        for y, x, j, i in np.ndindex(*zones, self._outs, kernels.shape[5]):
            kernel = np.array(kernels[y, x, :, :, j, i], np.float32)
            if without is not None:
                kernel[without] = 0
            if kernel.any():
                self._transforms[y, x, j, i] = self._fft.of_kernel(kernel)

    def add(self, out: Real, wanted: Rows, light: Real, first: int) -> None:
        """Spreads light, which begins at row ``first``, and adds rows ``wanted`` to ``out``."""
        h = self._size[0]
        begin = max(wanted.begin - (h - 1 - h // 2), first)
        read = Rows(begin, min(wanted.end + h // 2, first + len(light)))

        def tile(place: Tile, space: _Space) -> Iterator[tuple[int, Real]]:
            part = light[place.rows.start - first : place.rows.stop - first, place.columns]
            return self._spread(part, place, wanted, space)

        def alone(place: Tile) -> list[tuple[int, Real]]:
            return list(tile(place, _Space(self._fft, self._outs, shared=False)))

        space = _Space(self._fft, self._outs, shared=True)

        for row in self._tiles(read, light.shape[1]):
            # Tiles are added in order, so the bits do not depend on the number of threads.
            if self._threads > 1 and len(row) > 1:
                with ThreadPoolExecutor(self._threads) as pool:
                    made = list(pool.map(alone, row))
                for place, planes in zip(row, made, strict=True):
                    self._put(out, planes, place, wanted)
            else:
                for place in row:
                    self._put(out, tile(place, space), place, wanted)

    def _tiles(self, read: Rows, width: int) -> Iterator[list[Tile]]:
        """Yields rows of tiles that cover ``read``; unless banded, cut at multiples of a block."""
        edges = [read.begin, read.end]
        if not self._banded:
            first = read.begin // self.block * self.block
            edges = [max(y, read.begin) for y in range(first, read.end, self.block)] + [read.end]
        for top, bottom in pairwise(edges):
            rows = slice(top, bottom)
            yield [
                Tile(rows, slice(x, min(x + self._width, width)))
                for x in range(0, width, self._width)
            ]

    def _reached(self, place: Tile, wanted: Rows) -> Rows:
        """Wanted rows that a tile's light reaches."""
        h = self._size[0]
        top, bottom = place.rows.start - h // 2, place.rows.stop + h - 1 - h // 2
        return Rows(max(top, wanted.begin), min(bottom, wanted.end))

    def _spread(
        self, light: Real, place: Tile, wanted: Rows, space: _Space
    ) -> Iterator[tuple[int, Real]]:
        """Spreads a tile's light; yields each channel: rows that it reaches, periodic columns."""
        fft, rows = self._fft, self._reached(place, wanted)
        summed: set[int] = set()
        for y, x, i in sorted({(y, x, i) for y, x, _, i in self._transforms}):
            share = self._share(light[:, :, i], place, y, x)
            if rows.end <= rows.begin or share is None or not share.any():
                continue
            spectrum = fft.forward(share, space.spectrum)
            for j in range(self._outs):
                kernel = self._transforms.get((y, x, j, i))
                if kernel is None:
                    continue
                fft.add_product(space.sums[j], spectrum, kernel, new=j not in summed)
                summed.add(j)
        here = slice(rows.begin - place.rows.start, rows.end - place.rows.start)
        for j in sorted(summed):
            yield j, fft.inverse(space.sums[j], here, space.result(j))

    def _share(self, light: Real, place: Tile, y: int, x: int) -> Real | None:
        """Part of a tile's light that the kernel of zone (y, x) spreads; None: nothing."""
        rows, columns = self._weights[0][y, place.rows], self._weights[1][x, place.columns]
        if not (rows.any() and columns.any()):
            return None
        if len(self._weights[0]) == len(self._weights[1]) == 1:
            return light
        share = light * rows[:, None]
        share *= columns
        return np.asarray(share)

    def _put(
        self, out: Real, planes: Iterable[tuple[int, Real]], place: Tile, wanted: Rows
    ) -> None:
        """Adds a tile's result at its place in the frame."""
        rows = self._reached(place, wanted)
        w = self._size[1]
        left = max(place.columns.start - w // 2, 0)
        right = min(place.columns.stop + w - 1 - w // 2, out.shape[1])
        period = self._fft.shape[1]
        for j, values in planes:
            plane = out[rows.begin - wanted.begin : rows.end - wanted.begin, left:right, j]
            for at, piece in around(left - place.columns.start, right - left, period):
                plane[:, at : at + piece.stop - piece.start] += values[:, piece]


class _Space:
    """Memory that tiles reuse: allocating new pages would take as long as the sums.

    Args:
        fft: The transforms.
        outs: Number of output channels.
        shared: Whether all channels share one result, each used before the next is computed.
    """

    def __init__(self, fft: Fft2, outs: int, *, shared: bool) -> None:
        self.spectrum = np.empty(fft.spectrum_shape, np.complex64)
        self.sums = [np.empty(fft.spectrum_shape, np.complex64) for _ in range(outs)]
        self._results = [np.empty(fft.shape, np.float32) for _ in range(1 if shared else outs)]

    def result(self, j: int) -> Real:
        """Memory for the result of channel j."""
        return self._results[j % len(self._results)]


class Plan(NamedTuple):
    """Sizes into which a picture is cut.

    Attributes:
        shape: Shape of the transforms.
        tile: Rows and columns of a tile.
    """

    shape: Size
    tile: Size


def plan(
    picture: Size, kernel: Size, zones: Size, channels: Size, *, most_rows: int | None = None
) -> Plan:
    """Chooses the cut with the least work and spectra that fit into memory.

    Args:
        picture: Rows and columns of the picture.
        kernel: Rows and columns of a kernel; small kernels get small tiles.
        zones: Number of kernels down and across the frame.
        channels: Number of input and of output channels.
        most_rows: Most rows read for one band, approximately; None: no limit.
    """
    ins, outs = channels
    count = zones[0] * zones[1] * ins * outs
    # A real transform stores half as many numbers as points: per point 2 bytes real, 4 complex.
    most = SPECTRA_BYTES // (2 * count + 4 * (outs + 2))
    if max(kernel) <= MIDDLE:
        most = min(most, SMALL_TILE**2)
    cuts = [
        _cuts(*axis)
        for axis in zip(picture, kernel, zones, (most_rows or picture[0] + kernel[0], 1 << 30),
                        strict=True)
    ]  # fmt: skip
    best, least = Plan((0, 0), (0, 0)), math.inf
    for rows in cuts[0]:
        for columns in cuts[1]:
            points = rows.length * columns.length
            transforms = rows.zones * columns.zones * ins + rows.tiles * columns.tiles * outs
            work = (count + transforms) * points * math.log2(points)
            if work < least and (points <= most or math.isinf(least)):
                best, least = Plan((rows.length, columns.length), (rows.tile, columns.tile)), work
    return best


class _Cut(NamedTuple):
    """A cut of an axis: size of tiles and of transforms, number of tiles, sum of their zones."""

    tile: int
    length: int
    tiles: int
    zones: int


def _cuts(extent: int, reach: int, zones: int, most: int) -> list[_Cut]:
    """Returns ways to cut an axis, from the narrowest useful tiles to a single tile."""
    sizes = [n for n in fast_sizes(4 * (extent + reach)) if n % 2 == 0]
    weights = hats(extent, zones) > 0
    found: list[_Cut] = []
    for tiles in range(max(1, 4 * extent // reach), 0, -1):
        tile = -(-extent // tiles)
        length = next(n for n in sizes if n >= tile + reach - 1)
        if length > most and found:
            break
        touched = sum(
            int(weights[:, at : at + tile].any(axis=1).sum()) for at in range(0, extent, tile)
        )
        found.append(_Cut(tile, length, -(-extent // tile), touched))
    return found


def hats(count: int, zones: int) -> NDArray[np.float32]:
    """Weights of zones at the pixels of an axis, shape (zones, count); they add up to 1."""
    if zones == 1:
        return np.ones((1, count), np.float32)
    at = (np.arange(count) + 0.5) / count * (zones - 1)
    weights = 1 - np.abs(at - np.arange(zones)[:, None])
    return np.asarray(np.maximum(weights, 0), np.float32)
