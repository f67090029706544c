"""Parameters: each a row that says what it means, which values it takes, and how it is typed."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass
from typing import Any, Literal

import numpy as np

from daguerre import checks, units
from daguerre.errors import InputError, UsageError, suggest
from daguerre.files.json_item import short

from .need import Need

#: ``value`` is an object of Python, which a row describes and does not check.
Kind = Literal[
    "number", "whole", "flag", "choice", "text", "size", "numbers", "file", "picture", "value"
]

REQUIRED = object()
#: Texts of numbers may have another unit of the same kind: 2.5m, 250cm.
_PARSERS = {
    "mm": units.length_mm,
    "m": units.distance_m,
    "s": units.time_s,
    "deg": units.angle_deg,
}


@dataclass(frozen=True)
class Parameter:
    """A parameter of a camera, a rendering or an effect.

    Texts name other parameters in braces, ``{f_stop}``: a help shows their flags, a docstring
    their names.

    Attributes:
        name: Name in Python and JSON.
        meaning: Help text of one phrase.
        unit: Such as mm, px, stops; empty: none.
        default: None: not given; REQUIRED: there is none.
        kind: number; whole; flag (0 or 1); choice; text (a name); size (two lengths such as 36x24,
            in the unit); numbers (``count`` of them); file; picture (a file, or an array); value.
        choices: Values of a choice.
        low: The least that a number may be.
        high: The most.
        above: A number that must be exceeded, checked before ``low``.
        infinite: Whether a number may be infinite.
        odd: Whether a whole number must be odd.
        count: Length of ``numbers``.
        wants: Wanted values in words, where kind and limits do not say all.
        hint: Advice that follows when 0 is refused.
        flags: Names on the command line, the usual one first; none: it has no flag.
        metavar: Placeholder for its value in a help; of a choice, default: the choices.
        parse: Reads the text of its flag: called with the flag's name and the text; default: by
            kind and unit.
        repeated: Whether the flag may be repeated, each with a part of the value.
        panel: Part of a help that shows it.
        default_words: The default in words, such as ``the file's, else 5.6``.
        usual: Value that is used where none is given, if that is always the same.
        tells_default: Whether texts show the default, or the usual value, itself.
        more: Sentences that follow the meaning in docstrings and pages.
        in_python: Text of a docstring, where a value of Python differs from that of the flag.
        explained: Pages of the docs that tell more, such as ``flare.md#the-body``.
        needs: Conditions that a camera must meet to take it.
        rivals: Name of a group of parameters of which at most one may be given.
        movable: Whether it may change while the shutter is open (``dg.keys``).
    """

    name: str
    meaning: str
    unit: str = ""
    default: Any = None
    kind: Kind = "number"
    choices: tuple[str, ...] = ()
    low: float = -math.inf
    high: float = math.inf
    _: KW_ONLY
    above: float | None = None
    infinite: bool = False
    odd: bool = False
    count: int = 2
    wants: str = ""
    hint: str = ""
    flags: tuple[str, ...] = ()
    metavar: str | None = None
    parse: Callable[[str, str], Any] | None = None
    repeated: bool = False
    panel: str | None = None
    default_words: str = ""
    usual: Any = None
    tells_default: bool = False
    more: str = ""
    in_python: str = ""
    explained: tuple[str, ...] = ()
    needs: tuple[Need, ...] = ()
    rivals: str = ""
    movable: bool = False

    @property
    def required(self) -> bool:
        """Whether it must be given."""
        return self.default is REQUIRED

    @property
    def flag(self) -> str:
        """Name of its flag for messages; without one its own name."""
        long = (name for name in self.flags if name.startswith("--"))
        return next(long, self.name).partition("/")[0]

    @property
    def placeholder(self) -> str | None:
        """Placeholder for its value in a help."""
        return self.metavar or "|".join(self.choices) or None

    @property
    def field(self) -> str:
        """Name of the field that holds its flag's value."""
        return self.flag.removeprefix("--").replace("-", "_")

    def takes(self, kind: str) -> bool:
        """Whether cameras of a kind make use of it."""
        return all(kind in need.kinds for need in self.needs)

    @property
    def parser(self) -> Callable[[str, str], Any] | None:
        """Reads the text of its flag; None: the command line reads its type itself."""
        if self.parse is None and self.kind == "number":
            return _PARSERS.get(self.unit)
        return units.sensor_mm if self.parse is None and self.kind == "size" else self.parse

    def from_text(self, text: str) -> Any:
        """The value that the text of its flag stands for.

        Raises:
            UsageError: The message names the flag.
        """
        return self.parser(self.flag, text) if self.parser else text

    @property
    def wanted(self) -> str:
        """Values that it may have, for messages."""
        if self.wants:
            return self.wants
        if self.kind == "choice":
            return "one of " + ", ".join(self.choices)
        if self.kind == "flag":
            return "0 or 1"
        if self.kind == "size":
            return f"width x height in {self.unit} such as 36x24"
        if self.kind == "numbers":
            return f"{self.count} numbers"
        if self.kind not in ("number", "whole"):
            return self.meaning
        words = "a whole number" if self.kind == "whole" else "a number"
        words += f" of {self.unit}" if self.unit else ""
        words += f" of at least {self.low:g}" if self.low > -math.inf else ""
        return words + (f" and at most {self.high:g}" if self.high < math.inf else "")

    def help(self, shown: Callable[[str], str]) -> str:
        """The phrase of a command's help: meaning and default.

        Args:
            shown: How to show another parameter, by its name.
        """
        default = f" [{self.default_shown}]" if self.default_shown else ""
        return fill(self.meaning + default, shown) + "."

    @property
    def default_shown(self) -> str:
        """The default for readers; empty: no text tells it."""
        if not self.tells_default:
            return self.default_words
        value = self.default if self.usual is None else self.usual
        parts = value if isinstance(value, tuple) else (value,)
        return " x ".join(f"{v:g}" if isinstance(v, float) else str(v) for v in parts)

    def read(self, value: Any, where: str, error: type[InputError | UsageError]) -> Any:
        """The value that a text, or a value of JSON, stands for.

        Args:
            value: Text of a command line, or a value of JSON.
            where: For messages, such as ``--effect grain: size``.
            error: Type of error to raise.
        """
        try:
            result = self._read(value, where)
        except (UsageError, ValueError, TypeError, OverflowError):
            result = None
        if result is None:
            near = suggest(short(value), self.choices) if self.kind == "choice" else ""
            raise error(f"{where}: wanted {self.wanted}, got {short(value)}{near}")
        return result

    def check(self, value: Any, where: str) -> None:
        """Refuses a value of Python that is none of its values; None means not given.

        Raises:
            UsageError: The message says where, what is wanted and what it got.
        """
        if value is not None or self.required:
            self.check_given(value, where)

    def check_given(self, value: Any, where: str) -> None:
        """Refuses a value of Python that is none of its values, and None."""
        match self.kind:
            case "number":
                self._check_number(value, where)
            case "flag" if not isinstance(value, bool | np.bool_):
                if not isinstance(value, int) or value not in (0, 1):
                    raise UsageError(f"{where}: wanted True or False, got {short(value)}")
            case "whole" if self.high < math.inf:
                self._check_whole(value, where)
            case "choice" if not isinstance(value, str) or value not in self.choices:
                words = (" or " if len(self.choices) == 2 else ", ").join(self.choices)
                near = suggest(short(value), self.choices)
                raise UsageError(f"{where}: wanted {self.wants or words}, got {short(value)}{near}")
            case "numbers" | "size":
                for part in checks.numbers(value, where, self.count, self.wanted):
                    self._check_number(part, where)

    def _check_whole(self, value: Any, where: str) -> None:
        low, high = int(self.low), int(self.high)
        result = checks.whole(value, where, low, high, self.wants or None)
        if self.odd and result % 2 == 0:
            raise UsageError(f"{where}: wanted {self.wanted}, got {result}")

    def _check_number(self, value: Any, where: str) -> None:
        if self.kind == "number" and self.wants:
            result = checks.number(value, where)
            if not self.low <= result <= self.high:
                raise UsageError(f"{where}: wanted {self.wants}, got {result:g}")
            return
        try:
            if self.above is not None:
                checks.number(value, where, above=self.above, infinite=self.infinite)
            checks.number(value, where, self.low, self.high, infinite=self.infinite)
        except UsageError as error:
            raise UsageError(
                f"{error}{self.hint if isinstance(value, int | float) and value == 0 else ''}"
            ) from None

    def _read(self, value: Any, where: str) -> Any:
        """None: not what is wanted."""
        match self.kind:
            case "text" | "file" | "picture":
                return value if isinstance(value, str) and value else None
            case "choice":
                return value if isinstance(value, str) and value in self.choices else None
            case "flag":
                return {"0": False, "1": True, "false": False, "true": True}.get(str(value).lower())
            case "size":
                return _size(value, where)
            case "numbers":
                return checks.numbers(value, where, self.count, self.wanted)
        if isinstance(value, bool):
            return None
        number = _number(value, self.unit, where) if isinstance(value, str) else float(value)
        if self.kind == "whole":
            number = int(number) if number == int(number) else math.nan
        fits = self.low <= number <= self.high and (
            math.isfinite(number) or (self.unit == "m" and number > 0)
        )
        return number if fits else None


def fill(text: str, shown: Callable[[str], str]) -> str:
    """The text with the parameters that it names in braces shown as a reader knows them."""
    parts = text.split("{")
    rest = (part.partition("}") for part in parts[1:])
    return parts[0] + "".join(shown(name) + after for name, _, after in rest)


def _number(text: str, unit: str, where: str) -> float:
    if unit in _PARSERS:
        return float(_PARSERS[unit](where, text))
    return units.plain_number(where, text, "")


def _size(value: Any, where: str) -> tuple[float, float] | None:
    if isinstance(value, str):
        return units.sensor_mm(where, value)
    width, height = (float(v) for v in value)
    return (width, height) if 0 < width < math.inf and 0 < height < math.inf else None
