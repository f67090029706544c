"""Transforms of prims: stacks of operations, constant or over time.

USD interpolates the value of each operation, then multiplies; so a turn by keyed angles is a turn
at any time. Matrices here act on column vectors; USD's act on rows.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import Usd, UsdGeom

from daguerre.errors import InputError
from daguerre.files.notes import Notes
from daguerre.files.value import Value
from daguerre.motion.values import Dynamic, is_dynamic
from daguerre.motion.values import at as value_at
from daguerre.scene.transforms import compose, without_scale

from .quaternions import moving_turns
from .values import Clock, plain

Matrix = NDArray[np.float64]
_AXES = {"X": 0, "Y": 1, "Z": 2}
#: Difference of the last column of a matrix from 0, 0, 0, 1 that is rounding.
_EXACT = 1e-5
_BENT = (
    "a transform whose last column is not 0, 0, 0, 1 is made affine: divided by its last number, "
    "without perspective"
)


@dataclass(frozen=True, eq=False)
class Operation(Value):
    """An operation of a stack.

    Attributes:
        kind: ``transform``, ``translate``, ``scale``, ``rotate`` or ``orient``.
        axes: Axes of a translation or scale along some axes, or of rotations, in their order.
        value: Its numbers: a matrix, lengths, factors, degrees or a quaternion; or such over time.
        inverse: Whether the inverse is meant.
    """

    kind: str
    axes: str
    value: Any
    inverse: bool

    def at(self, time_s: float) -> Matrix:
        """The matrix at a time, s."""
        value = value_at(self.value, time_s)
        if self.kind == "transform":
            made = np.array(value, np.float64)
        elif self.kind == "orient":
            made = _of_quaternion(value)
        else:
            numbers = np.atleast_1d(np.asarray(value, np.float64))
            made = _MAKERS[self.kind](numbers, self.axes)
        return np.asarray(np.linalg.inv(made), np.float64) if self.inverse else made

    def breaks(self, begin: float, end: float) -> Sequence[float]:
        """Times of the keys of its value, s."""
        return self.value.breaks(begin, end) if is_dynamic(self.value) else []


@dataclass(frozen=True, eq=False)
class Transform(Value):
    """A product of transforms, constant or over time, the outermost first."""

    parts: tuple[Matrix | Dynamic, ...]

    def at(self, time_s: float) -> Matrix:
        """The matrix at a time, s."""
        made = np.eye(4)
        for part in self.parts:
            made = made @ (part if isinstance(part, np.ndarray) else part.at(time_s))
        return made

    def breaks(self, begin: float, end: float) -> list[float]:
        """Breaks of all parts, s."""
        moving = [part for part in self.parts if not isinstance(part, np.ndarray)]
        return sorted({float(t) for part in moving for t in part.breaks(begin, end)})


@dataclass(frozen=True, eq=False)
class Rigid(Value):
    """A transform without its scale, over time: that of a camera or a lamp."""

    transform: Dynamic

    def at(self, time_s: float) -> Matrix:
        """The matrix at a time, s; the identity where an axis vanishes."""
        found = without_scale(self.transform.at(time_s))
        return np.eye(4) if found is None else found

    def breaks(self, begin: float, end: float) -> Sequence[float]:
        """Breaks of the transform, s."""
        return [float(t) for t in self.transform.breaks(begin, end)]


@dataclass(frozen=True, eq=False)
class Place(Value):
    """A point of a transform over time: its origin."""

    transform: Dynamic

    def at(self, time_s: float) -> Matrix:
        """World position at a time, s, shape (3,), m."""
        return np.array(self.transform.at(time_s)[:3, 3])

    def breaks(self, begin: float, end: float) -> Sequence[float]:
        """Breaks of the transform, s."""
        return [float(t) for t in self.transform.breaks(begin, end)]


def joined(outer: Matrix | Transform, inner: Sequence[Any]) -> Matrix | Transform:
    """Multiplies a transform by matrices and operations; a matrix if none moves."""
    parts = [*(outer.parts if isinstance(outer, Transform) else [outer])]
    for part in inner:
        still = part.at(0.0) if _is_still(part) else part
        if isinstance(still, np.ndarray) and isinstance(parts[-1], np.ndarray):
            parts[-1] = parts[-1] @ still
        else:
            parts.append(still)
    if len(parts) == 1 and isinstance(parts[0], np.ndarray):
        return parts[0]
    return Transform(tuple(parts))


def _is_still(part: Any) -> bool:
    return isinstance(part, Operation) and not is_dynamic(part.value)


def rigid(world: Matrix | Transform) -> Matrix | Rigid | None:
    """World from a camera or lamp, without scale; None if an axis vanishes."""
    return without_scale(world) if isinstance(world, np.ndarray) else Rigid(world)


def position(world: Matrix | Transform, time: float) -> Matrix:
    """Origin of a transform at a time, shape (3,), m."""
    return np.array(value_at(world, time)[:3, 3])


def local(prim: Usd.Prim, clock: Clock, notes: Notes) -> tuple[list[Operation], bool]:
    """Operations of a prim, the outermost first, and whether they replace those of its parents.

    Args:
        prim: The prim.
        clock: Time codes of the stage.
        notes: Receives a note on matrices that are not affine.

    Raises:
        InputError: A number is not finite, or an inverse does not exist.
    """
    xformable = UsdGeom.Xformable(prim)
    if not xformable:
        return [], False
    ops = [made for op in xformable.GetOrderedXformOps() if (made := _operation(op, clock, notes))]
    return ops, bool(xformable.GetResetXformStack())


def _operation(op: UsdGeom.XformOp, clock: Clock, notes: Notes) -> Operation | None:
    kind, axes = _kind(str(UsdGeom.XformOp.GetOpTypeToken(op.GetOpType())))
    attribute = op.GetAttr()
    where = f"{clock.file}: {attribute.GetPath()}"
    affine = _Affine(where)
    value = clock.value(attribute, affine if kind == "transform" else plain)
    if value is None:
        return None
    if kind == "orient" and is_dynamic(value):
        value = moving_turns(value)
    if affine.changed:
        notes.add(_BENT)
    made = Operation(kind, axes, value, bool(op.IsInverseOp()))
    _check(made, where, clock.time)
    return made


def _check(made: Operation, where: str, time: float) -> None:
    stated = made.value.values if is_dynamic(made.value) else made.value
    if not np.isfinite(np.asarray(stated, np.float64)).all():
        raise InputError(f"{where}: wanted finite numbers, got NaN or infinity")
    try:
        matrix = made.at(time)
    except np.linalg.LinAlgError:
        raise InputError(f"{where}: the inverted operation has no inverse") from None
    if not np.isfinite(matrix).all():
        raise InputError(f"{where}: wanted finite numbers, got NaN or infinity")


class _Affine:
    """Converts matrices of USD to affine ones.

    USD multiplies homogeneous coordinates and divides by the last one, so 0, 0, 0, w in the last
    column is a division by w. A perspective is dropped; the origin keeps its place.

    Source: OpenUSD, GfMatrix4d::Transform, and the shaders of Storm. (HdEmbree ignores the column.)

    Attributes:
        changed: Whether one was not affine.
    """

    def __init__(self, where: str) -> None:
        self._where = where
        self.changed = False

    def __call__(self, value: Any) -> Matrix:
        """An affine matrix that acts on column vectors, shape (4, 4).

        Raises:
            InputError: A number is not finite, or the last one is 0.
        """
        made: Matrix = plain(value)
        if not np.isfinite(made).all():
            raise InputError(f"{self._where}: wanted finite numbers, got NaN or infinity")
        if not made[3, 3]:
            raise InputError(f"{self._where}: the last number must not be 0")
        self.changed |= bool(np.abs(made[3] - (0, 0, 0, 1)).max() > _EXACT)
        made = made / made[3, 3]
        made[3] = 0, 0, 0, 1
        return made


def _kind(name: str) -> tuple[str, str]:
    for kind in ("translate", "scale", "rotate"):
        if name.startswith(kind):
            return kind, name.removeprefix(kind) or "XYZ"
    return name, ""


def _translation(lengths: Matrix, axes: str) -> Matrix:
    made = np.eye(4)
    for axis, length in zip(axes, lengths, strict=True):
        made[_AXES[axis], 3] = length
    return made


def _scale(factors: Matrix, axes: str) -> Matrix:
    made = np.eye(4)
    for axis, factor in zip(axes, factors, strict=True):
        made[_AXES[axis], _AXES[axis]] = factor
    return made


def _rotation(degrees: Matrix, axes: str) -> Matrix:
    """Turns about axes, the first one innermost; angles belong to x, y, z in that order."""
    made = np.eye(4)
    for axis in axes:
        angle = degrees[0] if len(axes) == 1 else degrees[_AXES[axis]]
        made = _turn(_AXES[axis], math.radians(float(angle))) @ made
    return made


def _turn(axis: int, angle: float) -> Matrix:
    made, i, j = np.eye(4), (axis + 1) % 3, (axis + 2) % 3
    made[i, i] = made[j, j] = math.cos(angle)
    made[j, i] = math.sin(angle)
    made[i, j] = -made[j, i]
    return made


def _of_quaternion(xyzw: Any) -> Matrix:
    q = np.asarray(xyzw, np.float64)
    length = float(np.linalg.norm(q))
    unit = q / length if length > 0 else np.array([0.0, 0.0, 0.0, 1.0])
    return compose(np.zeros(3), unit, np.ones(3))


_MAKERS = {"translate": _translation, "scale": _scale, "rotate": _rotation}
