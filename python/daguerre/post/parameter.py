"""Parameters of effects: physical, each with its unit, from a command line or from JSON."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, Literal

from daguerre.errors import InputError, UsageError, suggest
from daguerre.files.json_item import short

Kind = Literal["number", "whole", "flag", "choice", "text", "size"]

REQUIRED = object()
#: Texts of numbers may have another unit of the same kind: 2.5m, 250cm.
_PARSERS = {"mm": "length_mm", "m": "distance_m", "s": "time_s", "deg": "angle_deg"}


@dataclass(frozen=True)
class Parameter:
    """A parameter of an effect.

    Attributes:
        name: Name that users type.
        meaning: Help text of one line.
        unit: Such as mm, px, stops; empty: none.
        default: None: not given; REQUIRED: there is none.
        kind: number; whole; flag (0 or 1); choice; text (a name or a file); size (two lengths
            such as 36x24, in the unit).
        choices: Values of a choice.
        low: The least that a number may be.
        high: The most.
    """

    name: str
    meaning: str
    unit: str = ""
    default: Any = None
    kind: Kind = "number"
    choices: tuple[str, ...] = field(default=())
    low: float = -math.inf
    high: float = math.inf

    @property
    def required(self) -> bool:
        """Whether it must be given."""
        return self.default is REQUIRED

    @property
    def wanted(self) -> str:
        """Values that it may have, for messages."""
        if self.kind == "choice":
            return "one of " + ", ".join(self.choices)
        if self.kind == "flag":
            return "0 or 1"
        if self.kind == "size":
            return f"width x height in {self.unit} such as 36x24"
        if self.kind == "text":
            return self.meaning
        words = "a whole number" if self.kind == "whole" else "a number"
        words += f" of {self.unit}" if self.unit else ""
        words += f" of at least {self.low:g}" if self.low > -math.inf else ""
        return words + (f" and at most {self.high:g}" if self.high < math.inf else "")

    def read(self, value: Any, where: str, error: type[InputError | UsageError]) -> Any:
        """The value that a text, or a value of JSON, stands for."""
        try:
            result = self._read(value, where)
        except (UsageError, ValueError, TypeError, OverflowError):
            result = None
        if result is None:
            near = suggest(str(value), self.choices) if self.kind == "choice" else ""
            raise error(f"{where}: wanted {self.wanted}, got {short(value)}{near}")
        return result

    def _read(self, value: Any, where: str) -> Any:
        """None: not what is wanted."""
        match self.kind:
            case "text":
                return value if isinstance(value, str) and value else None
            case "choice":
                return value if value in self.choices else None
            case "flag":
                return {"0": False, "1": True, "false": False, "true": True}.get(str(value).lower())
            case "size":
                return _size(value, where)
        if isinstance(value, bool):
            return None
        number = _number(value, self.unit, where) if isinstance(value, str) else float(value)
        if self.kind == "whole":
            number = int(number) if number == int(number) else math.nan
        fits = self.low <= number <= self.high and (
            math.isfinite(number) or (self.unit == "m" and number > 0)
        )
        return number if fits else None


def _number(text: str, unit: str, where: str) -> float:
    from daguerre import units as quantities  # the command line's words; arrays need none of it

    if unit in _PARSERS:
        return float(getattr(quantities, _PARSERS[unit])(where, text))
    return quantities.plain_number(where, text, "")


def _size(value: Any, where: str) -> tuple[float, float] | None:
    from daguerre import units as quantities

    if isinstance(value, str):
        return quantities.sensor_mm(where, value)
    width, height = (float(v) for v in value)
    return (width, height) if 0 < width < math.inf and 0 < height < math.inf else None
