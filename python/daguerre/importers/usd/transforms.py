"""Reads transforms of prims: stacks of operations, constant or over time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from pxr import Usd, UsdGeom

from daguerre.checks import short
from daguerre.errors import InputError
from daguerre.files.notes import Notes
from daguerre.motion.values import Keys, is_dynamic
from daguerre.motion.values import at as value_at
from daguerre.scene.over_time.operations import Matrix, Operation, Rigid, Transform
from daguerre.scene.over_time.quaternions import moving_turns
from daguerre.scene.transforms import without_scale

from .values import Clock, plain

#: Difference of the last column of a matrix from 0, 0, 0, 1 that is rounding.
_EXACT = 1e-5
_BENT = (
    "a transform whose last column is not 0, 0, 0, 1 is made affine: divided by its last number, "
    "without perspective"
)


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


def _is_still(part: object) -> bool:
    return isinstance(part, Operation) and not is_dynamic(part.value)


def rigid(world: Matrix | Transform) -> Matrix | Rigid | None:
    """World from a camera or lamp, without scale; None if an axis vanishes."""
    return without_scale(world) if isinstance(world, np.ndarray) else Rigid(world)


def position(world: Matrix | Transform, time: float) -> Matrix:
    """Origin of a transform at a time, shape (3,), m."""
    return np.array(value_at(world, time)[:3, 3])


def local(prim: Usd.Prim, clock: Clock, notes: Notes) -> tuple[list[Operation], bool]:
    """Operations of a prim, the outermost first, and whether they reset the parents' transforms.

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
    numbers = _Numbers(where, _count(kind, axes))
    value = clock.value(attribute, affine if kind == "transform" else numbers)
    if value is None:
        return None
    if kind == "orient" and isinstance(value, Keys):
        value = moving_turns(value)
    if affine.changed:
        notes.add(_BENT)
    made = Operation(kind, axes, value, bool(op.IsInverseOp()))
    _check(made, where, clock.time)
    return made


def _count(kind: str, axes: str) -> int:
    """Numbers of an operation, other than a matrix."""
    return 4 if kind == "orient" else 1 if kind == "rotate" and len(axes) == 1 else len(axes)


@dataclass(frozen=True)
class _Numbers:
    """Converts values of an operation; a stage may state another type."""

    where: str
    count: int

    def __call__(self, value: object) -> float | tuple[float, ...]:
        """The number, or the numbers.

        Raises:
            InputError: The value has another type, or a number is not finite.
        """
        made = plain(value)
        numbers = made if isinstance(made, tuple) else (made,)
        if len(numbers) != self.count or not all(isinstance(n, int | float) for n in numbers):
            wanted = f"{self.count} numbers" if self.count > 1 else "a number"
            raise InputError(f"{self.where}: wanted {wanted}, got {short(str(value))}")
        if not all(math.isfinite(number) for number in numbers):
            raise InputError(f"{self.where}: wanted finite numbers, got NaN or infinity")
        found: float | tuple[float, ...] = made
        return found


def _check(made: Operation, where: str, time: float) -> None:
    try:
        matrix = made.at(time)
    except np.linalg.LinAlgError:
        raise InputError(f"{where}: the inverted operation has no inverse") from None
    if not np.isfinite(matrix).all():
        raise InputError(f"{where}: wanted finite numbers, got NaN or infinity")


class _Affine:
    """Converts matrices of USD to affine matrices.

    USD multiplies homogeneous coordinates and divides by the last, so 0, 0, 0, w in the last
    column is a division by w. A perspective is dropped; the origin keeps its place.

    Source: OpenUSD, GfMatrix4d::Transform, and the shaders of Storm. (HdEmbree ignores the column.)

    Attributes:
        changed: Whether a matrix was not affine.
    """

    def __init__(self, where: str) -> None:
        self._where = where
        self.changed = False

    def __call__(self, value: object) -> Matrix:
        """An affine matrix that acts on column vectors, shape (4, 4).

        Raises:
            InputError: A number is not finite, or the last number is 0.
        """
        made: Matrix = plain(value)
        if np.shape(made) != (4, 4) or made.dtype.kind != "f":
            raise InputError(f"{self._where}: wanted a matrix 4 x 4, got {short(str(value))}")
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
