"""Eyes of a stereo pair, which move as the camera between them does."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.camera.camera import Camera
from daguerre.motion.values import Keys, keys

#: Parameters of the eye itself, for which the camera's own changes do not serve.
_OWN = ("transform", "shift", "projection")


def eye_of(camera: Camera, still: Camera, time: float) -> Camera:
    """One eye of a stereo pair.

    It stands beside the camera like a part of its body: its place in the camera's axes, and the
    difference of both shifts, stay the same.

    Args:
        camera: The camera between the eyes, with its motion, at a time.
        still: The eye at that time, at rest.
        time: That time, s.
    """
    beside = np.linalg.inv(camera.transform) @ still.transform
    aside = np.subtract(still.shift, camera.shift)
    moves: dict[str, Any] = {n: v for n, v in camera.motion.items() if n not in _OWN}
    if isinstance(place := camera.motion.get("transform"), Keys):
        # Turning about the camera keeps the eye beside it between two keys, too.
        pivot = np.linalg.inv(beside)[:3, 3]
        moves["transform"] = _each(place, lambda matrix: matrix @ beside, pivot)
    if isinstance(shift := camera.motion.get("shift"), Keys):
        moves["shift"] = _each(shift, lambda value: tuple(value + aside))
    return still.with_(**moves).evaluated_at(time) if moves else still


def _each(
    given: Keys, change: Callable[[Any], Any], pivot: NDArray[np.floating] | None = None
) -> Keys:
    """Keys with other values at the same times."""
    pairs = zip(given.times.tolist(), map(change, given.values), strict=True)
    return keys(pairs, given.interpolation, pivot)
