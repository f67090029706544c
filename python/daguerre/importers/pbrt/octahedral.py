"""Equal-area maps of the sphere: a square with +z at its middle and -z at its corners.

Source: Clarberg 2008, Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD; Pharr, Jakob and
Humphreys 2023, section 3.8.3.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def square_of(directions: Array) -> tuple[Array, Array]:
    """Place of directions in the square: s to the right and t downward, 0 .. 1.

    Args:
        directions: Unit vectors, shape (..., 3).
    """
    x, y, z = np.abs(directions[..., 0]), np.abs(directions[..., 1]), directions[..., 2]
    radius = np.sqrt(np.maximum(1 - np.abs(z), 0))
    angle = np.arctan2(y, x) * (2 / np.pi)
    v = angle * radius
    u = radius - v
    below = z < 0
    u, v = np.where(below, 1 - v, u), np.where(below, 1 - u, v)
    s, t = np.copysign(u, directions[..., 0]), np.copysign(v, directions[..., 1])
    return np.clip(0.5 * (s + 1), 0, 1), np.clip(0.5 * (t + 1), 0, 1)


def directions_of(s: Array, t: Array) -> Array:
    """Unit vectors of places in the square, shape (..., 3); the inverse of :func:`square_of`."""
    u, v = 2 * np.asarray(s) - 1, 2 * np.asarray(t) - 1
    across, down = np.abs(u), np.abs(v)
    inside = 1 - (across + down)
    radius = 1 - np.abs(inside)
    share = np.divide(down - across, radius, out=np.zeros_like(radius), where=radius > 0)
    angle = (share + 1) * (np.pi / 4)
    z = np.copysign(1 - radius**2, inside)
    flat = radius * np.sqrt(np.maximum(2 - radius**2, 0))
    x = np.copysign(np.cos(angle), u) * flat
    y = np.copysign(np.sin(angle), v) * flat
    return np.stack([x, y, z], axis=-1)


def panorama_of(image: NDArray[np.float32], turn: Array) -> NDArray[np.float32]:
    """Makes a panorama of an equal-area map.

    The light of pixels is kept: bright pixels are splatted over the pixels that they cover, the
    rest is looked up.

    Args:
        image: Shape (N, N, 3).
        turn: Scene from the map's space, orthogonal, shape (3, 3).

    Returns:
        Shape (N, 2 N, 3), as ``Scene.set_environment`` takes it.
    """
    size = len(image)
    rows = max(size, 8)
    light = image.max(axis=2)
    cut = np.float32(max(_BRIGHT * float(np.median(light)), _highest(light), 1e-30))
    bright = light > cut
    dim = np.where(bright[..., None], image * (cut / np.maximum(light, cut))[..., None], image)
    made = _looked_up(dim.astype(np.float32), turn, rows)
    _spread(image - dim, bright, turn, made)
    return made


#: Pixels that are this many times as bright as the median are spread, up to a number of them.
_BRIGHT, _MOST_BRIGHT = 16.0, 1 << 15
#: Parts of a bright pixel, and samples of a pixel of the panorama, along each side.
_PARTS, _SAMPLES = 16, 3
_ROWS = 16


def _highest(light: NDArray[np.float32]) -> float:
    """Light that no more than ``_MOST_BRIGHT`` pixels exceed."""
    if light.size <= _MOST_BRIGHT:
        return 0.0
    place = light.size - 1 - _MOST_BRIGHT
    return float(np.partition(light.reshape(-1), place)[place])


def _looked_up(image: NDArray[np.float32], turn: Array, rows: int) -> NDArray[np.float32]:
    size, columns = len(image), 2 * rows
    made = np.empty((rows, columns, 3), np.float32)
    fine = (np.arange(columns * _SAMPLES) + 0.5) / (columns * _SAMPLES)
    longitude = (fine - 0.5) * 2 * np.pi
    for row in range(0, rows, _ROWS):
        count = min(_ROWS, rows - row)
        high = (row + (np.arange(count * _SAMPLES) + 0.5) / _SAMPLES) / rows
        latitude = (0.5 - high[:, None]) * np.pi
        flat = np.cos(latitude)
        ways = np.stack(
            [
                flat * np.sin(longitude),
                np.broadcast_to(np.sin(latitude), (len(high), len(fine))),
                -flat * np.cos(longitude),
            ],
            axis=-1,
        )
        s, t = square_of(ways @ turn)
        x, y = (np.minimum((place * size).astype(np.int64), size - 1) for place in (s, t))
        samples = image[y, x].reshape(count, _SAMPLES, columns, _SAMPLES, 3)
        made[row : row + count] = samples.mean(axis=(1, 3))
    return made


def _spread(
    light: NDArray[np.float32], bright: NDArray[np.bool_], turn: Array, made: NDArray[np.float32]
) -> None:
    """Adds bright pixels of a map to a panorama, part by part."""
    size, (rows, columns) = len(light), made.shape[:2]
    y, x = np.nonzero(bright)
    parts = (np.arange(_PARTS) + 0.5) / _PARTS
    edges = np.sin((0.5 - np.arange(rows + 1) / rows) * np.pi)
    solid = (edges[:-1] - edges[1:]) * (2 * np.pi / columns)
    share = 4 * np.pi / (size * size * _PARTS * _PARTS)
    for begin in range(0, len(x), 1 << 12):
        chosen = slice(begin, begin + (1 << 12))
        s = (x[chosen, None, None] + parts[None, None, :]) / size
        t = (y[chosen, None, None] + parts[None, :, None]) / size
        ways = directions_of(*np.broadcast_arrays(s, t)) @ turn.T
        row = np.arccos(np.clip(ways[..., 1], -1, 1)) / np.pi * rows
        row = np.minimum(row.astype(np.int64), rows - 1)
        column = (np.arctan2(ways[..., 0], -ways[..., 2]) / (2 * np.pi) + 0.5) * columns
        column = np.minimum(column.astype(np.int64), columns - 1)
        flat = (row * columns + column).reshape(-1)
        each = np.repeat(light[y[chosen], x[chosen]], _PARTS * _PARTS, axis=0)
        for channel in range(3):
            sums = np.bincount(flat, each[:, channel] * share, rows * columns)
            made[..., channel] += (sums.reshape(rows, columns) / solid[:, None]).astype(np.float32)
