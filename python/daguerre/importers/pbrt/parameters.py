"""Parameters of a directive: ``"float fov" [ 45 ]``, read by name, type and range.

Unused parameters are reported in a note, so that no parameter is dropped silently.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from daguerre.files.json_item import MAX_NUMBER, short

from .lexer import Lexer, Values
from .place import FilePlace

FloatArray = NDArray[np.float64]
#: Names of types in pbrt-v3 and before: their names in pbrt-v4.
_OLD_TYPES = {"color": "rgb", "point": "point3", "vector": "vector3", "normal3": "normal"}
#: Numbers of each value of a type.
_SIZES = {"point2": 2, "vector2": 2, "point3": 3, "vector3": 3, "normal": 3, "rgb": 3, "xyz": 3}
SPECTRA = ("rgb", "xyz", "blackbody", "spectrum")
_TEXTS = ("string", "texture")
TYPES = ("float", "integer", "bool", *_TEXTS, *_SIZES, "blackbody", "spectrum")


@dataclass(frozen=True, eq=False)
class Parameter:
    """A parameter.

    Attributes:
        type: Type, with its name in pbrt-v4.
        name: Name.
        values: Numbers, shape (N,); strings; or flags.
        place: Place of its declaration.
        color_space: Color space of its colors.
    """

    type: str
    name: str
    values: Values
    place: FilePlace
    color_space: str = "srgb"

    @property
    def numbers(self) -> FloatArray:
        """Its values, which must be numbers."""
        if not isinstance(self.values, np.ndarray):
            self.fail(f"wanted numbers, got {self._got()}")
        return self.values

    @property
    def texts(self) -> list[str]:
        """Its values, which must be strings."""
        if isinstance(self.values, np.ndarray) or not all(isinstance(v, str) for v in self.values):
            self.fail(f"wanted strings, got {self._got()}")
        return [str(value) for value in self.values]

    def _got(self) -> str:
        values = self.values.tolist() if isinstance(self.values, np.ndarray) else self.values
        return short(values[0], 40) if len(values) == 1 else f"{len(values)} values"

    def fail(self, message: str) -> NoReturn:
        """Raises ``InputError`` for this parameter."""
        self.place.fail(f"{short(self.name, 40)[1:-1]}: {message}")


class Parameters:
    """Parameters of a directive.

    Args:
        given: Parameters of the directive itself.
        inherited: Parameters of ``Attribute``, which are defaults for ``given``; they may be
            unused.
    """

    def __init__(
        self, given: Iterable[Parameter] = (), inherited: Iterable[Parameter] = ()
    ) -> None:
        self.given = tuple(given)
        self._named: dict[str, Parameter] = {}
        for parameter in (*self.given, *inherited):
            self._named.setdefault(parameter.name, parameter)
        self._asked: set[str] = set()

    def inheriting(self, inherited: Sequence[Parameter], color_space: str) -> Parameters:
        """Adds parameters of ``Attribute``; sets the color space of the directive's parameters."""
        given = self.given
        if color_space != "srgb":
            given = tuple(
                Parameter(p.type, p.name, p.values, p.place, color_space) for p in self.given
            )
        return Parameters(given, inherited)

    def unread(self) -> list[Parameter]:
        """Own parameters that nothing asked for."""
        return [p for p in self.given if p.name not in self._asked or self._named[p.name] is not p]

    def find(self, name: str, *types: str) -> Parameter | None:
        """Returns the parameter of a name; None: not given.

        Raises:
            InputError: The parameter has a type other than ``types``.
        """
        self._asked.add(name)
        found = self._named.get(name)
        if found is None:
            return None
        if types and found.type not in types:
            found.fail(f"wanted type {' or '.join(types)}, got {short(found.type, 40)}")
        return found

    def has(self, name: str) -> bool:
        """Whether a parameter is given; it does not count as read."""
        return name in self._named

    def number(
        self, name: str, default: float, low: float = -math.inf, high: float = math.inf
    ) -> float:
        """Reads one number within limits.

        Raises:
            InputError: The number is outside of the limits, or there is not one number.
        """
        found = self.find(name, "float", "integer")
        if found is None:
            return default
        value = _one(found, found.numbers)
        _check(found, np.array([value]), low, high)
        return float(value)

    def integer(self, name: str, default: int, low: int, high: int) -> int:
        """Reads one whole number within limits."""
        value = self.number(name, default, low, high)
        if value != int(value):
            self._named[name].fail(f"wanted a whole number, got {value:g}")
        return int(value)

    def flag(self, name: str, default: bool) -> bool:
        """Reads true or false, which pbrt-v3 has in quotes."""
        found = self.find(name, "bool")
        if found is None:
            return default
        values = found.values.tolist() if isinstance(found.values, np.ndarray) else found.values
        value: object = _one(found, values)
        if value in ("true", "false"):
            return value == "true"
        if not isinstance(value, bool):
            found.fail(f"wanted true or false, got {short(value, 40)}")
        return value

    def text(self, name: str, default: str = "") -> str:
        """Reads one string."""
        found = self.find(name, *_TEXTS)
        return default if found is None else str(_one(found, found.texts))

    def texts(self, name: str) -> list[str]:
        """Reads strings; none: the parameter is not given."""
        found = self.find(name, *_TEXTS)
        return [] if found is None else found.texts

    def numbers(self, name: str, count: int | None = None) -> FloatArray | None:
        """Reads numbers, shape (N,); None: not given."""
        found = self.find(name, "float", "integer")
        if found is None:
            return None
        if count is not None and len(found.numbers) != count:
            found.fail(f"wanted {count} numbers, got {len(found.numbers)}")
        return _check(found, found.numbers)

    def integers(self, name: str, low: int, high: int) -> NDArray[np.int64] | None:
        """Reads whole numbers within limits, shape (N,); None: not given."""
        found = self.find(name, "integer")
        if found is None:
            return None
        values = _check(found, found.numbers, low, high)
        whole = values.astype(np.int64)
        if not (whole == values).all():
            odd = values[whole != values][0]
            found.fail(f"wanted whole numbers, got {odd:g}")
        return whole

    def points(self, name: str, *types: str) -> FloatArray | None:
        """Reads points or vectors, shape (N, 2) or (N, 3); None: not given."""
        found = self.find(name, *types)
        if found is None:
            return None
        size = _SIZES.get(found.type, _SIZES[types[0]])
        values = _check(found, found.numbers)
        if len(values) % size:
            found.fail(f"wanted a multiple of {size} numbers, got {len(values)}")
        return values.reshape(-1, size)

    def point(self, name: str, default: tuple[float, float, float]) -> FloatArray:
        """Reads one point or vector, shape (3,)."""
        found = self.points(name, "point3", "vector3", "normal")
        if found is None:
            return np.array(default, np.float64)
        if len(found) != 1:
            self._named[name].fail(f"wanted 3 numbers, got {3 * len(found)}")
        return np.asarray(found[0])


