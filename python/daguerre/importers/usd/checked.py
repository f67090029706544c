"""Reads attributes of a prim with checks, so that each error names the attribute."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NoReturn

import numpy as np
from pxr import Sdf, Usd

from daguerre.camera.parameters import CAMERA
from daguerre.checks import number, short
from daguerre.errors import InputError, UsageError
from daguerre.files.notes import Notes
from daguerre.motion.values import Keys

from .stage_facts import StageFacts
from .values import authored, path_text, plain

_SINGLE = ("float", "float2", "float3", "float4", "float[]")


class Checked:
    """Attributes of a prim.

    Args:
        prim: The prim.
        stage: Facts of the stage.
        notes: Notes of the reader.
    """

    def __init__(self, prim: Usd.Prim, stage: StageFacts, notes: Notes) -> None:
        self.prim, self.stage, self.notes = prim, stage, notes

    def place(self, name: str) -> str:
        """Place of an attribute, for messages."""
        return f"{self.stage.file}: {path_text(self.prim.GetPath())}.{name}"

    def fail(self, name: str, wanted: str, got: object) -> NoReturn:
        """Refuses the value of an attribute."""
        raise InputError(f"{self.place(name)}: wanted {wanted}, got {got}")

    def is_authored(self, name: str) -> bool:
        """Whether the stage itself has a value of an attribute."""
        return authored(self.prim.GetAttribute(name))

    def now(self, name: str) -> Any:
        """Value at the scene's time, as plain Python values; None: no value."""
        return self.at(name, self.stage.clock.code)

    def at(self, name: str, code: Usd.TimeCode) -> Any:
        """Value at a time code, as plain Python values; None: no value."""
        attribute = self.prim.GetAttribute(name)
        value = attribute.Get(code) if attribute else None
        return None if value is None else _plain(attribute, value)

    def finite(self, name: str, value: object) -> float:
        """Checks a finite number."""
        return self._number(name, value, -math.inf, None)

    def fixed(self, name: str) -> Any:
        """Value at the scene's time; a note if it changes over time."""
        if self.stage.clock.codes(self.prim.GetAttribute(name)):
            self.notes.add(f"{name} of a camera changes over time; its value at one time is kept")
        return self.now(name)

    def number(self, name: str, low: float = -math.inf, above: float | None = None) -> float | None:
        """Finite number at the scene's time.

        Args:
            name: Attribute.
            low: Least value.
            above: Number that must be exceeded.
        """
        value = self.fixed(name)
        return None if value is None else self._number(name, value, low, above)

    def numbers(self, name: str, count: int | None = None, *, scalar: bool = False) -> Any:
        """Finite numbers at the scene's time, as a tuple.

        Args:
            name: Attribute.
            count: Count; None: any.
            scalar: Whether a single number, which is returned as such, will do as well.
        """
        value = self.fixed(name)
        if value is None:
            return None
        if scalar and isinstance(value, int | float):
            return self._number(name, value, -math.inf, None)
        return self._tuple(name, value, count)

    def moving(self, name: str, convert: Callable[[float], float]) -> Any:
        """Finite number over time: a constant or keys, each converted; None: no value."""
        attribute = self.prim.GetAttribute(name)

        def each(value: object) -> float:
            return convert(self._number(name, _plain(attribute, value), -math.inf, None))

        return self.stage.clock.value(attribute, each)

    def moving_numbers(self, name: str) -> Any:
        """Finite numbers over time: a tuple or keys of tuples; None: there are none."""
        attribute = self.prim.GetAttribute(name)

        def each(value: object) -> tuple[float, ...]:
            return self._tuple(name, _plain(attribute, value), None)

        return self.stage.clock.value(attribute, each)

    def text(self, name: str) -> str | None:
        """Name or text at the scene's time; None: missing or empty."""
        value = self.fixed(name)
        if value is not None and not isinstance(value, str):
            self.fail(name, "a name", short(value))
        return value or None

    def asset(self, name: str) -> str | None:
        """Path of an asset, as authored; None: missing or empty."""
        value = self.fixed(name)
        if value is not None and not isinstance(value, Sdf.AssetPath):
            self.fail(name, "an asset", short(value))
        return None if value is None else str(value.path) or None

    def accepted(self, name: str, field: str, value: object) -> Any:
        """Checks a value, or each of its keys, for a parameter of ``Camera``."""
        for part in value.values if isinstance(value, Keys) else (value,):
            try:
                CAMERA[field].check(part, self.place(name))
            except UsageError as error:
                raise InputError(str(error)) from None
        return value

    def within(self, name: str, field: str, value: object) -> Any:
        """Checks a number, or each of its keys, by the limits of a parameter of ``Camera``."""
        row = CAMERA[field]
        for part in value.values if isinstance(value, Keys) else (value,):
            where = self.place(name)
            number(part, where, row.low, row.high, infinite=row.infinite, error=InputError)
        return value

    def _tuple(self, name: str, value: object, count: int | None) -> tuple[float, ...]:
        wanted = f"{count or 'some'} finite numbers"
        try:
            found = tuple(np.asarray(value, np.float64).ravel().tolist())
        except (TypeError, ValueError):
            self.fail(name, wanted, short(value))
        if (count is not None and len(found) != count) or not all(map(math.isfinite, found)):
            self.fail(name, wanted, short(value))
        return found

    def _number(self, name: str, value: Any, low: float, above: float | None) -> float:
        fits = isinstance(value, int | float) and not isinstance(value, bool)
        if not fits or not math.isfinite(value):
            self.fail(name, "a finite number", short(value))
        if value < low:
            self.fail(name, f"at least {low:g}", f"{value:g}")
        if above is not None and not value > above:
            self.fail(name, f"a number above {above:g}", f"{value:g}")
        return float(value)


def _plain(attribute: Usd.Attribute, value: object) -> Any:
    """Plain Python value; single precision as the shortest decimal that rounds to it."""
    made = plain(value)
    if str(attribute.GetTypeName()) not in _SINGLE:
        return made
    if isinstance(made, float):
        return _decimal(made)
    if isinstance(made, tuple):
        return tuple(_decimal(part) for part in made)
    return made


def _decimal(value: float) -> float:
    return float(str(np.float32(value)))
