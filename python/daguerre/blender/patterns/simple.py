"""Wave, Gradient, Magic, Brick and Checker textures.

Source: Cycles, ``kernel/svm/wave.h``, ``gradient.h``, ``magic.h``, ``brick.h`` and ``checker.h``
(Apache-2.0).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .fractals import Octaves, fbm
from .hashes import Numbers

Array = NDArray[np.float32]
_TURN = np.float32(2 * np.pi)
_HALF = np.float32(0.5)
#: Phase of a wave for a unit of its coordinate, and of a diagonal wave.
_PHASE, _DIAGONAL = np.float32(20), np.float32(10)
#: Shift and factor that keep whole coordinates off the edge of a cell.
_SHIFT, _SHRINK = np.float32(0.000001), np.float32(0.999999)
_AXES = "XYZ"


def _off_edges(axis: Array) -> Array:
    return (axis + _SHIFT) * _SHRINK


@dataclass(frozen=True)
class Wave:
    """Parameters of a wave; numbers or arrays (N,) but for the names.

    Attributes:
        rings: Whether it has rings, and not bands.
        direction: "X", "Y", "Z", "DIAGONAL" or "SPHERICAL".
        profile: "SIN", "SAW" or "TRI".
        phase: Angle that is added.
        distortion: How far noise shifts the phase.
        octaves: The noise.
        scale: Factor on the coordinates of the noise.
    """

    rings: bool
    direction: str
    profile: str
    phase: Numbers
    distortion: Numbers
    octaves: Octaves
    scale: Numbers


def wave(point: list[Array], given: Wave) -> Array:
    """Wave Texture: 0 .. 1."""
    point = [_off_edges(axis) for axis in point]
    angle = _rings(point, given.direction) if given.rings else _bands(point, given.direction)
    angle = angle + given.phase
    if np.any(given.distortion):
        noise = fbm([axis * given.scale for axis in point], given.octaves)
        angle = angle + given.distortion * (noise * np.float32(2) - np.float32(1))
    if given.profile == "SIN":
        return np.asarray(_HALF + _HALF * np.sin(angle - np.float32(np.pi / 2)))
    turns = angle / _TURN
    if given.profile == "SAW":
        return np.asarray(turns - np.floor(turns))
    return np.asarray(np.abs(turns - np.floor(turns + _HALF)) * np.float32(2))


def _bands(point: list[Array], direction: str) -> Array:
    if direction in _AXES:
        return point[_AXES.index(direction)] * _PHASE
    return (point[0] + point[1] + point[2]) * _DIAGONAL


def _rings(point: list[Array], direction: str) -> Array:
    across = [axis for axis, name in zip(point, _AXES, strict=True) if name != direction]
    return np.asarray(np.sqrt(sum(axis * axis for axis in across)) * _PHASE)


def gradient(point: list[Array], kind: str) -> Array:
    """Gradient Texture: 0 .. 1."""
    x, y, z = point
    ball = np.maximum(_SHRINK - np.sqrt(x * x + y * y + z * z), 0)
    choices: dict[str, Callable[[], Any]] = {
        "LINEAR": lambda: x,
        "QUADRATIC": lambda: np.maximum(x, 0) ** 2,
        "EASING": lambda: _eased(np.clip(x, 0, 1)),
        "DIAGONAL": lambda: (x + y) * _HALF,
        "RADIAL": lambda: np.arctan2(y, x) / _TURN + _HALF,
        "QUADRATIC_SPHERE": lambda: ball * ball,
        "SPHERICAL": lambda: ball,
    }
    return np.asarray(np.clip(choices[kind](), 0, 1))


def _eased(t: Numbers) -> Numbers:
    return t * t * (np.float32(3) - np.float32(2) * t)


#: Turns of the Magic Texture after the first: the channel that changes, the function and the signs
#: of the three channels in its argument, and the sign of the result.
_TURNS = (
    (1, np.cos, (1, -1, 1), -1),
    (0, np.cos, (1, -1, -1), 1),
    (2, np.sin, (-1, -1, -1), 1),
    (0, np.cos, (-1, 1, -1), -1),
    (1, np.sin, (-1, 1, 1), -1),
    (1, np.cos, (-1, 1, 1), -1),
    (0, np.cos, (1, 1, 1), 1),
    (2, np.sin, (1, 1, -1), 1),
    (0, np.cos, (-1, -1, 1), -1),
    (1, np.sin, (1, -1, 1), -1),
)


def magic(point: list[Array], scale: Numbers, distortion: Numbers, depth: int) -> list[Array]:
    """Magic Texture: three channels.

    Args:
        point: Coordinates, three arrays (N,).
        scale: Factor on them, a number or array.
        distortion: Size of the channels inside the functions, a number or array.
        depth: Number of turns, 0 .. 10.
    """
    x, y, z = (np.fmod(axis, _TURN) for axis in point)
    factor = np.float32(5)
    found: list[Any] = [
        np.sin((x + y + z) * factor * scale),
        np.cos((-x + y - z) * factor * scale),
        -np.cos((-x - y + z) * factor * scale),
    ]
    if depth > 0:
        found = [one * distortion for one in found]
    for channel, function, signs, sign in _TURNS[:depth]:
        inner = sum(np.float32(s) * one for s, one in zip(signs, found, strict=True))
        found[channel] = np.float32(sign) * function(inner) * distortion
    divisor = np.where(np.asarray(distortion) != 0, np.asarray(distortion) * 2, 1)
    return [_HALF - one / divisor.astype(np.float32) for one in found]


@dataclass(frozen=True)
class Bricks:
    """Parameters of a wall; numbers or arrays (N,) but for the whole numbers.

    Attributes:
        mortar: Width of the mortar.
        smooth: Part of the mortar over which it fades.
        bias: Amount that is added to the tint.
        width: Width of a brick.
        height: Height of a row.
        offset: Shift of every ``offset_rows``-th row, in bricks.
        offset_rows: See ``offset``; 0: no row is shifted or squashed.
        squash: Factor on the width in all rows but every ``squash_rows``-th row.
        squash_rows: See ``squash``.
    """

    mortar: Numbers
    smooth: Numbers
    bias: Numbers
    width: Numbers
    height: Numbers
    offset: float
    offset_rows: int
    squash: float
    squash_rows: int


def bricks(point: list[Array], wall: Bricks) -> tuple[Array, Array]:
    """Brick Texture: tint of the brick, and share of the mortar, both 0 .. 1."""
    row = _whole(point[1] / wall.height)
    width: Numbers = np.broadcast_to(np.asarray(wall.width, np.float32), row.shape)
    shift: Numbers = np.zeros(row.shape, np.float32)
    if wall.offset_rows and wall.squash_rows:
        squashed = row % wall.squash_rows == 0
        width = np.where(squashed, width * np.float32(wall.squash), width)
        shift = np.where(row % wall.offset_rows == 0, width * np.float32(wall.offset), shift)
    along = point[0] + shift
    brick = _whole(along / width)
    x, y = along - width * brick.astype(np.float32), point[1] - wall.height * row.astype(np.float32)
    word = (row.astype(np.uint32) << np.uint32(16)) + (brick.astype(np.uint32) & np.uint32(0xFFFF))
    tint = np.clip(_brick_noise(word) + wall.bias, 0, 1)
    edge = np.minimum(np.minimum(x, y), np.minimum(width - x, wall.height - y))
    inner = np.float32(1) - edge / wall.mortar
    fade = np.asarray(wall.smooth, np.float32)
    soft = _eased(np.clip(inner / np.where(fade != 0, fade, np.float32(1)), 0, 1))
    share = np.where(fade != 0, soft, np.float32(1))
    return tint, np.where(edge >= wall.mortar, np.float32(0), share)


def _whole(values: Array) -> NDArray[np.int32]:
    return np.asarray(np.floor(values)).astype(np.int32)


def _brick_noise(word: NDArray[np.uint32]) -> Array:
    """Fraction of a brick's number."""
    word = (word + np.uint32(1013)) & np.uint32(0x7FFFFFFF)
    word ^= word >> np.uint32(13)
    more = word * (word * word * np.uint32(60493) + np.uint32(19990303)) + np.uint32(1376312589)
    return (more & np.uint32(0x7FFFFFFF)).astype(np.float32) * np.float32(0.5 / 1073741824)


def checker(point: list[Array]) -> Array:
    """Checker Texture: 1 in the cells of the first colour, else 0."""
    x, y, z = (_whole(_off_edges(axis)) % 2 for axis in point)
    return np.asarray(((x == y) == (z == 1)).astype(np.float32))
