"""How far pictures agree that shall be the same: light, relMSE, and where details lie."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from sheet import Floats, colours, cut, read
from ways import Word

Figures = dict[str, float | str]


def agreement(word: Word, folder: Path) -> list[Figures]:
    """The figures of each picture against the first of its row; the first has its noise."""
    found: list[Figures] = []
    for row in word.rows:
        planes, window = read(folder / f"{row[0].file}.exr")
        truth = colours(planes, row[0].layer)
        noise = math.nan if row[0].layer else _noise(planes, truth)  # of a layer it is not known
        first: Figures = {"picture": row[0].caption, "noise": noise}
        found.append(first | (fringes(truth) if word.fringes else {}))
        for panel in row[1:]:
            if panel.none:
                continue
            planes, have = read(folder / f"{panel.file}.exr")
            other = cut(colours(planes, panel.layer), have, window)
            figures: Figures = {"picture": panel.caption, **compare(truth, other)}
            found.append(figures | (fringes(other) if word.fringes else {}))
    return found


def compare(truth: Floats, other: Floats) -> dict[str, float]:
    """Light of one picture over that of another, relMSE, and displacement, px."""
    error = (other - truth) ** 2 / (truth**2 + 0.01)
    return {
        "light": float(other.sum(dtype=float) / truth.sum(dtype=float)),
        "relmse": float(error.mean(dtype=float)),
        "moved": displacement(truth, other),
    }


def _noise(planes: dict[str, Floats], image: Floats) -> float:
    """The relMSE that the picture's own noise accounts for."""
    if "variance.R" not in planes:
        return math.nan
    return float((colours(planes, "variance") / (image**2 + 0.01)).mean(dtype=float))


def fringes(image: Floats) -> dict[str, float]:
    """How far red and blue lie from green, over the whole picture, px."""
    red, green, blue = (_smooth(np.cbrt(np.maximum(image[:, :, k], 0))) for k in range(3))
    y, x = (np.arange(8, n - 8) for n in image.shape[:2])
    moved = {"red": _shift(green, red, y, x), "blue": _shift(green, blue, y, x)}
    return {name: math.hypot(*at) if at else math.nan for name, at in moved.items()}


def displacement(truth: Floats, other: Floats, across: int = 6, down: int = 4) -> float:
    """How far details lie from where they should, px: the largest mean of a block of the picture.

    By the method of Lucas and Kanade 1981: the shift under which the difference of the pictures is
    what their slopes make of it, repeated from where it led; it holds for a few pixels. Blocks
    without detail in both directions, and those in which nothing fits, are left out.
    """
    one, two = (_smooth(np.cbrt(np.maximum(image.mean(axis=2), 0))) for image in (truth, other))
    rows = np.array_split(np.arange(8, one.shape[0] - 8), down)
    columns = np.array_split(np.arange(8, one.shape[1] - 8), across)
    found = [_shift(one, two, y, x) for y in rows for x in columns]
    return max((math.hypot(*shift) for shift in found if shift is not None), default=math.nan)


def _shift(
    one: Floats, two: Floats, y: NDArray[np.int64], x: NDArray[np.int64]
) -> tuple[float, float] | None:
    """Shift of one block, px to the right and down."""
    block = np.ix_(y, x)
    slope_y, slope_x = (slope[block].ravel() for slope in np.gradient(one))
    slopes = np.stack([slope_x, slope_y], 1)
    normal = slopes.T @ slopes
    if np.linalg.eigvalsh(normal)[0] < 1e-5 * len(slopes):
        return None
    at = np.zeros(2)
    for _ in range(12):
        difference = (_between(two, y + at[1], x + at[0]) - one[block]).ravel()
        at -= np.linalg.solve(normal, slopes.T @ difference)
        if not np.abs(at).max() < 6:
            return None
    return float(at[0]), float(at[1])


def _between(image: Floats, y: NDArray[np.float64], x: NDArray[np.float64]) -> Floats:
    """Values between pixels, linearly."""
    for axis, at in ((0, y), (1, x)):
        at = np.clip(at, 0, image.shape[axis] - 1.001)
        low = np.floor(at).astype(int)
        part = (at - low).astype(np.float32)
        part = part[:, None] if axis == 0 else part[None, :]
        before, after = (np.take(image, low + k, axis=axis) for k in (0, 1))
        image = before + part * (after - before)
    return image


def _smooth(image: Floats) -> Floats:
    """A Gaussian of 1.5 px, so that slopes reach beyond a pixel."""
    x = np.arange(-5, 6)
    kernel = np.exp(-(x**2) / 4.5)
    kernel /= kernel.sum()
    for axis in (0, 1):
        image = np.apply_along_axis(np.convolve, axis, image, kernel, "same")
    return image
