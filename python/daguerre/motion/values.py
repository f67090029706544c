"""Values that change over time: keys, spins, and any object with the methods of ``Dynamic``.

Times are seconds of scene time. Outside of its keys a value is constant. The core (``core/motion``)
interpolates matrices, so that pictures and ``at`` agree.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

import daguerre._core as _core
from daguerre.argument_checks import guarded
from daguerre.cached import cached_property
from daguerre.checks import as_readonly, matrix, number, short, shown, to_numbers
from daguerre.errors import InputError, core_errors, suggest
from daguerre.files.value import Value

if TYPE_CHECKING:
    from typing_extensions import TypeIs

FloatArray = NDArray[np.float64]
#: Interpolations of matrices, the default first; docs/motion.md explains them.
OF_MATRICES = ("decomposed", "linear", "twist", "slerp")
OF_NUMBERS = ("linear", "step")
MAX_KEYS = 1_000_000
#: Limits far beyond any shot: larger values are mistakes, and double precision would not resolve a
#: shutter or a turn.
MAX_TIME = 1e12  # s
MAX_SPEED = 1e9  # revolutions per second
MAX_DISTANCE = 1e15  # of pivots and centres, m


class Blending(Protocol):
    """An object with numbers that keys can interpolate, such as a projection."""

    @property
    def form(self) -> tuple[Any, ...]:
        """Form that all keys must share."""

    def blended(self, other: object, share: float) -> Any:
        """Interpolates toward another value of the same form, by this fraction."""


class Dynamic(Protocol):
    """A value that changes over time."""

    def at(self, time_s: float) -> Any:
        """Returns the value at a time, s."""

    def breaks(self, begin: float, end: float) -> Sequence[float] | FloatArray:
        """Times inside of (begin, end), rising, s; between them the value changes smoothly."""


#: Value of keys at a time.
KeyValue = NDArray[np.float64] | tuple[Any, ...] | float | str | Blending


@guarded
@dataclass(frozen=True, eq=False)
class Keys(Value):
    """A value given at some times; made by :func:`keys`.

    Attributes:
        times: Times of the keys, rising, shape (K,), s.
        values: K numbers, tuples or arrays of one shape, names or flags, or projections.
        interpolation: One of ``OF_MATRICES`` for matrices (4, 4), else one of ``OF_NUMBERS``.
        pivot: Point in local space about which decomposed matrices turn, m.
    """

    times: FloatArray
    values: tuple[Any, ...]
    interpolation: str
    pivot: tuple[float, float, float] | None = None

    @cached_property
    def moves_matrices(self) -> bool:
        """Whether the values are transforms."""
        return _shape(self.values[0]) == (4, 4)

    @cached_property
    def motion(self) -> _core.Motion:
        """Motion of the core; for matrices only."""
        matrices = np.array(self.values, np.float64)
        return _core.Motion.keys(self.times, matrices, self.interpolation, self.pivot or (0, 0, 0))

    def at(self, time_s: float) -> KeyValue:
        """Returns the value at a time, s; constant before the first key and after the last."""
        if self.moves_matrices and len(self.times) > 1:
            return np.asarray(self.motion.at(time_s))
        i = int(np.searchsorted(self.times, time_s, side="right")) - 1
        a: KeyValue = self.values[max(i, 0)]
        if i < 0 or i == len(self.times) - 1:
            return a
        if self.interpolation == "step" or time_s == self.times[i]:
            return a
        share = float((time_s - self.times[i]) / (self.times[i + 1] - self.times[i]))
        mixed: KeyValue = _lerp(a, self.values[i + 1], share)
        return mixed

    def breaks(self, begin: float, end: float) -> list[float]:
        """Times of the keys inside of (begin, end), s."""
        first = np.searchsorted(self.times, begin, side="right")
        last = np.searchsorted(self.times, end, side="left")
        return [float(t) for t in self.times[first:last]]

    def __repr__(self) -> str:
        first, last = float(self.times[0]), float(self.times[-1])
        kind = "matrices" if self.moves_matrices else type(self.values[0]).__name__
        return f"<Keys {len(self.times)} x {kind}, {first:g} .. {last:g} s, {self.interpolation}>"


@guarded
@dataclass(frozen=True, eq=False)
class Spin(Value):
    """A transform that rotates at constant speed; made by :func:`spin`.

    Attributes:
        axis: Direction in local space, of any length; rotation is counter-clockwise as seen from
            its tip.
        revolutions_per_second: Speed; negative: clockwise.
        center: Point on the axis in local space, m.
        transform: World from local at the angle 0: a matrix (4, 4), or keys of matrices.
        time: Time at which the angle is 0, s.
    """

    axis: tuple[float, float, float]
    revolutions_per_second: float
    center: tuple[float, float, float]
    transform: NDArray[np.float64] | Keys
    time: float

    @cached_property
    def motion(self) -> _core.Motion:
        """Motion of the core."""
        at_rest = self.transform
        base = at_rest.motion if isinstance(at_rest, Keys) else _core.Motion.still(at_rest)
        return base.spinning(self.axis, self.revolutions_per_second, self.center, self.time)

    def at(self, time_s: float) -> NDArray[np.float64]:
        """Returns world from local at a time, s, shape (4, 4)."""
        return np.asarray(self.motion.at(time_s))

    def breaks(self, begin: float, end: float) -> list[float]:
        """Breaks of the transform, s."""
        return self.transform.breaks(begin, end) if isinstance(self.transform, Keys) else []

    def __repr__(self) -> str:
        x, y, z = self.axis
        return f"<Spin {self.revolutions_per_second:g} rev/s about ({x:g}, {y:g}, {z:g})>"


@dataclass(frozen=True, eq=False)
class Composite(Value):
    """A dataclass, tuple or list with dynamic values somewhere inside."""

    value: Any

    def at(self, time_s: float) -> Any:
        """Returns a copy with constant values, evaluated at a time, s."""
        return at(self.value, time_s)

    def breaks(self, begin: float, end: float) -> list[float]:
        """Breaks of all dynamic values inside, s."""
        return sorted({float(t) for part in _dynamics(self.value) for t in part.breaks(begin, end)})


def keys(
    pairs: Iterable[tuple[float, Any]],
    interpolation: str | None = None,
    pivot: ArrayLike | None = None,
) -> Keys:
    """Makes a value over time from keys, for any parameter that may change over time.

    Args:
        pairs: Pairs (time in s, value), with strictly rising times. Values are numbers, tuples or
            arrays of numbers of one shape, projections of one model and size, or names and flags,
            which change in steps.
        interpolation: Interpolation of matrices (4, 4): decomposed (default), linear, twist or
            slerp; of other numbers: linear (default) or step.
        pivot: Point in local space about which decomposed matrices turn, m; default: the origin.

    Raises:
        InputError: A time or a value is wrong; the message names the key.
    """
    if not isinstance(interpolation, str | None):
        raise InputError(f"keys: interpolation: wanted a name, got {shown(interpolation)}")
    listed = _pairs(pairs)
    times = np.array([_time(t, f"keys[{i}]: time") for i, (t, _) in listed])
    late = np.flatnonzero(np.diff(times) <= 0)
    if late.size:
        i = int(late[0])
        raise InputError(
            f"keys[{i + 1}]: time: times must increase, got {times[i]:g} s then {times[i + 1]:g} s"
        )
    values = [_value(value, f"keys[{i}]", interpolation) for i, (_, value) in listed]
    shapes = [_shape(value) for value in values]
    odd = next((i for i, shape in enumerate(shapes) if shape != shapes[0]), None)
    if odd is not None:
        raise InputError(f"keys[{odd}]: wanted shape {shapes[0]} like keys[0], got {shapes[odd]}")
    steps = any(isinstance(value, str | bool | None) for value in values)
    allowed = OF_MATRICES if shapes[0] == (4, 4) else OF_NUMBERS[steps:]
    if interpolation is not None and interpolation not in allowed:
        raise InputError(
            f"keys: interpolation: wanted {', '.join(allowed)} for these values, got "
            f"{interpolation!r}{suggest(str(interpolation), allowed)}"
        )
    made = Keys(times, tuple(values), interpolation or allowed[0], _pivot(pivot, shapes[0]))
    if made.moves_matrices:
        _in_core(made, "keys")
    return made


def spin(
    axis: ArrayLike,
    revolutions_per_second: float,
    center: ArrayLike = (0.0, 0.0, 0.0),
    transform: ArrayLike | Keys | None = None,
    time: float = 0.0,
) -> Spin:
    """Makes a transform that rotates at constant speed about an axis: a wheel, a propeller.

    Args:
        axis: Direction in local space; rotation is counter-clockwise as seen from its tip.
        revolutions_per_second: Speed; negative: clockwise.
        center: Point on the axis in local space, m.
        transform: World from local at the angle 0, shape (4, 4), or keys of such; default: the
            identity.
        time: Time at which the angle is 0, s.

    Raises:
        InputError: A number is not finite, or the axis has length 0.
    """
    direction = _point(axis, "spin: axis")
    if not math.hypot(*direction) > 0:
        raise InputError(f"spin: axis: wanted a length above 0, got {short(axis)}")
    base = transform if isinstance(transform, Keys) else matrix(transform, "spin")
    if isinstance(base, Keys) and not base.moves_matrices:
        raise InputError("spin: transform: keys must be matrices (4, 4)")
    rate = number(
        revolutions_per_second,
        "spin: revolutions_per_second",
        -MAX_SPEED,
        MAX_SPEED,
        error=InputError,
    )
    zero = _time(time, "spin: time")
    made = Spin(direction, rate, _point(center, "spin: center"), base, zero)
    _in_core(made, "spin")
    return made


#: Maximum depth of nested lists to search, as a list may contain itself.
_DEEPEST = 8
#: Types of most parts of a scene, which are constant and contain nothing.
_PLAIN = frozenset({type(None), bool, int, float, str})


def at(value: Any, time: float, depth: int = 0) -> Any:
    """Evaluates a value at a time; a constant value is returned unchanged.

    Args:
        value: Dynamic value, or a dataclass, tuple or list that may contain some.
        time: Scene time, s.
        depth: Depth of nesting so far; values deeper than ``_DEEPEST`` are not evaluated.
    """
    if type(value) in _PLAIN:
        return value
    if is_dynamic(value):
        return value.at(time)
    if depth > _DEEPEST:
        return value
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        parts = vars(value)
        changed = {name: at(part, time, depth + 1) for name, part in parts.items()}
        same = all(changed[name] is part for name, part in parts.items())
        return value if same else dataclasses.replace(value, **changed)
    if isinstance(value, tuple | list):
        items = [at(item, time, depth + 1) for item in value]
        same = all(a is b for a, b in zip(items, value, strict=True))
        return value if same else type(value)(items)
    return value


def moves(value: object) -> bool:
    """Whether a value is dynamic, or contains a dynamic value."""
    return next(iter(_dynamics(value)), None) is not None


def is_dynamic(value: object) -> TypeIs[Dynamic]:
    """Whether a value itself is dynamic."""
    kind = type(value)
    return hasattr(kind, "at") and hasattr(kind, "breaks")


def _dynamics(value: Any, depth: int = 0) -> Iterable[Dynamic]:
    if type(value) in _PLAIN:
        return
    if is_dynamic(value):
        yield value
    elif depth > _DEEPEST:
        return
    elif dataclasses.is_dataclass(value) and not isinstance(value, type):
        for part in vars(value).values():
            yield from _dynamics(part, depth + 1)
    elif isinstance(value, tuple | list):
        for item in value:
            yield from _dynamics(item, depth + 1)


def _pairs(pairs: Any) -> list[tuple[int, tuple[Any, Any]]]:
    try:
        listed = list(islice(pairs, MAX_KEYS + 1))
    except TypeError:
        raise InputError(f"keys: wanted [(time in s, value), ...], got {short(pairs)}") from None
    if not 1 <= len(listed) <= MAX_KEYS:
        got = len(pairs) if hasattr(pairs, "__len__") else f"more than {MAX_KEYS}" * bool(listed)
        raise InputError(f"keys: wanted 1 .. {MAX_KEYS} keys, got {got or 0}")
    for i, pair in enumerate(listed):
        if not isinstance(pair, tuple | list) or len(pair) != 2:
            raise InputError(f"keys[{i}]: wanted (time in s, value), got {short(pair)}")
    return list(enumerate(listed))


def _value(value: object, where: str, interpolation: str | None) -> Any:
    """Normalizes the value of a key: a number, tuple of floats, read-only array, name or flag."""
    if _blends(value):
        return value
    if isinstance(value, str | bool | np.bool_ | None):
        return bool(value) if isinstance(value, np.bool_) else value
    if isinstance(value, int | float):
        finite = number(value, where, error=InputError)
        return value if interpolation == "step" else finite  # integers stay integers
    numbers = to_numbers(value, where, "value", "numbers, a name or a flag")
    if numbers.dtype.kind != "f":
        numbers = numbers.astype(np.float64)
    if not numbers.size or not np.isfinite(numbers).all():
        raise InputError(f"{where}: wanted finite numbers, got {short(value)}")
    if numbers.ndim == 0:
        return float(numbers)
    if isinstance(value, tuple | list) and numbers.ndim == 1:
        return tuple(numbers.tolist())
    return matrix(value, where) if numbers.shape == (4, 4) else as_readonly(numbers)


def _time(value: object, where: str) -> float:
    return number(value, where, -MAX_TIME, MAX_TIME, error=InputError)


def _blends(value: object) -> bool:
    return hasattr(type(value), "blended")


def _shape(value: Any) -> tuple[Any, ...]:
    if _blends(value):
        return tuple(value.form)
    if isinstance(value, np.ndarray):
        return tuple(int(n) for n in value.shape)
    return (len(value),) if isinstance(value, tuple) else ()


def _point(values: ArrayLike, where: str) -> tuple[float, float, float]:
    numbers = to_numbers(values, where, "value", "three numbers")
    if numbers.shape != (3,) or not np.isfinite(numbers).all():
        raise InputError(f"{where}: wanted three finite numbers, got {short(values)}")
    if np.abs(numbers).max() > MAX_DISTANCE:
        raise InputError(
            f"{where}: wanted numbers of at most {MAX_DISTANCE:g}, got {short(values)}"
        )
    x, y, z = (float(v) for v in numbers)
    return x, y, z


def _pivot(pivot: ArrayLike | None, shape: tuple[int, ...]) -> tuple[float, float, float] | None:
    if pivot is None:
        return None
    if shape != (4, 4):
        raise InputError("keys: pivot: only keys of matrices (4, 4) take one")
    return _point(pivot, "keys: pivot")


def _in_core(made: Keys | Spin, where: str) -> None:
    """Raises at once if the core cannot interpolate a motion."""
    with core_errors(InputError, where):
        _ = made.motion


def _lerp(a: Any, b: Any, s: float) -> Any:
    if _blends(a):
        return a.blended(b, s)
    if isinstance(a, tuple):
        return tuple(x + s * (y - x) for x, y in zip(a, b, strict=True))
    if isinstance(a, np.ndarray):
        return (a + a.dtype.type(s) * (b - a)).astype(a.dtype, copy=False)
    return a + s * (b - a)
