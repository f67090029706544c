"""Reads attributes of USD as constants, or as keys over time.

USD interpolates time samples linearly, or holds them if the type or the stage asks for it, and
keeps the first and the last value outside of them: the law of :func:`daguerre.keys`. Splines are
sampled. Where a sample is blocked, USD has no value; here the previous value goes on.
"""

from __future__ import annotations

import itertools
import re
from bisect import bisect_right
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import Gf, Sdf, Usd

from daguerre.checks import short
from daguerre.errors import InputError
from daguerre.motion.values import MAX_TIME, Keys, keys

#: Samples of a spline for each time code.
_PER_CODE = 4
#: Maximum number of time samples of an attribute.
_MAX_SAMPLES = 100_000
#: Times before a knot at which a spline may jump, time codes.
_BEFORE = 1e-4
#: Types that USD interpolates, also as arrays.
_LINEAR = re.compile(
    r"(VtArray<)?(\w+::half|float|double|GfTimeCode|GfMatrix\dd|Gf(Vec\d|Quat)[dfh])>?"
)

Convert = Callable[[Any], Any]


def plain(value: Any) -> Any:
    """Converts a value of USD: vectors to tuples, quaternions to (x, y, z, w), tokens to texts."""
    if isinstance(value, Gf.Quatf | Gf.Quatd | Gf.Quath):
        return (*(float(v) for v in value.GetImaginary()), float(value.GetReal()))
    if type(value).__name__.startswith("Matrix"):
        return np.array(value, np.float64).T
    if type(value).__module__ == "pxr.Gf" and hasattr(value, "__len__"):
        return tuple(float(v) for v in value)
    return value


@dataclass
class Moments:
    """The times that will be drawn: arrays over time need only samples around them.

    Attributes:
        begin: Begin, s.
        end: End, s.
        left_out: Whether samples were left out.
    """

    begin: float
    end: float
    left_out: bool = False

    def part(self, times: list[float]) -> slice:
        """Part of increasing times, s, that encloses the moments; two times, if there are two."""
        first = max(bisect_right(times, self.begin) - 1, 0)
        last = min(bisect_right(times, self.end) + 1, len(times))
        if last - first < 2:
            first, last = max(first - 1, 0), min(last + 1, len(times))
        self.left_out |= last - first < len(times)
        return slice(first, last)


@dataclass(frozen=True)
class Clock:
    """The time codes of a stage.

    Attributes:
        file: File, for messages.
        rate: Time codes per second.
        time: Scene time, s.
        holds: Whether the stage holds values between samples.
        moments: Times that will be drawn; None: any time.
        borrows: Whether large arrays may stay in USD's memory, possibly a mapped file: in a helper
            process, which sends them at once to a process that checks them.
    """

    file: str
    rate: float
    time: float
    holds: bool = False
    moments: Moments | None = None
    borrows: bool = False

    @property
    def code(self) -> Usd.TimeCode:
        """Time code of the scene's time."""
        return Usd.TimeCode(self.time * self.rate)

    def seconds(self, code: float) -> float:
        """Scene time of a time code, s."""
        return code / self.rate

    def now(self, attribute: Usd.Attribute) -> Any:
        """Value of an attribute at the scene's time, or None."""
        return attribute.Get(self.code) if attribute else None

    def integers(self, attribute: Usd.Attribute) -> NDArray[np.int64]:
        """Whole numbers of an attribute at the scene's time, shape (N,); none without a value.

        Raises:
            InputError: A stage states values of another type.
        """
        return self._array(attribute, "iu", "whole numbers").astype(np.int64)

    def numbers(self, attribute: Usd.Attribute) -> NDArray[np.float64]:
        """Numbers of an attribute at the scene's time, shape (N,); none without a value.

        Raises:
            InputError: A stage states values of another type.
        """
        return self._array(attribute, "iuf", "numbers").astype(np.float64)

    def _array(self, attribute: Usd.Attribute, kinds: str, wanted: str) -> NDArray[Any]:
        value = self.now(attribute)
        found = np.asarray([] if value is None else value).reshape(-1)
        if found.size and found.dtype.kind not in kinds:
            where = f"{self.file}: {attribute.GetPath()}"
            raise InputError(f"{where}: wanted {wanted}, got {short(str(value))}")
        return found

    def codes(self, attribute: Usd.Attribute, *, single: bool = False) -> list[float]:
        """Time codes at which an attribute has samples; none if it does not change.

        Args:
            attribute: The attribute.
            single: Whether a single sample counts, as with velocities.

        Raises:
            InputError: There are too many time codes, or a code is not finite.
        """
        if not attribute or not (single or attribute.ValueMightBeTimeVarying()):
            return []
        found = list(attribute.GetTimeSamples()) or _spline_codes(attribute)
        where = f"{self.file}: {attribute.GetPath()}: time samples"
        if len(found) > _MAX_SAMPLES:
            raise InputError(f"{where}: wanted at most {_MAX_SAMPLES}, got {len(found)}")
        bad = [code for code in found if not abs(code) <= MAX_TIME * self.rate]
        if bad:
            raise InputError(f"{where}: wanted finite times, got {bad[0]:g}")
        return found

    def around(self, codes: list[float]) -> slice:
        """Part of the time codes of an array that the moments need."""
        if self.moments is None:
            return slice(0, len(codes))
        return self.moments.part([self.seconds(code) for code in codes])

    def value(
        self, attribute: Usd.Attribute, convert: Convert = plain, *, large: bool = False
    ) -> Any:
        """Value of an attribute: a constant, :class:`Keys` in seconds, or None if it has none.

        Args:
            attribute: The attribute.
            convert: Converts a value; the result is a number, a tuple, an array, a flag or a name.
            large: Whether the value is a large array, which keeps only the samples that the
                moments need. All samples decide whether it changes.
        """
        if not attribute:
            return None
        codes = self.codes(attribute)
        kept = _with_values(attribute, codes, self.around(codes)) if large else slice(0, len(codes))
        pairs = _filled([(code, attribute.Get(code)) for code in codes[kept]])
        if len(pairs) < 2:
            value = attribute.Get(self.code)
            return None if value is None else convert(value)
        held = self.holds or not _interpolates(attribute)
        try:
            made = [(code, convert(value)) for code, value in pairs]
            rest = (convert(value) for value in _rest(attribute, codes, kept) if value is not None)
            return self._keys(made, held, rest)
        except InputError as error:
            text, where = str(error), f"{self.file}: {attribute.GetPath()}"
            raise InputError(text if text.startswith(self.file) else f"{where}: {text}") from None

    def _keys(self, pairs: list[tuple[float, Any]], held: bool, rest: Iterator[Any]) -> Keys | Any:
        first = pairs[0][1]
        others = itertools.chain((value for _, value in pairs[1:]), rest)
        if all(np.array_equal(first, value) for value in others):
            return first
        named = isinstance(first, str | bool)
        timed = [(self.seconds(code), value) for code, value in pairs]
        if np.shape(first) == (4, 4):
            return keys(_in_steps(timed) if held else timed, "linear")
        return keys(timed, None if named else "step" if held else "linear")


