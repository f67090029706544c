"""Colour, strength and visibility of lights over time."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from daguerre.files.value import Value
from daguerre.motion.values import Keys, is_dynamic
from daguerre.motion.values import at as value_at

from .blackbody import Color, blackbody

if TYPE_CHECKING:
    from daguerre.motion.values import Dynamic


WHITE = (1.0, 1.0, 1.0)
#: Largest luminance; its product with an area still fits into single precision.
MOST = 1e30
#: Most stops, either way; double precision holds the power of two.
_STOPS = 1000.0


@dataclass(frozen=True, eq=False)
class Shown(Value):
    """Visibility over time: whether all of some flags are set."""

    flags: tuple[Keys, ...]

    def at(self, time_s: float) -> bool:
        """Whether the prim is visible at a time, s."""
        return all(flag.at(time_s) for flag in self.flags)

    def breaks(self, begin: float, end: float) -> list[float]:
        """Times of all keys, s."""
        return sorted({t for flag in self.flags for t in flag.breaks(begin, end)})


@dataclass(frozen=True, eq=False)
class Emission(Value):
    """Colour and strength of a light, each constant or over time.

    Attributes:
        intensity: Factor.
        exposure: Stops.
        color: Linear Rec.709.
        temperature: Colour temperature, K; None: no tint.
        shown: Whether the light is on.
        factor: Constant factor, such as one over the area.
    """

    intensity: float | Dynamic = 1.0
    exposure: float | Dynamic = 0.0
    color: Color | Dynamic = WHITE
    temperature: float | Dynamic | None = None
    shown: bool | Shown = True
    factor: float = 1.0

    def at(self, time_s: float) -> Color:
        """The colour at a time, s, each part from 0 to ``MOST``."""
        if not value_at(self.shown, time_s):
            return (0.0, 0.0, 0.0)
        stops = min(max(value_at(self.exposure, time_s), -_STOPS), _STOPS)
        strength = value_at(self.intensity, time_s) * 2.0**stops * self.factor
        r, g, b = (bounded(strength * hue) for hue in self.hue(time_s))
        return (r, g, b)

    def hue(self, time_s: float) -> Color:
        """The colour, tinted, without strength."""
        kelvin = value_at(self.temperature, time_s)
        tint = WHITE if kelvin is None else blackbody(kelvin)
        r, g, b = (c * t for c, t in zip(value_at(self.color, time_s), tint, strict=True))
        return (r, g, b)

    @property
    def keeps_hue(self) -> bool:
        """Whether only the strength changes over time."""
        return not (is_dynamic(self.color) or is_dynamic(self.temperature))

    def breaks(self, begin: float, end: float) -> list[float]:
        """Times of all keys, s."""
        moving = [part for part in self._parts if is_dynamic(part)]
        return sorted({float(t) for part in moving for t in part.breaks(begin, end)})

    @property
    def _parts(self) -> tuple[Any, ...]:
        return (self.intensity, self.exposure, self.color, self.temperature, self.shown)

    def scaled(self, factor: float) -> Emission:
        """The same light, times a factor."""
        return replace(self, factor=self.factor * factor)

    def now(self) -> Color | Emission:
        """A constant colour, if no part changes."""
        return self if any(map(is_dynamic, self._parts)) else self.at(0.0)


def bounded(value: float) -> float:
    """Clamps a luminance to 0 .. ``MOST``; NaN becomes 0."""
    return min(max(0.0, value), MOST)  # max keeps its first argument against a NaN


@dataclass(frozen=True, eq=False)
class Strength(Value):
    """Strength of a white light over time."""

    emission: Emission

    def at(self, time_s: float) -> float:
        """The strength at a time, s."""
        return self.emission.at(time_s)[0]

    def breaks(self, begin: float, end: float) -> list[float]:
        """Times of all keys, s."""
        return self.emission.breaks(begin, end)
