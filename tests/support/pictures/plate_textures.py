"""Light of plates with fine texture and hardly a flat part: a floor, fabric, leaves, a wall."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

FloatArray = NDArray[np.float64]
SHAPE = (608, 896)
#: Rows of ``with_strip`` that are flat.
STRIP = 96


def pale_floor() -> FloatArray:
    """The same with squares that are nearly alike."""
    return 0.33 + 0.19 * floor()


def floor() -> FloatArray:
    """A checkered floor up to its horizon, turned by 17 degrees; far squares are below a pixel."""
    height, width = SHAPE
    finer, horizon = 8, -60.0
    total = np.zeros(SHAPE)
    for i in range(finer):
        for j in range(finer):
            y, x = np.mgrid[:height, :width] + np.reshape([i + 0.5, j + 0.5], (2, 1, 1)) / finer
            depth = 500 / (y - horizon)
            side, ahead = (x - width / 2) / 20 * depth, depth * 20
            along = side * np.cos(0.3) + ahead * np.sin(0.3)
            across = ahead * np.cos(0.3) - side * np.sin(0.3)
            total += np.where((np.floor(along) + np.floor(across)) % 2 == 0, 0.9, 0.1)
    return _seen(total / finer**2)


def weave() -> FloatArray:
    """Fabric with threads 5.3 and 5.9 px apart, in folds."""
    y, x = np.mgrid[: SHAPE[0], : SHAPE[1]]
    threads = np.sin(2 * np.pi * x / 5.3) + np.sin(2 * np.pi * y / 5.9)
    return np.asarray(0.3 * np.exp(0.4 * _noise(60, 3)) * (1 + 0.15 * threads))


def grating() -> FloatArray:
    """Sines that cross, 4 and 5.2 px, of growing light."""
    y, x = np.mgrid[: SHAPE[0], : SHAPE[1]]
    along, across = x * 0.94 + y * 0.342, y * 0.94 - x * 0.342
    sines = np.sin(2 * np.pi * along / 4) * np.sin(2 * np.pi * across / 5.2)
    return np.asarray((0.1 + 0.6 * x / SHAPE[1]) * (1 + 0.5 * sines))


def leaves() -> FloatArray:
    """Discs of all sizes that hide each other (dead leaves)."""
    random = np.random.default_rng(6)
    light = np.full(SHAPE, 0.3)
    for _ in range(6000):
        radius = min(1.2 / (np.sqrt(random.random()) + 0.02), 40)
        at_x, at_y = random.random(2) * SHAPE[::-1]
        tone = 0.05 + 0.7 * random.random() ** 2
        rows = slice(max(int(at_y - radius), 0), int(at_y + radius + 2))
        columns = slice(max(int(at_x - radius), 0), int(at_x + radius + 2))
        y, x = np.ogrid[: SHAPE[0], : SHAPE[1]]
        disc = (y[rows] - at_y) ** 2 + (x[:, columns] - at_x) ** 2 < radius**2
        light[rows, columns][disc] = tone
    return _seen(light)


def bricks() -> FloatArray:
    """A wall of bricks of 46 x 18 px, each with a tone of its own, rough."""
    y, x = np.mgrid[: SHAPE[0], : SHAPE[1]]
    row = y // 18
    column = (x + row % 2 * 23) // 46
    tone = 0.25 + 0.2 * np.random.default_rng(8).random((64, 64))[row % 64, column % 64]
    joint = (y % 18 < 2) | ((x + row % 2 * 23) % 46 < 2)
    return _seen(np.where(joint, 0.6, tone) * (1 + 0.1 * _noise(1, 9)))


def foliage() -> FloatArray:
    """Fractal noise, its amplitude by the inverse of the frequency."""
    spectrum = np.fft.rfft2(np.random.default_rng(5).standard_normal(SHAPE))
    frequency = np.hypot(np.fft.fftfreq(SHAPE[0])[:, None], np.fft.rfftfreq(SHAPE[1]))
    frequency[0, 0] = 1
    rough = np.fft.irfft2(spectrum / frequency, SHAPE)
    return _seen(np.clip(0.2 * np.exp(0.5 * rough / rough.std()), 0, 0.95))


def grass() -> FloatArray:
    """Even, random texture of a pixel, of growing light: nothing but its colours tells it."""
    x = np.arange(SHAPE[1]) / SHAPE[1]
    return np.asarray((0.1 + 0.6 * x) * np.exp(0.1 * _noise(0.7, 7)))


TEXTURES: dict[str, Callable[[], FloatArray]] = {
    one.__name__: one for one in (floor, pale_floor, weave, grating, leaves, bricks, foliage, grass)
}


def with_strip(light: FloatArray) -> FloatArray:
    """The same with a flat gradient along its upper edge."""
    made = light.copy()
    made[:STRIP] = np.linspace(0.05, 0.8, SHAPE[1])
    return made


def _noise(sigma: float, seed: int) -> FloatArray:
    """Normal numbers of variance 1, blurred."""
    rough = ndimage.gaussian_filter(np.random.default_rng(seed).standard_normal(SHAPE), sigma)
    return np.asarray(rough / rough.std())


def _seen(light: FloatArray) -> FloatArray:
    """Light through a lens that blurs by half a pixel."""
    return np.asarray(ndimage.gaussian_filter(light, 0.5, mode="nearest"))