def _with_values(attribute: Usd.Attribute, codes: list[float], kept: slice) -> slice:
    """Widens a part of the samples until its ends, and more than one sample, are not blocked."""

    def has(i: int) -> bool:
        return attribute.Get(codes[i]) is not None

    first, last = kept.start, kept.stop
    while first > 0 and not has(first):
        first -= 1
    while last < len(codes) and not (
        has(last - 1) and (has(first) or sum(map(has, range(first, last))) > 1)
    ):
        last += 1
    return slice(first, last)


def _rest(attribute: Usd.Attribute, codes: list[float], kept: slice) -> Iterator[Any]:
    """Iterates over values of the samples outside of a part."""
    for code in (*codes[: kept.start], *codes[kept.stop :]):
        yield attribute.Get(code)


def _filled(pairs: list[tuple[float, Any]]) -> list[tuple[float, Any]]:
    """Gives blocked samples the value before them, which goes on until the next sample."""
    made: list[tuple[float, Any]] = []
    blocked = False
    for code, value in pairs:
        if blocked and made and value is not None:
            made.append((float(np.nextafter(code, -np.inf)), made[-1][1]))
        blocked = value is None
        if not blocked:
            made.append((code, value))
        elif made:
            made.append((code, made[-1][1]))
    return made


def _interpolates(attribute: Usd.Attribute) -> bool:
    return bool(_LINEAR.fullmatch(str(attribute.GetTypeName().type.typeName)))


def _in_steps(pairs: list[tuple[float, Any]]) -> list[tuple[float, Any]]:
    """Repeats each value just before the next key, as matrices cannot be held."""
    out: list[tuple[float, Any]] = []
    for i, (time, value) in enumerate(pairs):
        if i:
            out.append((float(np.nextafter(time, -np.inf)), pairs[i - 1][1]))
        out.append((time, value))
    return out


def _spline_codes(attribute: Usd.Attribute) -> list[float]:
    if not attribute.HasSpline():
        return []
    knots = sorted(attribute.GetSpline().GetKnots().keys())
    if not knots or not np.isfinite(knots).all():
        return []
    stage = attribute.GetStage()
    ends = (stage.GetStartTimeCode(), stage.GetEndTimeCode())
    begin, end = min(knots[0], ends[0]), max(knots[-1], ends[1])  # it may go on beyond its knots
    count = int(min((end - begin) * _PER_CODE, _MAX_SAMPLES / 2))
    between = np.linspace(begin, end, count + 2).tolist()
    return sorted({*knots, *between, *(knot - _BEFORE for knot in knots)})


def authored(attribute: Usd.Attribute) -> bool:
    """Whether a stage authors an attribute, in place of the schema's fallback."""
    return bool(attribute) and attribute.HasAuthoredValue()


def path_text(path: Sdf.Path | str) -> str:
    """Path of a prim as a text for messages."""
    return str(path)[:200]
