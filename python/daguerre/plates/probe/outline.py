"""Finds the outline of a ball in a photograph: a Hough transform, then a fit to the rim.

Each edge pixel votes along its gradient, for every radius, for the centre of its circle (Duda and
Hart, CACM 15 (1972) 11; with gradients Kimme, Ballard and Sklansky, CACM 18 (1975) 120).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import InputError

from .ball import Circle
from .latlong import FloatArray, luminance
from .sampling import between

#: Longer side of the picture in which edges vote, px.
_SMALL = 320
#: Range of tried radii, as shares of the shorter side.
_LEAST, _MOST = 0.06, 0.52
_ANGLES = 720
#: Least share of the rim with an edge.
_RIM = 0.4
#: Least cosine between an edge's gradient and the radius.
_ASLANT = 0.85
#: Least step of tones over two pixels that is an edge.
_STEP = 0.01
#: Number of circles to examine closely.
_LOOKS = 12


@dataclass(frozen=True)
class Outline:
    """The outline of a ball.

    Attributes:
        circle: Centre and radius, px.
        points: Edge points on it, px, shape (N, 2).
        seen: Share of the rim with an edge.
        spread_px: RMS distance of these edges from the circle, px.
    """

    circle: Circle
    points: FloatArray
    seen: float
    spread_px: float


def find_outline(light: NDArray[np.float32], where: str) -> Outline:
    """Finds the outline of the largest ball.

    Args:
        light: Linear light, shape (H, W, 3).
        where: File, for messages.

    Raises:
        InputError: There is no clear circle.
    """
    grey = _tones(light)
    found = [_fitted(grey, circle) for circle in _candidates(grey)]
    best = max((one for one in found if one is not None), key=lambda one: one.seen, default=None)
    if best is None or best.seen < _RIM:
        seen = f"one with an edge along {best.seen:.0%} of its rim" if best else "no circle"
        raise InputError(f"{where}: ball: wanted a clear round outline, got {seen}; set --circle")
    return best


def _tones(light: NDArray[np.float32]) -> FloatArray:
    """Luminance with rolled-off highlights; a strongly bent curve would shift soft edges."""
    found = luminance(light)
    usual = float(np.quantile(found, 0.8)) or float(found.mean())
    return found / (found + usual)


def _candidates(grey: FloatArray) -> list[Circle]:
    """Finds distinct circles with the most votes, px of the picture."""
    step = max(max(grey.shape) / _SMALL, 1.0)
    size = (max(round(grey.shape[1] / step), 8), max(round(grey.shape[0] / step), 8))
    small = _soft(_box(grey, *size))
    dy, dx = np.gradient(small)
    strength = np.hypot(dx, dy)
    edges = np.argwhere(strength > np.quantile(strength, 0.93))
    toward = np.stack([dy, dx], axis=-1)[tuple(edges.T)] / strength[tuple(edges.T)][:, None]
    votes = np.sqrt(strength[tuple(edges.T)])
    least, most = (max(4, share * min(size)) for share in (_LEAST, _MOST))
    radii = np.arange(least, most, 0.5)
    scores = [_best(edges, toward, votes, radius, small.shape) for radius in radii]
    chosen: list[Circle] = []
    for i in np.argsort([-score for score, _ in scores]):
        row, column = scores[i][1]
        circle = ((column + 0.5) * step, (row + 0.5) * step, float(radii[i]) * step)
        if all(math.dist(circle, other) > 0.1 * circle[2] for other in chosen):
            chosen.append(circle)
        if len(chosen) == _LOOKS:
            break
    return chosen


def _box(grey: FloatArray, width: int, height: int) -> FloatArray:
    """Reduces a picture by means."""
    if grey.shape == (height, width):
        return grey
    rows = np.linspace(0, grey.shape[0], height + 1).astype(int)[:-1]
    columns = np.linspace(0, grey.shape[1], width + 1).astype(int)[:-1]
    sums = np.add.reduceat(np.add.reduceat(grey, rows, axis=0), columns, axis=1)
    counts = np.outer(np.diff([*rows, grey.shape[0]]), np.diff([*columns, grey.shape[1]]))
    return np.asarray(sums / counts)


def _soft(picture: FloatArray) -> FloatArray:
    """Blurs by 1 px, so that gradients have the direction of an edge and not of its steps."""
    for axis in (0, 1):
        for _ in range(2):
            edge = np.pad(picture, [(1, 1) if i == axis else (0, 0) for i in (0, 1)], mode="edge")
            parts = [np.take(edge, np.arange(i, i + picture.shape[axis]), axis) for i in range(3)]
            picture = 0.25 * parts[0] + 0.5 * parts[1] + 0.25 * parts[2]
    return picture


def _best(
    edges: NDArray[np.int64],
    toward: FloatArray,
    weights: FloatArray,
    radius: float,
    shape: tuple[int, ...],
) -> tuple[float, tuple[float, float]]:
    """Most votes for a centre over the root of the radius, and that centre (row, column)."""
    votes = np.zeros(shape[0] * shape[1])
    for side in (radius, -radius):
        middle = np.rint(edges + side * toward).astype(int)
        inside = ((middle >= 0) & (middle < shape)).all(axis=1)
        at = np.asarray(middle[inside] @ (shape[1], 1), np.intp)
        # Both signs: parts of a rim may be brighter, others darker than the surroundings.
        votes += np.bincount(at, weights[inside], minlength=votes.size)
    spread = votes.reshape(shape)
    near = [np.roll(spread, (a, b), (0, 1)) for a in (-1, 0, 1) for b in (-1, 0, 1)]
    spread = np.sum(near, axis=0)
    row, column = np.unravel_index(int(spread.argmax()), shape)
    return float(spread[row, column]) / math.sqrt(radius), (float(row), float(column))


def _fitted(grey: FloatArray, circle: Circle) -> Outline | None:
    """Fits a circle to the strongest edges near another; None: there are too few."""
    outline = None
    for reach in (0.08, 0.03, 0.015):
        points = _edges_near(grey, circle, reach)
        for _ in range(8):
            x, y, radius = circle
            off = np.hypot(points[:, 0] - x, points[:, 1] - y) - radius
            near = np.abs(off) < max(0.25 * reach * radius, 1.0)
            if near.sum() < 0.1 * _ANGLES:
                return None
            circle = _circle_through(points[near])
        spread = float(np.sqrt((off[near] ** 2).mean()))
        outline = Outline(circle, points[near], float(near.sum()) / _ANGLES, spread)
    return outline


def _edges_near(grey: FloatArray, circle: Circle, reach: float) -> FloatArray:
    """Finds the strongest edge along each radius near a circle, px, shape (N, 2)."""
    x, y, radius = circle
    span = max(reach * radius, 3.0)
    steps = np.arange(-span, span + 1e-9, 0.5)
    angle = np.arange(_ANGLES) * (2 * np.pi / _ANGLES)
    far = radius + steps[None, :]
    at_x, at_y = x + np.cos(angle)[:, None] * far, y + np.sin(angle)[:, None] * far
    height, width = grey.shape
    inside = ((at_x > 0) & (at_x < width) & (at_y > 0) & (at_y < height)).all(axis=1)
    profile = between(grey, at_x[inside], at_y[inside])
    # Over two pixels, to find the middle of a soft edge.
    slope = np.abs(profile[:, 4:] - profile[:, :-4])
    best = slope.argmax(axis=1)
    inner = np.clip(best, 1, slope.shape[1] - 2)
    one, two, three = (np.take_along_axis(slope, (inner + i)[:, None], 1)[:, 0] for i in (-1, 0, 1))
    bend = one - 2 * two + three
    shift = np.where(bend < -1e-9, 0.5 * (one - three) / np.minimum(bend, -1e-9), 0)
    place = steps[inner + 2] + 0.5 * np.clip(shift, -1, 1)
    strong = np.take_along_axis(slope, best[:, None], 1)[:, 0] > _STEP
    way = np.stack([np.cos(angle[inside]), np.sin(angle[inside])], axis=1)
    points = (x, y) + (radius + place)[:, None] * way
    return np.asarray(points[strong & _across(grey, points, way)])


def _across(grey: FloatArray, points: FloatArray, way: FloatArray) -> NDArray[np.bool_]:
    """Mask of points with an edge perpendicular to the radius."""
    x, y = points.T
    dx = between(grey, x + 1, y) - between(grey, x - 1, y)
    dy = between(grey, x, y + 1) - between(grey, x, y - 1)
    along = np.abs(dx * way[:, 0] + dy * way[:, 1])
    return np.asarray(along > _ASLANT * np.hypot(dx, dy))


def _circle_through(points: FloatArray) -> Circle:
    """Least squares of x^2 + y^2 = 2 a x + 2 b y + c (Kasa, IEEE Trans. Instrum. 25 (1976) 8)."""
    middle = points.mean(axis=0)
    off = points - middle
    rows = np.column_stack([2 * off, np.ones(len(off))])
    a, b, c = np.linalg.lstsq(rows, (off**2).sum(axis=1), rcond=None)[0]
    return (float(middle[0] + a), float(middle[1] + b), math.sqrt(max(c + a * a + b * b, 0)))
