"""Pose of a camera while the shutter is open: a rigid motion."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core
from daguerre.camera.camera import Camera
from daguerre.camera.projection import Projection
from daguerre.checks import short
from daguerre.errors import UsageError
from daguerre.motion.resample import resample_transform
from daguerre.motion.values import Dynamic, Keys, Spin
from daguerre.scene.limits import MAX_SIZE

#: Interpolations that stay rigid between rigid keys; linear matrices would shear the camera.
_STAY_RIGID = ("decomposed", "twist", "slerp")
#: Points around a moving camera, m, at which the error of its motion is measured.
_AROUND = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], np.float64)

#: Number of moments at which a motion is sampled for its hash.
_LOOKS = 64


@dataclass(frozen=True)
class _Rigid:
    """World from camera over time, without the scale of the file."""

    transform: Dynamic

    def at(self, time_s: float) -> NDArray[np.float64]:
        return rigid(self.transform.at(time_s))

    def breaks(self, begin: float, end: float) -> Sequence[float] | NDArray[np.float64]:
        return self.transform.breaks(begin, end)


@dataclass(frozen=True, eq=False)
class _Mounted:
    """World from an object that is fixed to a moving camera."""

    body: Dynamic
    place: NDArray[np.float64]

    def at(self, time_s: float) -> NDArray[np.float64]:
        return np.asarray(rigid(self.body.at(time_s)) @ self.place)

    def breaks(self, begin: float, end: float) -> Sequence[float] | NDArray[np.float64]:
        return self.body.breaks(begin, end)


def mounted(camera: Camera, place: NDArray[np.float64]) -> Camera:
    """Returns a copy of a camera at another pose in its frame, which moves with it.

    Args:
        camera: Camera that gives all other parameters.
        place: Pose of the new camera in this one's frame, rigid, m, shape (4, 4).
    """
    given: Any = camera
    if not isinstance(given, Camera):
        raise UsageError(f"camera: wanted a Camera, got {short(given)}")
    moving = camera.motion.get("transform")
    if moving is not None:
        return camera.with_(transform=_Mounted(moving, place))
    return camera.with_(transform=rigid(camera.transform) @ place)


def moved_right(camera: Camera, shift: float) -> Camera:
    """Moves a camera to its own right, m; see :func:`mounted`."""
    place = np.eye(4)
    place[0, 3] = shift
    return mounted(camera, place)


def pose(camera: Camera, begin: float, end: float) -> _core.Motion:
    """Rigid motion, world from camera, over an interval (s), in fractions of it.

    Keys and spins go to the core unchanged. Other motions become keys within the error bound of
    :func:`daguerre.motion.resample.resample_transform`.

    Raises:
        UsageError: A transform is singular.
    """
    moving = camera.motion.get("transform")
    if moving is None or not end > begin:
        return _core.Motion.still(rigid(camera.frozen_at(0.5 * (begin + end)).transform))
    if isinstance(moving, Spin):
        base = moving.transform
        if not isinstance(base, Keys):
            return replace(moving, transform=rigid(base)).motion.over(begin, end)
        if base.interpolation in _STAY_RIGID:
            return replace(moving, transform=_near(base, begin, end)).motion.over(begin, end)
    if isinstance(moving, Keys) and moving.interpolation in _STAY_RIGID:
        return _near(moving, begin, end).motion.over(begin, end)
    return resample_transform(_Rigid(moving), begin, end, _AROUND).over(begin, end)


@dataclass(frozen=True)
class Change:
    """Change of a parameter in an interval, as JSON values.

    Attributes:
        open: Value at the begin.
        close: Value at the end.
        sha256: Hash of the values between.
    """

    open: Any
    close: Any
    sha256: str

    @property
    def facts(self) -> dict[str, Any]:
        """Makes the record of a change, for metadata and hashes."""
        return {"open": self.open, "close": self.close, "sha256": self.sha256}


def changes(camera: Camera, begin: float, end: float) -> dict[str, Change]:
    """Changes of parameters in an interval, s, by name."""
    if not end > begin:
        return {}
    even = [begin + (end - begin) * i / _LOOKS for i in range(_LOOKS + 1)]
    found: dict[str, Change] = {}
    for name, dynamic in camera.motion.items():
        breaks = [float(t) for t in dynamic.breaks(begin, end)]
        times = sorted({*even, *breaks[: 16 * _LOOKS]})
        values = [_plain(dynamic.at(t)) for t in times]
        if any(value != values[0] for value in values):
            text = json.dumps([values, breaks])
            digest = hashlib.sha256(text.encode()).hexdigest()
            found[name] = Change(values[0], values[-1], digest)
    return found


def _plain(value: object) -> Any:
    """Converts a value to JSON."""
    return value.facts() if isinstance(value, Projection) else np.asarray(value).tolist()


def _near(keys: Keys, begin: float, end: float) -> Keys:
    """Selects the keys that an interval needs, and makes them rigid."""
    first = max(0, int(np.searchsorted(keys.times, begin, side="right")) - 1)
    last = int(np.searchsorted(keys.times, end, side="left")) + 1
    values = tuple(rigid(value) for value in keys.values[first:last])
    return replace(keys, times=keys.times[first:last], values=values)


def rigid(transform: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rotation and position of a transform, without scale.

    Raises:
        UsageError: The matrix is not a finite 4x4, is singular, or lies too far from the origin.
    """
    try:
        matrix = np.asarray(transform, np.float64)
    except (TypeError, ValueError, OverflowError):
        raise UsageError(
            f"camera: transform: wanted a 4x4 matrix, got {short(transform)}"
        ) from None
    if matrix.shape != (4, 4) or not np.isfinite(matrix).all():
        raise UsageError("camera: transform: wanted a finite 4x4 matrix")
    if not np.abs(matrix[:3, 3]).max() < MAX_SIZE:
        raise UsageError(
            f"camera: transform: wanted a position within {MAX_SIZE:g} m of the origin, "
            f"got {matrix[:3, 3].tolist()}"
        )
    forward, up = -matrix[:3, 2], matrix[:3, 1]
    right = np.cross(forward, up)
    if not (np.linalg.norm(forward) > 0 and np.linalg.norm(right) > 0):
        raise UsageError(
            "camera: transform: wanted a view direction and an up vector, got a singular matrix"
        )
    z = -forward / np.linalg.norm(forward)
    x = right / np.linalg.norm(right)
    out = np.eye(4)
    out[:3, 0], out[:3, 1], out[:3, 2], out[:3, 3] = x, np.cross(z, x), z, matrix[:3, 3]
    return out
