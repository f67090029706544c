"""Photometric files: IES LM-63-1986, -1991, -1995, -2002 and -2019, photometry of type C.

A file has lines of text up to ``TILT=``, and then numbers alone: lamps and multipliers, vertical
angles, horizontal angles, and the candelas for each horizontal angle. Source: ANSI/IES LM-63-19;
I. Ashdown 1999, "Parsing the IESNA LM-63 photometric data file".
"""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterator
from pathlib import Path
from typing import NoReturn

import numpy as np
from numpy.typing import NDArray

from daguerre.checks import short
from daguerre.errors import InputError
from daguerre.files.text_lines import text_of
from daguerre.scene.light_profile import MAX_VALUES, LightProfile
from daguerre.scene.photometric_circle import whole_circle

FloatArray = NDArray[np.float64]
#: Maximum size of a file.
MAX_BYTES = 16 << 20
_TYPES = {1: "C", 2: "B", 3: "A"}
#: First standard without a ballast-lamp photometric factor. The number in its place is reserved,
#: and from 2019 on it is the file generation type.
_NO_LAMP_FACTOR = 2002


def read(path: str | os.PathLike[str]) -> LightProfile:
    """Reads a photometric file as a profile of candelas.

    Raises:
        InputError: The file cannot be used; the message names file, line and place.
    """
    file = Path(path)
    # Numbers and keywords are ASCII; names of makers come in any encoding.
    lines = re.split(r"\r\n|\r|\n", text_of(file, "latin-1", MAX_BYTES).rstrip("\x1a\0"))
    tilt = next(
        (i for i, line in enumerate(lines) if line.lstrip().upper().startswith("TILT=")), None
    )
    if tilt is None:
        raise InputError(f"{file}: no line TILT=NONE, which IES LM-63 requires")
    numbers = _Numbers(file, lines, tilt + 1)
    factor = _tilt_factor(lines[tilt], numbers)
    return _luminaire(numbers, factor, _year(lines))


def _year(lines: list[str]) -> int:
    """Year of the standard by the first line; files of 1986 have none."""
    first = next((line for line in lines if line.strip()), "")
    found = re.match(r"\s*(?:IESNA|IES):?\s*(?:LM-63-)?(\d{2,4})", first.upper())
    if found is None:
        return 1986
    year = int(found[1])
    return year if year > 100 else year + (1900 if year > 50 else 2000)


def _tilt_factor(line: str, numbers: _Numbers) -> float:
    """Factor of the lamp as it was measured, at 0 degrees; angles of included factors follow."""
    value = line.split("=", 1)[1].strip()
    if value.upper() == "NONE":
        return 1.0
    if value.upper() != "INCLUDE":
        numbers.fail("TILT", "NONE or INCLUDE", f"the file {short(value)}")
    numbers.take("lamp to luminaire geometry")
    count = numbers.count("number of tilt angles")
    angles = numbers.rising("tilt angle", count)
    factors = numbers.many("tilt factor", count, least=0)
    return float(np.interp(0.0, angles, factors))


def _luminaire(numbers: _Numbers, tilt_factor: float, year: int) -> LightProfile:
    for name in ("number of lamps", "lumens per lamp"):
        numbers.take(name)
    multiplier = numbers.take("candela multiplier", least=0)
    rows = numbers.count("number of vertical angles")
    columns = numbers.count("number of horizontal angles")
    if rows * columns > MAX_VALUES:
        numbers.fail("numbers of angles", f"a product of at most {MAX_VALUES}", rows * columns)
    kind = numbers.take("photometric type")
    if kind != 1:
        name = _TYPES.get(int(kind), "") if kind == int(kind) else ""
        numbers.fail("photometric type", "1 (type C)", f"{kind:g}" + f" (type {name})" * bool(name))
    for name in ("units type", "width", "length", "height"):
        numbers.take(name)
    multiplier *= tilt_factor * numbers.take("ballast factor", least=0)
    lamp_factor = numbers.take("ballast-lamp photometric factor", least=0)
    multiplier *= lamp_factor if year < _NO_LAMP_FACTOR else 1.0
    numbers.take("input watts")
    theta = numbers.rising("vertical angle", rows, 180.0)
    phi = numbers.rising("horizontal angle", columns, 360.0)
    place = numbers.place
    candelas = np.stack([numbers.many("candelas", rows, least=0) for _ in range(columns)], axis=1)
    numbers.end()
    with np.errstate(over="ignore"):
        absolute = candelas * multiplier
    if not (absolute <= np.finfo(np.float32).max).all():
        numbers.fail("candelas", "finite numbers", "numbers that overflow with their multipliers")
    phi, values = whole_circle(phi, absolute, f"{place}: horizontal angles")
    return LightProfile.table(theta, values, phi if len(phi) > 1 else [0.0])


class _Numbers:
    """Numbers of a file in sequence, across the ends of lines."""

    def __init__(self, file: Path, lines: list[str], first: int) -> None:
        self._file = file
        self._line = first  # from 1
        self._words = self._all(lines, first)

    def _all(self, lines: list[str], first: int) -> Iterator[str]:
        for i in range(first, len(lines)):
            words = lines[i].replace(",", " ").split()
            self._line = i + 1 if words else self._line
            yield from words

    @property
    def place(self) -> str:
        """File and line of the last number."""
        return f"{self._file}: line {self._line}"

    def fail(self, what: str, wanted: str, got: object) -> NoReturn:
        """Raises an error at the last number."""
        raise InputError(f"{self.place}: {what}: wanted {wanted}, got {got}")

    def take(self, what: str, least: float = -math.inf, most: float = math.inf) -> float:
        """Next number, within bounds."""
        word = next(self._words, None)
        if word is None:
            self.fail(what, "a number", "the end of the file")
        try:
            number = float(word)
        except ValueError:
            number = math.nan
        if not math.isfinite(number) or "_" in word:
            self.fail(what, "a finite number", short(word))
        if number < least or number > most:
            bounds = f"at least {least:g}" if most == math.inf else f"{least:g} .. {most:g}"
            self.fail(what, bounds, f"{number:g}")
        return number

    def count(self, what: str) -> int:
        """Next number, an integer of at least 1."""
        number = self.take(what, 1, MAX_VALUES)
        if number != int(number):
            self.fail(what, "a whole number", f"{number:g}")
        return int(number)

    def many(self, what: str, count: int, least: float = -math.inf) -> FloatArray:
        """Next ``count`` numbers."""
        return np.array([self.take(what, least) for _ in range(count)])

    def rising(self, what: str, count: int, most: float = math.inf) -> FloatArray:
        """Next ``count`` numbers, increasing."""
        found: list[float] = []
        for _ in range(count):
            number = self.take(what, -math.inf if most == math.inf else 0.0, most)
            if found and number <= found[-1]:
                self.fail(what, f"more than {found[-1]:g}", f"{number:g}")
            found.append(number)
        return np.array(found)

    def end(self) -> None:
        """Checks that nothing is left."""
        if (word := next(self._words, None)) is not None:
            self.fail("end", "the end of the file", short(word))
