"""Parameter: a row with meaning, accepted values, default and flag of a parameter."""

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

#: Kinds of values; ``value`` is a Python object, which a row describes but does not check.
Kind = Literal[
    "number", "whole", "flag", "choice", "text", "size", "numbers", "file", "library", "output",
    "picture", "value",
]  # fmt: skip

REQUIRED = object()
#: Parsers of numbers by unit: texts may have another unit of the same kind, as in 2.5m, 250cm.
_PARSERS = {
    "mm": units.length_mm,
    "m": units.distance_m,
    "s": units.time_s,
    "deg": units.angle_deg,
}


@dataclass(frozen=True)
class Parameter:
    """A parameter of a camera, a rendering or an effect.

    Texts name other parameters in braces, ``{f_stop}``: help texts show their flags, docstrings
    their names.

    Attributes:
        name: Name in Python and JSON.
        meaning: Help text, one phrase without a full stop.
        unit: Unit such as mm, px, stops; empty: none.
        default: Default; None: not given; REQUIRED: there is none.
        kind: number; whole; flag (0 or 1); choice; text (a name); size (two lengths such as 36x24,
            in the unit); numbers (``count`` of them); file (to read); library (a name of a library,
            or a file); output (a file to write); picture (a file, or an array); value.
        choices: Values of a choice.
        low: Smallest number allowed.
        high: Largest number allowed.
        above: Number that must be exceeded, checked before ``low``.
        infinite: Whether a number may be infinite.
        odd: Whether a whole number must be odd.
        count: Length of ``numbers``.
        wants: Accepted values in words, if kind and limits do not suffice.
        hint: Advice to append to the error if 0 is refused.
        flags: Names on the command line, the main one first; empty: no flag.
        metavar: Placeholder for its value in help; default for a choice: the choices.
        parse: Parser of the flag's text, called with the flag's name and the text; default: by
            kind and unit.
        repeated: Whether the flag may be repeated, each time with a part of the value.
        panel: Section of help that shows it.
        default_words: Default in words, such as ``the file's, else 5.6``.
        usual: Value used if none is given, if it is always the same.
        tells_default: Whether texts show the default, or the usual value.
        more: Sentences that follow the meaning in docstrings and pages, without the last full stop.
        in_python: Docstring text, if the Python value differs from the flag's value.
        explained: Pages of the docs with more, such as ``flare.md#the-body``.
        needs: Conditions that a camera must meet.
        rivals: Name of a group of parameters of which at most one may be given.
        movable: Whether it may change over time (``dg.keys``).
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
        """Name of its flag for messages; without a flag, its own name."""
        long = (name for name in self.flags if name.startswith("--"))
        return next(long, self.name).partition("/")[0]

    @property
    def placeholder(self) -> str | None:
        """Placeholder for its value in help."""
        return self.metavar or "|".join(self.choices) or None

    @property
    def field(self) -> str:
        """Name of the field that holds the value of its flag."""
        return self.flag.removeprefix("--").replace("-", "_")

    def takes(self, kind: str) -> bool:
        """Whether cameras of a kind use it."""
        return all(kind in need.kinds for need in self.needs)

    @property
    def parser(self) -> Callable[[str, str], Any] | None:
        """Parser of the text of its flag; None: the command line parses its type itself."""
        if self.parse is None and self.kind == "number":
            return _PARSERS.get(self.unit)
        return units.sensor_mm if self.parse is None and self.kind == "size" else self.parse

    def from_text(self, text: str) -> Any:
        """Parses the text of its flag.

        Raises:
            UsageError: The message names the flag.
        """
        return self.parser(self.flag, text) if self.parser else text

    @property
    def wanted(self) -> str:
        """Description of the accepted values, for messages."""
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
        """Makes the help text: meaning and default.

        Args:
            shown: Function that shows another parameter, given its name.
        """
        default = f" [{self.default_shown}]" if self.default_shown else ""
        return fill(self.meaning + default, shown) + "."

    @property
    def default_shown(self) -> str:
        """Default in words; empty: texts do not show it."""
        if not self.tells_default:
            return self.default_words
        value = self.default if self.usual is None else self.usual
        parts = value if isinstance(value, tuple) else (value,)
        return " x ".join(f"{v:g}" if isinstance(v, float) else str(v) for v in parts)

    def read(self, value: object, where: str, error: type[InputError | UsageError]) -> Any:
        """Parses a text or a JSON value.

        Args:
            value: Text of a command line, or a JSON value.
            where: Start of messages, such as ``--effect grain: size``.
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

    def check(self, value: object, where: str) -> None:
        """Checks a Python value; None means not given.

        Raises:
            UsageError: The value is not accepted; the message names it and the accepted values.
        """
        if value is not None or self.required:
            self.check_given(value, where)

    def check_given(self, value: object, where: str) -> None:
        """Checks a Python value, which must not be None."""
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

    def _check_whole(self, value: object, where: str) -> None:
        low, high = int(self.low), int(self.high)
        result = checks.whole(value, where, low, high, self.wants or None)
        if self.odd and result % 2 == 0:
            raise UsageError(f"{where}: wanted {self.wanted}, got {result}")

    def _check_number(self, value: object, where: str) -> None:
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
        """Parses a value; None: it is not accepted."""
        match self.kind:
            case "text" | "file" | "library" | "output" | "picture":
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
        number = self._number(value, where) if isinstance(value, str) else float(value)
        if self.kind == "whole":
            number = int(number) if number == int(number) else math.nan
        fits = self.low <= number <= self.high and (
            math.isfinite(number) or (self.unit == "m" and number > 0)
        )
        return number if fits else None

    def _number(self, text: str, where: str) -> float:
        parse = self.parse or _PARSERS.get(self.unit)
        return float(parse(where, text)) if parse else units.plain_number(where, text, "")


def fill(text: str, shown: Callable[[str], str]) -> str:
    """Replaces parameters in braces in a text by the names that ``shown`` gives them."""
    parts = text.split("{")
    rest = (part.partition("}") for part in parts[1:])
    return parts[0] + "".join(shown(name) + after for name, _, after in rest)


def _size(value: Any, where: str) -> tuple[float, float] | None:
    if isinstance(value, str):
        return units.sensor_mm(where, value)
    width, height = (float(v) for v in value)
    return (width, height) if 0 < width < math.inf and 0 < height < math.inf else None
