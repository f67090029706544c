"""Text of pbrt's scene format: directives, and parameters with their types."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import numpy as np

from daguerre.compiled import __version__

Parameter = str


class Text:
    """Collects directives, indented by blocks."""

    def __init__(self) -> None:
        self._lines = [f"# Daguerre {__version__}; m, +y up, right-handed; radiance 1 is 1 cd/m2"]
        self._depth = 0

    def line(self, text: str) -> None:
        """Adds a line as it is."""
        self._lines.append("    " * self._depth + text)

    def directive(self, name: str, kind: str, *parameters: Parameter) -> None:
        """Adds a directive: its name, a kind or a name in quotes, and parameters."""
        self.line(" ".join([name, f'"{kind}"', *parameters]))

    def transform(self, matrix: object) -> None:
        """Sets the current transform, a 4x4 matrix that acts on columns; pbrt wants its columns."""
        columns = np.asarray(matrix, np.float64).T.reshape(-1).tolist()
        self.line(f"Transform [ {numbers(columns)} ]")

    @contextmanager
    def block(self, name: str, kind: str = "") -> Iterator[None]:
        """Adds ``AttributeBegin`` and ``AttributeEnd``, or another pair, around the lines in it."""
        self.line(f'{name}Begin "{kind}"' if kind else f"{name}Begin")
        self._depth += 1
        yield
        self._depth -= 1
        self.line(f"{name}End")

    def __str__(self) -> str:
        return "\n".join(self._lines) + "\n"


def floats(name: str, *values: float) -> Parameter:
    """Makes a parameter of numbers."""
    return f'"float {name}" [ {numbers(values)} ]'


def integer(name: str, value: int) -> Parameter:
    """Makes a parameter of a whole number."""
    return f'"integer {name}" [ {value} ]'


def flag(name: str, value: bool) -> Parameter:
    """Makes a boolean parameter."""
    return f'"bool {name}" [ {"true" if value else "false"} ]'


def rgb(name: str, color: Sequence[float]) -> Parameter:
    """Makes a parameter of a linear Rec.709 colour."""
    return f'"rgb {name}" [ {numbers(color)} ]'


def point(name: str, values: Sequence[float]) -> Parameter:
    """Makes a parameter of a point."""
    return f'"point3 {name}" [ {numbers(values)} ]'


def string(name: str, *values: str) -> Parameter:
    """Makes a parameter of texts, which contain no quotes."""
    return f'"string {name}" [ {" ".join(f"{chr(34)}{value}{chr(34)}" for value in values)} ]'


def spectrum(name: str, pairs: Sequence[tuple[float, float]]) -> Parameter:
    """Makes a parameter of values at wavelengths, nm."""
    return f'"spectrum {name}" [ {numbers([v for pair in pairs for v in pair])} ]'


def texture(name: str, value: str) -> Parameter:
    """Makes a parameter of a texture by its name."""
    return f'"texture {name}" [ "{value}" ]'


def numbers(values: Sequence[float]) -> str:
    """Joins numbers, each with all of its digits; integers without a point."""
    return " ".join(
        str(int(v)) if v == int(v) and abs(v) < 1e15 else repr(float(v)) for v in values
    )
