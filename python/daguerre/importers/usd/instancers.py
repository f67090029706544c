"""Reads point instancers: many copies of prototypes, at rest or moving."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import Usd, UsdGeom

from daguerre.errors import InputError
from daguerre.files.notes import Notes
from daguerre.scene.over_time.crowds import Crowd
from daguerre.scene.over_time.quaternions import normalized, of_vectors, product

from .values import Clock

Array = NDArray[np.float64]
#: Maximum number of copies in all samples of an instancer.
_MAX_COPIES = 20_000_000


@dataclass(frozen=True, eq=False)
class Copies:
    """Copies of a prototype.

    Attributes:
        prototype: Prim of the prototype.
        transforms: Instancer from prototype's parent, shape (N, 4, 4).
        moving: The same over time; None if they rest.
    """

    prototype: Usd.Prim
    transforms: Array
    moving: Crowd | None

    def __len__(self) -> int:
        return len(self.transforms)


def read_copies(prim: Usd.Prim, clock: Clock, notes: Notes) -> list[Copies]:
    """Reads the visible copies of an instancer, by prototype.

    Raises:
        InputError: The arrays do not fit together, or a number is not finite.
    """
    instancer = UsdGeom.PointInstancer(prim)
    where = f"{clock.file}: {prim.GetPath()}"
    lacking = _lacking(instancer, clock)
    if lacking:
        notes.add(f"a point instancer without {lacking} is left out")
        return []
    kinds = clock.integers(instancer.GetProtoIndicesAttr())
    targets = instancer.GetPrototypesRel().GetForwardedTargets()
    if not len(kinds):
        return []
    if kinds.min() < 0 or kinds.max() >= len(targets):
        raise InputError(
            f"{where}.protoIndices: wanted 0 .. {len(targets) - 1}, one of the prototypes, "
            f"got {kinds.min() if kinds.min() < 0 else kinds.max()}"
        )
    crowd = _InstancerReader(prim, len(kinds), clock, notes).crowd()
    now = crowd.at(clock.time)
    shown = np.asarray(instancer.ComputeMaskAtTime(clock.code) or [True] * len(kinds), bool)
    if clock.codes(instancer.GetInvisibleIdsAttr()):
        notes.add(
            "copies of a point instancer that appear and vanish are shown as at the scene's time"
        )
    made = []
    for i, path in enumerate(targets):
        numbers = np.flatnonzero((kinds == i) & shown)
        prototype = prim.GetStage().GetPrimAtPath(path)
        if not prototype:
            notes.add("a prototype of a point instancer is missing")
        elif len(numbers):
            made.append(Copies(prototype, now[numbers], crowd.of(numbers) if crowd.moves else None))
    return made


def _lacking(instancer: UsdGeom.PointInstancer, clock: Clock) -> str:
    """Name of a required attribute that an instancer lacks; empty: complete, or no copies."""
    kinds = instancer.GetProtoIndicesAttr().Get(clock.code)
    if kinds is None:
        return "protoIndices"
    if not len(kinds):
        return ""
    if not instancer.GetPrototypesRel().GetForwardedTargets():
        return "prototypes"
    return "" if len(instancer.GetPositionsAttr().Get(clock.code) or ()) else "positions"


class _InstancerReader:
    """Reads the arrays of an instancer with ``count`` copies."""

    def __init__(self, prim: Usd.Prim, count: int, clock: Clock, notes: Notes) -> None:
        self._prim, self._count, self._clock, self._notes = prim, count, clock, notes
        narrow, wide = (prim.GetAttribute(name) for name in ("orientations", "orientationsf"))
        self._turns = wide if clock.now(wide) else narrow

    def crowd(self) -> Crowd:
        """The copies over time; if their number changes, the copies of the scene's time."""
        places = self._attribute("positions")
        starts, turning = self._samples(places), self._samples(self._turns)
        flies = bool(starts) and starts == self._samples(self._attribute("velocities"))
        spins = bool(turning) and turning == self._samples(self._attribute("angularVelocities"))
        codes = sorted({*starts, *turning, *self._samples(self._attribute("scales"))})
        codes = codes or [float(self._clock.code.GetValue())]
        needed = self._clock.around(codes)
        self._check(codes[needed])
        counts = [self._found(places, _base(starts, c) if flies else c) for c in codes]
        if any(count != self._count for count in counts):
            now = float(self._clock.code.GetValue())
            codes = [_base(starts, now) if starts else now]
            if not flies:
                codes = [now]
            if not flies and len(counts) > 1:
                self._notes.add(
                    "copies whose number changes over time are shown at rest, as at "
                    "the scene's time"
                )
        else:
            codes = codes[needed]
        return self._made(codes, starts if flies else [], turning if spins else [])

    def _made(self, codes: list[float], starts: list[float], turning: list[float]) -> Crowd:
        flights = [self._flight(code, starts) for code in codes]
        turns = [self._turn(code, turning) for code in codes]
        scales = [self._each(self._attribute("scales"), code, 3, 1.0) for code in codes]
        parts = [*zip(*flights, strict=True), *zip(*turns, strict=True), scales]
        place, velocity, acceleration, turn, spin, scale = (
            None if any(sample is None for sample in part) else np.stack(part) for part in parts
        )
        assert place is not None
        assert turn is not None
        assert scale is not None
        times = np.array([self._clock.seconds(code) for code in codes])
        return Crowd(times, place, turn, scale, velocity, acceleration, spin, self._clock.holds)

    def _flight(self, code: float, starts: list[float]) -> tuple[Array, Any, Any]:
        """Positions at a time code, and velocities and accelerations if they fly."""
        places, base = self._attribute("positions"), _base(starts, code)
        place = self._each(places, base, 3, None)
        velocity = self._optional("velocities", base) if starts else None
        if velocity is None:
            return place, None, None
        dt = self._clock.seconds(code - base)
        accelerations = self._attribute("accelerations")
        follows = self._samples(accelerations) == starts
        acceleration = self._optional("accelerations", base) if follows else None
        if acceleration is None:
            return place + dt * velocity, velocity, None
        return (
            place + dt * (velocity + 0.5 * dt * acceleration),
            velocity + dt * acceleration,
            acceleration,
        )

    def _turn(self, code: float, turning: list[float]) -> tuple[Array, Any]:
        """Quaternions at a time code, and angular velocities if they spin."""
        base = _base(turning, code)
        turn = normalized(self._each(self._turns, base, 4, (0, 0, 0, 1)))
        spin = self._optional("angularVelocities", base) if turning else None
        if spin is None:
            return turn, None
        spin = np.radians(spin)
        return product(of_vectors(self._clock.seconds(code - base) * spin), turn), spin

    def _attribute(self, name: str) -> Usd.Attribute:
        return self._prim.GetAttribute(name)

    def _samples(self, attribute: Usd.Attribute) -> list[float]:
        return self._clock.codes(attribute, single=True)

    def _check(self, codes: list[float]) -> None:
        if len(codes) * self._count > _MAX_COPIES:
            raise InputError(
                f"{self._clock.file}: {self._prim.GetPath()}: wanted at most {_MAX_COPIES} copies "
                f"in all time samples, got {len(codes) * self._count}"
            )

    def _found(self, attribute: Usd.Attribute, code: float) -> int:
        """Number of elements at a time code."""
        value = attribute.Get(Usd.TimeCode(code)) if attribute else None
        return 0 if value is None else len(value)

    def _rows(self, attribute: Usd.Attribute, code: float, columns: int) -> Array | None:
        value = attribute.Get(Usd.TimeCode(code)) if attribute else None
        if value is None or not len(value):
            return None
        rows = np.asarray(value, np.float64)
        if rows.ndim != 2 or rows.shape[1] != columns or not np.isfinite(rows).all():
            where = f"{self._clock.file}: {attribute.GetPath()}"
            raise InputError(f"{where}: numbers must be finite")
        return rows

    def _each(self, attribute: Usd.Attribute, code: float, columns: int, default: object) -> Array:
        """A row for each copy; where there are none, a default, or an error."""
        rows = self._rows(attribute, code, columns)
        if rows is not None and len(rows) > self._count:
            self._notes.add(
                f"{attribute.GetName()} of a point instancer has more elements than copies: "
                f"only the first ones are used"
            )
            rows = rows[: self._count]
        if rows is None and default is not None:
            return np.broadcast_to(np.asarray(default, np.float64), (self._count, columns))
        if rows is None or len(rows) != self._count:
            raise InputError(
                f"{self._clock.file}: {attribute.GetPath()}: wanted {self._count}, one for each of "
                f"protoIndices, got {0 if rows is None else len(rows)}"
            )
        return rows

    def _optional(self, name: str, code: float) -> Array | None:
        """A row for each copy; None if there are none, or another number."""
        rows = self._rows(self._attribute(name), code, 3)
        if rows is not None and len(rows) != self._count:
            self._notes.add(f"{name} of a point instancer does not have one element per copy")
            return None
        return rows


def _base(codes: list[float], code: float) -> float:
    """The last of ``codes`` up to ``code``, else the first; ``code`` if there are none."""
    before = [other for other in codes if other <= code]
    return before[-1] if before else codes[0] if codes else code
