"""Reads and interpolates animation samplers of glTF.

Source: glTF 2.0 specification, chapter 3.11 and appendix C.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.files.json_item import Item
from daguerre.files.notes import Notes
from daguerre.files.value import Value

from .accessors import Accessors
from .pointers import Target

FloatArray = NDArray[np.float64]
_MODES = ("LINEAR", "STEP", "CUBICSPLINE")


#: Tolerance of the length of key quaternions, which may be rounded.
_SLACK = 0.01


class Track(Value):
    """Samples of a value over time.

    Args:
        use: Output of the sampler, for messages.
        keys: Times, shape (K,), s.
        values: Shape (K, rows, width); rows are in-tangent, value and out-tangent of a spline,
            else only the value. Flags: shape (K,).
        mode: LINEAR, STEP or CUBICSPLINE.
        target: The animated value of the file.
    """

    def __init__(
        self, use: Item, keys: FloatArray, values: NDArray[Any], mode: str, target: Target
    ) -> None:
        self._use, self._keys, self._values, self._mode = use, keys, values, mode
        self._is_list, self._is_flag = target.is_list, target.is_flag
        self._turns = _are_turns(values, target)
        self._rows = 1 if target.is_flag else values.shape[1]

    @property
    def changes(self) -> bool:
        """Whether the value changes."""
        values = self._values
        if self._rows == 3 and len(values) > 1 and values[:, ::2].any():
            return True
        middle = values if self._is_flag else values[:, self._rows // 2]
        return bool((middle[1:] != middle[:1]).any())

    @property
    def lowest(self) -> float:
        """Smallest value of all keys."""
        return float(self._values[:, self._rows // 2].min())

    @property
    def span(self) -> tuple[float, float]:
        """Times of the first and the last key, s."""
        return float(self._keys[0]), float(self._keys[-1])

    def breaks(self, begin: float, end: float) -> FloatArray:
        """Times of the keys inside of (begin, end), s."""
        first = np.searchsorted(self._keys, begin, side="right")
        return self._keys[first : np.searchsorted(self._keys, end, side="left")]

    def at(self, time: float) -> float | bool | list[float]:
        """Value at a time, s: a number, a list of numbers or a flag; constant beyond the keys."""
        value = self.many(np.array([time]))[0]
        if self._is_flag:
            return bool(value)
        return float(value[0]) if len(value) == 1 and not self._is_list else value.tolist()

    def many(self, times: FloatArray) -> NDArray[Any]:
        """Values at many times, shape (T, width); flags: (T,)."""
        keys, values, middle = self._keys, self._values, self._rows // 2
        left = np.maximum(keys.searchsorted(times, side="right") - 1, 0)
        if self._is_flag:
            return np.asarray(values[left])
        right = np.minimum(left + 1, len(keys) - 1)
        span = keys[right] - keys[left]
        s = np.maximum(times - keys[left], 0) / np.where(span > 0, span, np.inf)
        s = np.zeros((len(times), 1)) if self._mode == "STEP" else s[:, None]
        if self._mode == "CUBICSPLINE":
            value = _hermite(values[left], values[right], s, span[:, None])
        else:
            value, end = values[left, middle], values[right, middle]
            value = slerp(_unit(value), _unit(end), s) if self._turns else (1 - s) * value + s * end
        if self._turns:
            empty = np.flatnonzero(np.einsum("ti,ti->t", value, value) < 1e-18)
            if empty.size:
                self._use.fail(f"the rotation at {times[empty[0]]:g} s has length 0")
            value = _unit(value)
        return np.asarray(value)


class Samplers:
    """Reads samplers of a file as tracks, each once, however many channels use it.

    Args:
        accessors: Accessors of the file.
        notes: Receives notes on repairs.
    """

    def __init__(self, accessors: Accessors, notes: Notes) -> None:
        self._accessors = accessors
        self._notes = notes
        self._times: dict[int, FloatArray] = {}
        self._tracks: dict[tuple[Any, ...], Track] = {}

    def track(self, sampler: Item, target: Target) -> Track:
        """Reads the values of a sampler for a target.

        Raises:
            InputError: Keys or values are invalid.
        """
        mode_item = sampler.get("interpolation")
        mode = "LINEAR" if mode_item is None else mode_item.choice(_MODES)
        keys, output = sampler.need("input"), sampler.need("output")
        index = self._accessors.index(keys), self._accessors.index(output)
        key = (*index, mode, target.name, target.width, target.types)
        if key not in self._tracks:
            if index[0] not in self._times:
                self._times[index[0]] = _keys(keys, self._accessors)
            times = self._times[index[0]]
            read = self._flags if target.is_flag else self._numbers
            values = read(output, len(times), mode, target)
            self._tracks[key] = Track(output, times, values, mode, target)
        return self._tracks[key]

    def _flags(self, use: Item, count: int, mode: str, target: Target) -> NDArray[Any]:
        if self._accessors.kind(use) != ("SCALAR", 5121, False) or mode != "STEP":
            use.fail("wanted SCALAR of component type 5121 and STEP for true or false")
        values = self._accessors.integers(use)
        if len(values) != count:
            use.fail(f"wrong number of key values: wanted {count}, got {len(values)}")
        return np.asarray(values != 0)

    def _numbers(self, use: Item, count: int, mode: str, target: Target) -> NDArray[Any]:
        raw = self._accessors.floats(use, target.types, "key value")
        rows = 3 if mode == "CUBICSPLINE" else 1
        per_key = count * rows
        # The elements of a list are stored in sequence.
        if len(raw) % per_key or (len(raw) != per_key and not target.is_list):
            wanted = f"{'a multiple of ' if target.is_list else ''}{per_key} ({mode})"
            use.fail(f"wrong number of key values: wanted {wanted}, got {len(raw)}")
        values = raw.reshape(count, rows, -1).astype(np.float64)
        if _are_turns(values, target):
            self._check_turns(use, values[:, rows // 2])
        return values

    def _check_turns(self, use: Item, turns: NDArray[Any]) -> None:
        lengths = np.linalg.norm(turns, axis=1)
        empty = np.flatnonzero(lengths < 1e-9)
        if empty.size:
            use.fail(f"key value {empty[0]}: wanted a quaternion of length 1, got length 0")
        odd = int((np.abs(lengths - 1) > _SLACK).sum())
        if odd:
            self._notes.add("a key quaternion whose length is not 1 is normalized", odd)


def _keys(use: Item, accessors: Accessors) -> FloatArray:
    if accessors.kind(use).component_type != 5126:
        use.fail("wrong accessor type: wanted key times of component type 5126 (float)")
    keys = accessors.floats(use, ("SCALAR",), "key time")[:, 0].astype(np.float64)
    falls = np.flatnonzero(np.diff(keys) <= 0)
    if falls.size:
        i = int(falls[0])
        use.fail(f"key time {i + 1}: times must increase, got {keys[i]:g} then {keys[i + 1]:g}")
    return keys


def _are_turns(values: NDArray[Any], target: Target) -> bool:
    return target.name == "rotation" and values.shape[-1] == 4


def _unit(quaternions: FloatArray) -> FloatArray:
    lengths = np.sqrt(np.einsum("ti,ti->t", quaternions, quaternions))
    return np.asarray(quaternions / lengths[:, None])


def slerp(a: FloatArray, b: FloatArray, s: FloatArray) -> FloatArray:
    """Spherical interpolation of unit quaternions the shorter way round (appendix C.4).

    Args:
        a: Quaternions at ``s`` = 0, shape (T, 4).
        b: Quaternions at ``s`` = 1, shape (T, 4).
        s: Position between them, 0 .. 1, shape (T, 1).
    """
    cosine = np.einsum("ti,ti->t", a, b)[:, None]
    b = np.where(cosine < 0, -b, b)
    angle = np.arccos(np.minimum(np.abs(cosine), 1.0))
    near = angle < 1e-6
    sine = np.where(near, 1.0, np.sin(angle))
    weights = np.sin((1 - s) * angle) / sine, np.sin(s * angle) / sine
    return np.asarray(np.where(near, (1 - s) * a + s * b, weights[0] * a + weights[1] * b))


def _hermite(left: FloatArray, right: FloatArray, s: FloatArray, span: FloatArray) -> FloatArray:
    """Cubic spline between keys (T, 3, width) (appendix C.5); tangents are per second."""
    s2, s3 = s * s, s * s * s
    return np.asarray(
        (2 * s3 - 3 * s2 + 1) * left[:, 1]
        + span * (s3 - 2 * s2 + s) * left[:, 2]
        + (3 * s2 - 2 * s3) * right[:, 1]
        + span * (s3 - s2) * right[:, 0]
    )
