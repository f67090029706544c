"""Evaluates the expressions by which layers name files, after a check of their length.

Source: OpenUSD, "Variable Expressions" (openusd.org, user guides).
"""

from __future__ import annotations

import re
from typing import Any

from pxr import Sdf

from daguerre.checks import short
from daguerre.errors import InputError

#: Most characters of an expression, with all variables in it; and of variables in variables.
_MOST, _DEEPEST = 65_536, 64
_USE = re.compile(r"\$\{([^}]*)\}")


class Variables:
    """Values that expressions of a layer stack may use.

    Args:
        file: File, for messages.
        values: Values by name.
    """

    def __init__(self, file: str, values: dict[str, Any]) -> None:
        self._file = file
        self._values = values
        self._sizes: dict[str, int] = {}
        self._open: list[str] = []
        #: Equal for equal values.
        self.key = repr(sorted(values.items())) if values else ""

    def below(self, layer: Sdf.Layer) -> Variables:
        """Values in a layer that a layer with these values refers to; these are stronger."""
        if not layer.HasExpressionVariables():
            return self
        return Variables(self._file, {**layer.expressionVariables, **self._values})

    def evaluated(self, name: str) -> str | None:
        """Name of a file; None: its expression has no value, so that USD opens nothing.

        Raises:
            InputError: The expression is too long or too deep.
        """
        if not Sdf.VariableExpression.IsExpression(name):
            return name
        if self._size(name) > _MOST:
            raise self._fault(name, f"at most {_MOST} characters")
        found = Sdf.VariableExpression(name).Evaluate(self._values)
        return found.value if isinstance(found.value, str) and not found.errors else None

    def _size(self, text: str) -> int:
        """Most characters that an expression grows to."""
        if len(text) > _MOST or max(text.count(bracket) for bracket in "([") > _DEEPEST:
            raise self._fault(text, f"at most {_MOST} characters and {_DEEPEST} brackets")
        return min(len(text) + sum(map(self._size_of, _USE.findall(text))), _MOST + 1)

    def _size_of(self, name: str) -> int:
        value = self._values.get(name)
        if not isinstance(value, str) or not Sdf.VariableExpression.IsExpression(value):
            return len(str(value))
        if name not in self._sizes:
            if name in self._open or len(self._open) >= _DEEPEST:
                raise self._fault(value, f"at most {_DEEPEST} variables inside of one another")
            self._open.append(name)
            self._sizes[name] = self._size(value)
            self._open.pop()
        return self._sizes[name]

    def _fault(self, text: str, wanted: str) -> InputError:
        return InputError(f"{self._file}: expression: wanted {wanted}, got {short(text, 80)}")
