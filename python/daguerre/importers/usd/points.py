"""Reads points that move: by time samples, or along velocities and accelerations.

Source: OpenUSD, UsdGeomPointBased, "Applying Timesampled Velocities to Geometry".
"""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import numpy as np
from pxr import Usd

from daguerre.errors import InputError
from daguerre.files.notes import Notes
from daguerre.motion.values import Dynamic, Keys, keys
from daguerre.scene.over_time.points import Ballistic
from daguerre.scene.over_time.surfaces import Array

from .primvars import as_rows
from .values import Clock

if TYPE_CHECKING:
    from pxr import UsdGeom


#: Maximum number of coordinates in all time samples of an attribute.
_MAX_NUMBERS = 1 << 30


def read_points(schema: UsdGeom.PointBased, clock: Clock, notes: Notes) -> Array | Dynamic:
    """Reads the points of a mesh, of curves or of points.

    Args:
        schema: ``UsdGeom.PointBased``, with points, velocities and accelerations.
        clock: Time codes of the stage.
        notes: Receives notes on points that cannot move as stated.

    Returns:
        Shape (N, 3), in the prim's space, or over time.

    Raises:
        InputError: A number is not finite.
    """
    attribute = schema.GetPointsAttr()
    now = _checked(attribute, attribute.Get(clock.code), clock)
    ballistic = _ballistic(schema, clock)
    if ballistic is not None:
        return ballistic
    codes = clock.codes(attribute)
    if len(codes) < 2:
        return now
    if any(count != len(now) for count in _counts(attribute, codes)):
        notes.add("points whose number changes over time are shown at rest, as at the scene's time")
        return now
    needed = clock.around(codes)
    samples = _samples(attribute, codes[needed], clock)
    others = (
        _checked(attribute, attribute.Get(Usd.TimeCode(code)), clock)
        for code in (*codes[: needed.start], *codes[needed.stop :])
    )
    if all(np.array_equal(sample, now) for sample in itertools.chain(samples, others)):
        return now
    times, how = (
        [clock.seconds(code) for code in codes[needed]],
        "step" if clock.holds else "linear",
    )
    if clock.borrows:
        return Keys(np.array(times), tuple(samples), how)
    return keys(zip(times, samples, strict=True), how)


def _ballistic(schema: UsdGeom.PointBased, clock: Clock) -> Ballistic | None:
    """Points along velocities, if velocities and points have the same sample times."""
    points, velocities = schema.GetPointsAttr(), schema.GetVelocitiesAttr()
    codes = clock.codes(points, single=True)
    if not codes or codes != clock.codes(velocities, single=True):
        return None
    counts = _counts(points, codes)
    if counts != _counts(velocities, codes):
        return None
    slower = schema.GetAccelerationsAttr()
    slows = clock.codes(slower, single=True) == codes
    times, needed = np.array([clock.seconds(code) for code in codes]), clock.around(codes)
    if len({*counts}) > 1:  # points come and go: the points of one sample fly
        i = max(int(np.searchsorted(times, clock.time, side="right")) - 1, 0)
        codes, counts, times = codes[i : i + 1], counts[i : i + 1], times[i : i + 1]
        needed = slice(0, 1)
    attributes = [points, velocities]
    if slows and _counts(slower, codes) == counts:
        attributes.append(slower)
    made = [tuple(_samples(given, codes[needed], clock)) for given in attributes]
    return Ballistic(times[needed], made[0], made[1], made[2] if len(made) > 2 else None)


def _counts(attribute: Usd.Attribute, codes: list[float]) -> list[int]:
    """Number of points of each sample; USD does not copy large samples."""
    return [_count(attribute.Get(Usd.TimeCode(code))) for code in codes]


def _count(value: Any) -> int:
    """Number of points: 0 if an attribute has another type, such as a number or numbers."""
    if not hasattr(value, "__len__") or not len(value) or isinstance(value[0], int | float):
        return 0
    return len(value)


def _samples(attribute: Usd.Attribute, codes: list[float], clock: Clock) -> list[Array]:
    first = attribute.Get(Usd.TimeCode(codes[0]))
    numbers = 3 * len(codes) * len(first if first is not None else ())
    if numbers > _MAX_NUMBERS:
        raise InputError(
            f"{clock.file}: {attribute.GetPath()}: wanted at most {_MAX_NUMBERS} numbers in all "
            f"time samples, got {numbers}"
        )
    return [_checked(attribute, attribute.Get(Usd.TimeCode(code)), clock) for code in codes]


def _checked(attribute: Usd.Attribute, value: object, clock: Clock) -> Array:
    if not _count(value):
        return np.zeros((0, 3), np.float32)
    rows = as_rows(value, 3)
    if rows is None:
        raise InputError(f"{clock.file}: {attribute.GetPath()}: points must be finite")
    return rows
