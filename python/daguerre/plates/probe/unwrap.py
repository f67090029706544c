"""Unwraps photographs of a mirror ball from one or more directions to a single environment.

If two photographs show a direction, the better photograph shows it neither near the camera's
reflection nor near the rim, where the ball compresses a whole quarter of the surroundings.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .ball import Ball
from .latlong import FloatArray, directions
from .sampling import between

#: Angles from the camera between which its own reflection fades out, degrees.
PHOTOGRAPHER = (8.0, 25.0)
#: Angles from the camera between which the rim fades out, degrees.
RIM = (110.0, 165.0)
#: Least weight, for directions that another photograph shows better.
LEAST = 1e-4
_ROWS = 16


@dataclass(frozen=True)
class SeenBall:
    """A photograph of a ball.

    Attributes:
        light: Linear light, shape (H, W, 3).
        clipped: Mask of clipped pixels, shape (H, W).
        ball: The ball in the camera's frame.
        world_from_camera: Rotation, shape (3, 3).
    """

    light: NDArray[np.float32]
    clipped: NDArray[np.bool_]
    ball: Ball
    world_from_camera: FloatArray


@dataclass(frozen=True)
class Unwrapped:
    """Environment: light (H, W, 3), masks of clipped pixels and of pixels that no ball shows."""

    light: NDArray[np.float32]
    clipped: NDArray[np.bool_]
    unseen: NDArray[np.bool_]


def usual_width(seen: list[SeenBall]) -> int:
    """Width for about one pixel of the environment per pixel at the middle of the ball."""
    circumference = math.pi * max(one.ball.circle[2] for one in seen)
    return int(min(max(2 ** math.ceil(math.log2(circumference)), 256), 8192))


def unwrap(seen: list[SeenBall], width: int, height: int) -> Unwrapped:
    """Unwraps mirror balls to an environment; pixels are means.

    Args:
        seen: Photographs with a common scale of light.
        width: Columns, px.
        height: Rows, px.
    """
    light = np.empty((height, width, 3), np.float32)
    clipped, unseen = (np.zeros((height, width), bool) for _ in range(2))
    density = max(one.ball.circle[2] for one in seen) * math.pi / width
    fine = min(max(2, math.ceil(density) + 1), 8)
    for row in range(0, height, _ROWS):
        rows = slice(row, min(row + _ROWS, height))
        light[rows], clipped[rows], unseen[rows] = _rows(seen, (width, height), rows, fine)
    return Unwrapped(light, clipped, unseen)


def _rows(
    seen: list[SeenBall], size: tuple[int, int], rows: slice, fine: int
) -> tuple[NDArray[np.float32], NDArray[np.bool_], NDArray[np.bool_]]:
    """Makes rows of the environment, each pixel from fine x fine samples."""
    width, height = size
    count = rows.stop - rows.start
    x = (np.arange(width * fine) + 0.5) / fine
    y = rows.start + (np.arange(count * fine) + 0.5) / fine
    world = directions(width, height, *np.meshgrid(x, y)).reshape(-1, 3)
    sums, total, over = np.zeros((len(world), 3)), np.zeros(len(world)), np.zeros(len(world))
    hidden = np.ones(len(world), bool)
    for one in seen:
        places, angle = one.ball.mirrored(world @ one.world_from_camera)
        weight = _weight(np.degrees(angle))
        at = (places[:, 0], places[:, 1])
        sums += weight[:, None] * between(one.light, *at)
        over += weight * (between(one.clipped.astype(np.float32), *at) > 0.01)
        total += weight
        hidden &= np.degrees(angle) > 180 - one.ball.unseen_deg
    shape = (count, fine, width, fine)
    light = (sums / total[:, None]).reshape((*shape, 3)).mean(axis=(1, 3))
    share = (over / total).reshape(shape).mean(axis=(1, 3))
    return light.astype(np.float32), share > 0.25, hidden.reshape(shape).mean(axis=(1, 3)) > 0.5


def _weight(angle: FloatArray) -> FloatArray:
    """Weight of directions by their angle from the camera, degrees."""
    return np.asarray(_rise(angle, *PHOTOGRAPHER) * (1 - _rise(angle, *RIM)) + LEAST)


def _rise(value: FloatArray, low: float, high: float) -> FloatArray:
    """Smooth step from 0 at ``low`` to 1 at ``high``."""
    t = np.clip((value - low) / (high - low), 0, 1)
    return np.asarray(t * t * (3 - 2 * t))
