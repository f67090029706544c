"""How a picture is cut for transforms, and put together again.

A float FFT errs by some 1e-7 of the brightest lamp all over its tile. So a large kernel goes in two
parts: its middle with small tiles, where an error stays next to the lamp, and the faint rest with
large ones.
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

#: bytes that the spectra of kernels and of one tile may take together
SPECTRA_BYTES = 640 << 20
MIDDLE = 65  # px across, of the part of a large kernel that goes by itself
SMALL_TILE = 4 * MIDDLE  # points across transforms for small kernels
ROWS = 1024  # that a band reads at most, or twice the kernel's if that is more
SMALL = 1 << 17  # points of a transform that is left to one thread

Size = tuple[int, int]


def parts_of(kernels: Real, picture: Size, threads: int, *, banded: bool) -> list[Part]:
    """The kernels, or their middle and the rest of them, ready for a picture."""
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
        picture: Rows and columns.
        threads: Number of threads.
        banded: One tile has all rows that are read for a block of rows.
        without: Part of the kernels that does not count.
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
        """Adds to rows ``wanted`` the light that begins at the row ``first``."""
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
            # Tiles are added one after the other in their order: the bits do not depend on threads.
            if self._threads > 1 and len(row) > 1:
                with ThreadPoolExecutor(self._threads) as pool:
                    made = list(pool.map(alone, row))
                for place, planes in zip(row, made, strict=True):
                    self._put(out, planes, place, wanted)
            else:
                for place in row:
                    self._put(out, tile(place, space), place, wanted)

    def _tiles(self, read: Rows, width: int) -> Iterator[list[Tile]]:
        """Tiles that cover these rows, by rows; they begin at the same rows whatever is read."""
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
        """Rows that a tile's light reaches, of those that are wanted."""
        h = self._size[0]
        top, bottom = place.rows.start - h // 2, place.rows.stop + h - 1 - h // 2
        return Rows(max(top, wanted.begin), min(bottom, wanted.end))

    def _spread(
        self, light: Real, place: Tile, wanted: Rows, space: _Space
    ) -> Iterator[tuple[int, Real]]:
        """Spreads a tile's light, by channel: rows that it reaches, columns around."""
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
        """Part of a tile's light that a zone spreads."""
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
        """Adds what a tile became where it lies in the frame."""
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
    """Memory for tiles, one after the other: new pages cost as much as the sums on them.

    Args:
        fft: The transforms.
        outs: Channels that are made.
        shared: Whether one channel's result is done with before the next one is made.
    """

    def __init__(self, fft: Fft2, outs: int, *, shared: bool) -> None:
        self.spectrum = np.empty(fft.spectrum_shape, np.complex64)
        self.sums = [np.empty(fft.spectrum_shape, np.complex64) for _ in range(outs)]
        self._results = [np.empty(fft.shape, np.float32) for _ in range(1 if shared else outs)]

    def result(self, j: int) -> Real:
        """For the channel j."""
        return self._results[j % len(self._results)]


class Plan(NamedTuple):
    """How a picture is cut.

    Attributes:
        shape: Shape of the transforms.
        tile: Rows and columns that one of them takes.
    """

    shape: Size
    tile: Size


def plan(
    picture: Size, kernel: Size, zones: Size, channels: Size, *, most_rows: int | None = None
) -> Plan:
    """The least work whose spectra fit into memory; small kernels get small tiles.

    Args:
        picture: Rows and columns.
        kernel: The same of a kernel.
        zones: Zones of kernels, down and across.
        channels: Number of channels from which, and to which, light goes.
        most_rows: About how many rows may be read for one band; None: as many as there are.
    """
    ins, outs = channels
    count = zones[0] * zones[1] * ins * outs
    # A point of a transform has half a number of a spectrum: 2 bytes real, 4 complex.
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
    """An axis in equal tiles: their extent, the transform's, how many, and zones of all of them."""

    tile: int
    length: int
    tiles: int
    zones: int


def _cuts(extent: int, reach: int, zones: int, most: int) -> list[_Cut]:
    """Ways to cut an axis, from the narrowest tiles that make sense to one of all of it."""
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
    """Weights of zones over the pixels along an axis, shape (zones, count): they add up to 1."""
    if zones == 1:
        return np.ones((1, count), np.float32)
    at = (np.arange(count) + 0.5) / count * (zones - 1)
    weights = 1 - np.abs(at - np.arange(zones)[:, None])
    return np.asarray(np.maximum(weights, 0), np.float32)