def read_parameters(lexer: Lexer, place: FilePlace) -> Parameters:
    """Reads the parameters of a directive.

    Raises:
        InputError: A declaration or a value is wrong.
    """
    found = []
    while lexer.peek() == b'"':
        declared = lexer.string(place, "a declaration")
        at = lexer.place(place.directive)
        words = declared.split()
        if len(words) != 2:
            at.fail(f"wanted a type and a name, such as 'float fov', got {short(declared, 40)}")
        kind = _OLD_TYPES.get(words[0], words[0])
        if kind not in TYPES:
            at.fail(f"wanted a type ({', '.join(TYPES)}), got {short(words[0], 40)}")
        found.append(Parameter(kind, words[1], lexer.values(at), at))
    return Parameters(found)


def _one(parameter: Parameter, values: Any) -> Any:
    if len(values) != 1:
        parameter.fail(f"wanted one value, got {len(values)}")
    return values[0]


def _check(
    parameter: Parameter, values: FloatArray, low: float = -math.inf, high: float = math.inf
) -> FloatArray:
    low, high = max(low, -MAX_NUMBER), min(high, MAX_NUMBER)
    bad = ~((values >= low) & (values <= high))
    if bad.any():
        parameter.fail(f"wanted {low:g} .. {high:g}, got {values[bad][0]:g}")
    return values
