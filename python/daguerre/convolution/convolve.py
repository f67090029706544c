"""Convolution of linear pictures with large kernels: bloom, stars, diffraction, PSFs of lenses.

Each pixel spreads its light (it does not gather). A kernel with sum 1 keeps all light except light
that leaves the frame, which is lost as in a camera. FFTs work on tiles that overlap when they are
added, or on bands of rows that overlap when they are read (overlap-add, overlap-save: Stockham
1966, High-speed convolution and correlation).
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from daguerre.argument_checks import guarded
from daguerre.errors import UsageError

from .fft import Real, thread_count
from .overlap import Part, parts_of
from .rows import Rows


class Spread(Protocol):
    """Spreads the light of a picture, some rows at a time.

    Attributes:
        reach: Rows read above and below each output row.
        block: Rows computed at a time.
    """

    reach: int
    block: int

    def rows(self, light: Real, first: int, wanted: Rows) -> Real:
        """Computes rows ``wanted`` from light (h, W, I) that begins at row ``first``."""


class Spreader:
    """Spreads the light of a picture by kernels that are transformed once.

    Args:
        kernels: Shape (Y, X, h, w, J, I), from channel i to j, on a regular grid from edge to edge
            of the frame (a single kernel: at its centre); blended linearly between grid points.
        picture: Rows and columns of the picture.
        threads: Number of threads; 0: the number of cores.
        banded: Whether to compute ``block`` rows at a time; else the whole picture at once.
    """

    def __init__(
        self, kernels: Real, picture: tuple[int, int], *, threads: int = 0, banded: bool = True
    ) -> None:
        self.reach = kernels.shape[2] // 2
        self._parts: list[Part] = parts_of(kernels, picture, thread_count(threads), banded=banded)
        self.block = self._parts[-1].block if banded else picture[0]
        self._height, self._outs = picture[0], kernels.shape[4]

    def rows(self, light: Real, first: int, wanted: Rows, out: Real | None = None) -> Real:
        """Spreads light.

        Args:
            light: Shape (h, W, I); all rows of the picture that reach ``wanted``.
            first: First row of ``light`` in the picture.
            wanted: Rows to compute.
            out: Array to overwrite with the result; None: a new array.

        Returns:
            Shape (rows, W, J), float32; values that are not finite stay (if J = I).
        """
        whole = bool(np.isfinite(light).all())
        known = light if whole else np.where(np.isfinite(light), light, np.float32(0))
        if out is None:
            out = np.empty((wanted.end - wanted.begin, light.shape[1], self._outs), np.float32)
        out[:] = 0
        for begin in range(wanted.begin, wanted.end, self.block):
            rows = Rows(begin, min(begin + self.block, wanted.end))
            some = out[rows.begin - wanted.begin : rows.end - wanted.begin]
            for part in self._parts:
                part.add(some, rows, known, first)
        if not whole and light.shape[2] == self._outs:
            here = light[wanted.begin - first : wanted.end - first]
            np.copyto(out, here, where=~np.isfinite(here))
        return out


class EachSpreader:
    """Spreads each channel by its own kernel, channel by channel.

    Args:
        kernel: Shape (h, w, C), or (h, w, 1) for all channels.
        picture: Rows and columns of the picture.
        threads: Number of threads; 0: the number of cores.
        banded: Whether light comes in bands of rows; see ``Spreader``.
    """

    def __init__(
        self, kernel: Real, picture: tuple[int, int], *, threads: int = 0, banded: bool = True
    ) -> None:
        how = {"threads": threads, "banded": banded}
        self._each = [
            Spreader(kernel[None, None, :, :, c, None, None], picture, **how)  # type: ignore[arg-type]
            for c in range(kernel.shape[2])
        ]
        self.reach, self.block = self._each[0].reach, self._each[0].block

    def rows(self, light: Real, first: int, wanted: Rows) -> Real:
        """Spreads rows; see ``Spreader``."""
        out = np.empty((wanted.end - wanted.begin, *light.shape[1:]), np.float32)
        for c in range(light.shape[2]):
            one = self._each[c % len(self._each)]
            out[:, :, c] = one.rows(light[:, :, c, None], first, wanted)[:, :, 0]
        return out


def spreader_of(
    kernel: ArrayLike, picture: tuple[int, ...], *, threads: int = 0, banded: bool = True
) -> Spread:
    """Returns a spreader for pictures (H, W, C), by a kernel of a shape that ``convolve`` takes."""
    count = picture[2]
    k = np.asarray(kernel, np.float32)
    if k.ndim == 2:
        k = k[:, :, None]
    known = k.ndim in (3, 4) and k.shape[2] in (1, count) and (k.ndim < 4 or k.shape[3] == count)
    if not known or 0 in k.shape:
        raise UsageError(
            f"convolve: kernel: wanted (h, w), (h, w, {count}) or (h, w, {count}, {count}), "
            f"got {np.shape(kernel)}"
        )
    size = picture[0], picture[1]
    if k.ndim == 4:
        return Spreader(k[None, None], size, threads=threads, banded=banded)
    return EachSpreader(k, size, threads=threads, banded=banded)


@guarded
def convolve(image: ArrayLike, kernel: ArrayLike, *, threads: int = 0) -> Real:
    """Convolves a picture: spreads each pixel's light by a kernel.

    Args:
        image: Linear, shape (H, W) or (H, W, C). NaN and infinite values spread no light and stay.
        kernel: Shape (h, w): a kernel for all channels; (h, w, C): a kernel for each channel;
            (h, w, C, C): from each channel (last axis) to each (axis 2). The centre is at
            (h // 2, w // 2).
        threads: Number of threads; 0: the number of cores.

    Returns:
        float32, the shape of the image.

    Raises:
        UsageError: ``image`` or ``kernel`` has another shape, or is empty.
    """
    picture = np.asarray(image, np.float32)
    if picture.ndim not in (2, 3) or 0 in picture.shape:
        raise UsageError(f"convolve: image: wanted shape (H, W) or (H, W, C), got {picture.shape}")
    planes = picture[:, :, None] if picture.ndim == 2 else picture
    whole = Rows(0, len(planes))
    done = spreader_of(kernel, planes.shape, threads=threads, banded=False)
    return done.rows(planes, 0, whole).reshape(picture.shape)


def spread(planes: Real, kernels: Real, *, threads: int = 0, out: Real | None = None) -> Real:
    """Spreads the light of a picture by kernels that change over the frame.

    Args:
        planes: Shape (H, W, I).
        kernels: Shape (Y, X, h, w, J, I); see ``Spreader``.
        threads: Number of threads; 0: the number of cores.
        out: Array to overwrite with the result; None: a new array.

    Returns:
        Shape (H, W, J), float32; values that are not finite stay (if J = I).
    """
    size = planes.shape[0], planes.shape[1]
    done = Spreader(kernels, size, threads=threads, banded=False)
    return done.rows(planes, 0, Rows(0, size[0]), out)
