"""Animation samplers of glTF: keys, values and what lies between them.

Source: glTF 2.0 specification, chapter 3.11 and appendix C.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .gltf_accessors import Accessors
from .gltf_pointers import Target
from .json_item import Item

FloatArray = NDArray[np.float64]
_MODES = ("LINEAR", "STEP", "CUBICSPLINE")


@dataclass(frozen=True)
class _Place:
    """Where a time lies among keys: at or behind key ``left``, ``fraction`` of ``span`` s."""

    count: int
    left: int
    fraction: float
    span: float

    @property
    def right(self) -> int:
        return min(self.left + 1, self.count - 1)


class Samplers:
    """Values of animation samplers at one time; each is worked out once, however many use it.

    Args:
        accessors: Those of the file.
        time: s.
    """

    def __init__(self, accessors: Accessors, time: float) -> None:
        self._accessors = accessors
        self._time = time
        self._places: dict[int, _Place] = {}
        self._values: dict[tuple[Any, ...], Any] = {}

    def value(self, sampler: Item, target: Target) -> Any:
        """A number, a list of numbers, or true or false."""
        mode_item = sampler.get("interpolation")
        mode = "LINEAR" if mode_item is None else mode_item.choice(_MODES)
        keys, output = sampler.need("input"), sampler.need("output")
        index = self._accessors.index(keys), self._accessors.index(output)
        key = (*index, mode, target.name, target.width, target.types)
        if key not in self._values:
            place = self._place(keys, index[0])
            if target.is_flag:
                self._values[key] = self._flag(output, place, mode)
            else:
                self._values[key] = self._numbers(output, place, mode, target)
        value = self._values[key]
        return list(value) if isinstance(value, list) else value

    def _place(self, use: Item, index: int) -> _Place:
        if index not in self._places:
            keys = _keys(use, self._accessors)
            i = int(np.clip(np.searchsorted(keys, self._time, side="right") - 1, 0, len(keys) - 1))
            held = i == len(keys) - 1 or self._time <= keys[0]
            span = 1.0 if held else float(keys[i + 1] - keys[i])
            fraction = 0.0 if held else float(self._time - keys[i]) / span
            self._places[index] = _Place(len(keys), i, fraction, span)
        return self._places[index]

    def _flag(self, use: Item, place: _Place, mode: str) -> bool:
        if self._accessors.kind(use) != ("SCALAR", 5121, False) or mode != "STEP":
            use.fail("wanted SCALAR of component type 5121 and STEP for what is true or false")
        values = self._accessors.integers(use)
        if len(values) != place.count:
            use.fail(f"wrong number of key values: wanted {place.count}, got {len(values)}")
        return bool(values[place.left])

    def _numbers(self, use: Item, place: _Place, mode: str, target: Target) -> Any:
        left, right = self._keys_around(use, place, mode, target)
        turns = target.name == "rotation" and left.shape[1] == 4
        if turns:
            _check_turns(use, place, left[1], right[1])
        s = 0.0 if mode == "STEP" else place.fraction
        if mode == "CUBICSPLINE":
            value = _hermite(left, right, s, place.span)
        elif turns:
            value = slerp(_unit(left[1]), _unit(right[1]), s)
        else:
            value = (1 - s) * left[1] + s * right[1] if s else left[1]
        if turns:
            if np.linalg.norm(value) < 1e-9:
                use.fail(f"the rotation at {self._time:g} s has length 0")
            value = _unit(value)
        return float(value[0]) if len(value) == 1 and not target.is_list else value.tolist()

    def _keys_around(
        self, use: Item, place: _Place, mode: str, target: Target
    ) -> tuple[FloatArray, FloatArray]:
        """Two keys as (3, width): in-tangent, value, out-tangent; tangents are 0 but of splines."""
        raw = self._accessors.floats(use, target.types, "key value")
        rows = 3 if mode == "CUBICSPLINE" else 1
        per_key = place.count * rows
        # The elements of a list lie one behind the other.
        if len(raw) % per_key or (len(raw) != per_key and not target.is_list):
            wanted = f"{'a multiple of ' if target.is_list else ''}{per_key} ({mode})"
            use.fail(f"wrong number of key values: wanted {wanted}, got {len(raw)}")
        shaped = raw.reshape(place.count, rows, -1)
        around = np.zeros((2, 3, shaped.shape[2]))
        for k, key in enumerate((place.left, place.right)):
            around[k, 1 - rows // 3 : 2 + rows // 3] = shaped[key]
        return around[0], around[1]


def _keys(use: Item, accessors: Accessors) -> FloatArray:
    if accessors.kind(use)[1] != 5126:
        use.fail("wrong accessor type: wanted key times of component type 5126 (float)")
    keys = accessors.floats(use, ("SCALAR",), "key time")[:, 0].astype(np.float64)
    falls = np.flatnonzero(np.diff(keys) <= 0)
    if falls.size:
        i = int(falls[0])
        use.fail(
            f"key time {i + 1}: wanted times that rise strictly, got {keys[i]:g} then "
            f"{keys[i + 1]:g}"
        )
    return keys


def _check_turns(use: Item, place: _Place, left: FloatArray, right: FloatArray) -> None:
    for key, value in ((place.left, left), (place.right, right)):
        if np.linalg.norm(value) < 1e-9:
            use.fail(f"key value {key}: wanted a quaternion of length 1, got length 0")


def _unit(quaternion: FloatArray) -> FloatArray:
    return np.asarray(quaternion / np.linalg.norm(quaternion))


def slerp(a: FloatArray, b: FloatArray, s: float) -> FloatArray:
    """Spherical interpolation of unit quaternions the shorter way round (appendix C.4)."""
    cosine = float(a @ b)
    if cosine < 0:
        b, cosine = -b, -cosine
    angle = float(np.arccos(min(cosine, 1.0)))
    if angle < 1e-6:
        return (1 - s) * a + s * b
    return np.asarray((np.sin((1 - s) * angle) * a + np.sin(s * angle) * b) / np.sin(angle))


def _hermite(left: FloatArray, right: FloatArray, s: float, span: float) -> FloatArray:
    """Cubic spline between two keys (appendix C.5); tangents are per second."""
    s2, s3 = s * s, s * s * s
    return np.asarray(
        (2 * s3 - 3 * s2 + 1) * left[1]
        + span * (s3 - 2 * s2 + s) * left[2]
        + (3 * s2 - 2 * s3) * right[1]
        + span * (s3 - s2) * right[0]
    )
