"""Apparent distances behind windows: clear surfaces that fill the picture, such as ports.

A camera focuses on the image that a window forms of the object behind it. Rays from the pupil are
traced to the object; their derivatives by the place in the pupil and by the direction give the
vergence of the light that comes from a point of the object.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core

from .near_clip import Directions

#: Places on the film where the view must pass a window, as shares of half the frame.
_PLACES = [(x, y) for x in (-0.8, 0.8) for y in (-0.8, 0.8)]
#: Steps of the derivatives, over several triangles of a curved window: slope; m, at most this share
#: of the distance of the window.
_STEP, _MOST_ASIDE_M, _ASIDE = 0.05, 0.01, 0.1
#: Distance of a plane where rays land that meet nothing, m.
_FAR_M = 1e7
#: Vergence below which light comes from infinity, 1/m.
_PARALLEL = 1e-5


@dataclass(frozen=True)
class Behind:
    """An object behind a window.

    Attributes:
        path_m: Length of the ray to the object; infinite: it meets nothing.
        apparent_m: Distance along the view direction at which it appears; may be infinite.
    """

    path_m: float
    apparent_m: float


def around_frame(
    direction_of: Directions, frame_mm: tuple[float, float], shift_mm: tuple[float, float]
) -> NDArray[np.float64]:
    """View directions near the corners of the picture, in the camera's frame, shape (4, 3)."""
    (width, height), (right, up) = frame_mm, shift_mm
    return np.array(
        [direction_of(right + x * width / 2, up + y * height / 2) for x, y in _PLACES], np.float64
    )


def behind_window(
    core_scene: _core.Scene,
    world: NDArray[np.float64],
    direction: NDArray[np.float64],
    around: NDArray[np.float64],
    start: float,
) -> Behind | None:
    """Finds the object that a camera sees through clear surfaces that fill its picture.

    Args:
        core_scene: The scene.
        world: World from camera, m, shape (4, 4).
        direction: Unit view direction in the camera's frame.
        around: View directions from :func:`around_frame`.
        start: Distance from the pupil at which the view begins, m.

    Returns:
        None if there is no window, or if it forms no virtual image.
    """
    eye, turn = world[:3, 3], world[:3, :3]
    chief = _Way(core_scene, eye, turn @ direction, start)
    count = len(chief.windows)
    for ray in around if count else ():
        count = _shared(chief.windows[:count], _Way(core_scene, eye, turn @ ray, start).windows)
    if not count:
        return None
    vergence = _vergence(core_scene, chief, count, start)
    if vergence is None:
        return None
    if count == len(chief.places):  # it meets nothing behind the window
        return (
            Behind(math.inf, math.inf)
            if abs(vergence) < _PARALLEL
            else Behind(math.inf, 1 / vergence)
        )
    legs = np.diff(np.vstack([eye, chief.places[: count + 1]]), axis=0)
    return Behind(float(np.linalg.norm(legs, axis=1).sum()), 1 / vergence)


class _Way:
    """A ray from the camera through clear surfaces.

    Attributes:
        origin: Where it begins, m.
        toward: Its direction there.
        places: Points on the surfaces that it meets, m, shape (N, 3).
        windows: Instances of the clear ones, which come first.
        onward: Directions behind them, shape (len(windows), 3).
    """

    def __init__(
        self,
        core_scene: _core.Scene,
        origin: NDArray[np.float64],
        toward: NDArray[np.float64],
        start: float,
    ) -> None:
        self.origin, self.toward = origin, toward
        met = core_scene.clear_way(tuple(origin), tuple(toward), start)
        self.places = np.array([place for place, _, _ in met], np.float64).reshape(-1, 3)
        clear = [(instance, onward) for _, instance, onward in met if onward is not None]
        self.windows = [instance for instance, _ in clear]
        self.onward = np.array([onward for _, onward in clear], np.float64).reshape(-1, 3)

    def lands(
        self, count: int, point: NDArray[np.float64], normal: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Point of a plane that it meets behind some windows, m."""
        last, onward = self.places[count - 1], self.onward[count - 1]
        return np.asarray(last + onward * (((point - last) @ normal) / (onward @ normal)))


def _shared(some: list[int], others: list[int]) -> int:
    """Number of equal items at the beginning of two lists."""
    pairs = zip(some, others, strict=False)
    return sum(1 for _ in itertools.takewhile(lambda pair: pair[0] == pair[1], pairs))


def _across(axis: NDArray[np.float64]) -> NDArray[np.float64]:
    """Two unit vectors at right angles to an axis, and to each other."""
    first = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
    first /= np.linalg.norm(first)
    return np.array([first, np.cross(axis, first)])


def _vergence(core_scene: _core.Scene, chief: _Way, count: int, start: float) -> float | None:
    """Mean vergence at the pupil, 1/m, of light from the point that a ray meets behind windows.

    A ray that begins at x across the axis, with a slope of a, lands at B x + A a. All rays from the
    point land at 0, so a = -A^-1 B x.

    Returns:
        None if the vergence is negative, as behind a lens that forms a real image, or if rays
        beside the given one pass other surfaces.
    """
    normal = chief.onward[count - 1]
    point = chief.places[count - 1] + _FAR_M * normal
    if count < len(chief.places):
        point = chief.places[count]
    aside = min(_MOST_ASIDE_M, _ASIDE * float(np.linalg.norm(chief.places[0] - chief.origin)))
    rows = _across(normal)
    landed = np.zeros((2, 2, 2))  # by place and by slope; along rows; for both axes
    for k, axis in enumerate(_across(chief.toward)):
        for sign in (-1, 1):
            for n, (move, slope) in enumerate(((aside, 0.0), (0.0, _STEP))):
                origin = chief.origin + sign * move * axis
                way = _Way(core_scene, origin, chief.toward + sign * slope * axis, start)
                if _shared(chief.windows[:count], way.windows) < count:
                    return None
                landed[n, :, k] += sign * (rows @ (way.lands(count, point, normal) - point))
    by_place, by_slope = landed[0] / aside, landed[1] / _STEP
    if not abs(np.linalg.det(by_slope)) > 0:
        return None
    vergence = float(np.trace(np.linalg.solve(by_slope, by_place))) / 2
    return vergence if vergence > -_PARALLEL else None
