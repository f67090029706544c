"""Camera poses for a calibration session: near and far, tilted, all over the picture."""

from __future__ import annotations

import math

import numpy as np

from daguerre.argument_checks import guarded
from daguerre.camera.projection import Projection
from daguerre.checks import number, whole
from daguerre.errors import UsageError

from .boards import outline
from .chart import Chart, FloatArray

FURTHER = 1.12  # factor of distance after a try that does not fit
CLOSER_IN = 0.9  # then: factor toward the middle of the picture
TRIES, PATIENCE = 20, 14  # positions in the picture; distances at each
GRAZING = 0.35  # cosine below which a board is seen at too flat an angle
EDGE = 9  # points along a side of the board that must be visible


@guarded
def poses(
    chart: Chart,
    projection: Projection,
    count: int = 20,
    seed: int = 0,
    *,
    tilt: float = 40.0,
    farthest: float = 2.0,
    margin: float = 0.02,
) -> list[FloatArray]:
    """Finds poses of a camera from which it sees all of a board.

    Boards stand where a Halton sequence puts them in the picture, from as near as they fit to some
    times as far, turned about all axes. The tilt tells focal length and distance apart; boards that
    fill the picture find the middle of weak distortion.

    Args:
        chart: The board, in the plane z = 0.
        projection: Projection of the camera, or one like it.
        count: Number of poses.
        seed: Seed of the choice.
        tilt: Largest tilt of the board to the line of sight, degrees, 0 to 60.
        farthest: Largest distance, as a multiple of the nearest that fits, 1 to 10.
        margin: Free margin at the picture's edges, as a share of its height.

    Returns:
        World-from-camera matrices, shape (4, 4), for ``Camera(transform=...)``.

    Raises:
        UsageError: The projection never sees the whole board.
    """
    whole(count, "poses: count", 1, 10000)
    number(tilt, "poses: tilt", 0, 60)
    number(farthest, "poses: farthest", 1, 10)
    number(margin, "poses: margin", 0, 0.4)
    rng = np.random.default_rng(whole(seed, "poses: seed", 0, 2**63 - 1))
    turn = rng.random(2)
    targets = [(np.array([_halton(i, 2), _halton(i, 3)]) + turn) % 1 for i in range(count)]
    return [
        _pose(chart, projection, at, rng, math.radians(tilt), farthest, margin) for at in targets
    ]


def _pose(
    chart: Chart,
    projection: Projection,
    at: FloatArray,
    rng: np.random.Generator,
    tilt: float,
    farthest: float,
    margin: float,
) -> FloatArray:
    board = _board_turn(rng, tilt)
    border = _border(chart)
    size = np.array(projection.size, np.float64)
    further = farthest ** rng.random()
    place = at
    for _ in range(TRIES):
        ahead = projection.unproject([place * (size - 1)])[0]
        distance = 0.4 * max(chart.size) * max(projection.focal) / min(projection.size)
        for _ in range(PATIENCE if np.isfinite(ahead).all() else 0):
            turn = _toward(ahead) @ board
            for far in (distance * further, distance):
                points = border @ turn.T + ahead * far
                if _seen(projection, points, turn[:, 2], margin):
                    return _camera_pose(turn, ahead * far)
            distance *= FURTHER
        place = 0.5 + (place - 0.5) * CLOSER_IN
    raise UsageError(
        f"poses: wanted a projection that sees the whole board with a margin of {margin:g}, got no "
        "such pose (a smaller margin may help)"
    )


def _seen(projection: Projection, points: FloatArray, normal: FloatArray, margin: float) -> bool:
    """Whether points (x right, y down, z ahead) are in the picture, and not seen too flat.

    ``normal`` points away from the camera, into the board.
    """
    pixels = projection.project(points)
    width, height = projection.size
    free = margin * height
    inside = (pixels >= free) & (pixels <= np.array([width, height]) - 1 - free)
    sight = points / np.linalg.norm(points, axis=1, keepdims=True)
    return bool(inside.all() and (sight @ normal).min() > GRAZING)


def _border(chart: Chart) -> FloatArray:
    """Points around the board in OpenCV's frame, shape (N, 3)."""
    ends = outline(chart)
    share = np.linspace(0, 1, EDGE)[:, None]
    sides = [a + share * (b - a) for a, b in zip(ends, np.roll(ends, -1, axis=0), strict=True)]
    flat = np.concatenate(sides)
    return np.column_stack([flat[:, 0], -flat[:, 1], np.zeros(len(flat))])


def _board_turn(rng: np.random.Generator, tilt: float) -> FloatArray:
    """Random tilt of a board about a line normal to the view, and rotation about the view."""
    about, angle = 2 * math.pi * rng.random(), tilt * math.sqrt(rng.random())
    axis = np.array([math.cos(about), math.sin(about), 0.0])
    roll = math.radians(20) * (2 * rng.random() - 1)
    return _turn(axis, angle) @ _turn(np.array([0.0, 0, 1]), roll)


def _toward(direction: FloatArray) -> FloatArray:
    """Rotation that takes the axis to a direction, shape (3, 3)."""
    axis = np.cross([0.0, 0, 1], direction)
    length = float(np.linalg.norm(axis))
    if length < 1e-12:
        return np.eye(3)
    return _turn(axis / length, math.atan2(length, direction[2]))


def _turn(axis: FloatArray, angle: float) -> FloatArray:
    """Rotation about a unit axis (Rodrigues), shape (3, 3)."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.asarray(np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross)


def _camera_pose(turn: FloatArray, place: FloatArray) -> FloatArray:
    """World from camera for a board at rest; both frames of OpenCV have opposite y and z."""
    flip = np.diag([1.0, -1, -1])
    out = np.eye(4)
    out[:3, :3] = flip @ turn.T @ flip
    out[:3, 3] = flip @ (turn.T @ -place)
    return out


def _halton(index: int, base: int) -> float:
    value, share = 0.0, 1.0
    index += 1
    while index:
        share /= base
        index, digit = divmod(index, base)
        value += digit * share
    return value
