"""Tables of parameters: look-up, values with defaults, rivals."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from typing import Any

from daguerre.checks import short
from daguerre.errors import InputError, UsageError, suggest

from .parameter import Parameter


class Table:
    """Table of parameters, in the order of help and pages."""

    def __init__(self, *rows: Parameter | Iterable[Parameter]) -> None:
        self.rows: tuple[Parameter, ...] = tuple(
            row for part in rows for row in ([part] if isinstance(part, Parameter) else part)
        )
        self._rows = {row.name: row for row in self.rows}
        if len(self._rows) != len(self.rows):
            raise ValueError("a table has two parameters of one name")

    def __iter__(self) -> Iterator[Parameter]:
        return iter(self.rows)

    def __len__(self) -> int:
        return len(self.rows)

    def __contains__(self, name: object) -> bool:
        return name in self._rows

    def __getitem__(self, name: str) -> Parameter:
        """Returns the parameter of this name, which must be in the table."""
        return self._rows[name]

    def find(self, name: str, where: str, error: type[InputError | UsageError]) -> Parameter:
        """Returns the parameter of a name that a user typed.

        Raises:
            InputError or UsageError: Unknown name; the message suggests the nearest.
        """
        if name not in self._rows:
            listed = ", ".join(self._rows) or "nothing"
            near = suggest(name, self._rows)
            raise error(f"{where}: parameter {short(name)}: wanted one of {listed}{near}")
        return self._rows[name]

    @property
    def flagged(self) -> tuple[Parameter, ...]:
        """Parameters with a flag."""
        return tuple(row for row in self.rows if row.flags)

    def values(
        self, given: Mapping[str, Any], where: str, error: type[InputError | UsageError]
    ) -> dict[str, Any]:
        """Values of all parameters by name: the given values, parsed and checked, and defaults.

        Args:
            given: Values by name, as text or JSON values.
            where: Start of messages, such as ``--effect grain``.
            error: Type of error to raise.
        """
        for name in given:
            self.find(name, where, error)
        values = {}
        for name, row in self._rows.items():
            if name in given:
                values[name] = row.read(given[name], f"{where}: {name}", error)
            elif row.required:
                raise error(f"{where}: {name}: wanted {row.wanted}, got no value")
            else:
                values[name] = row.default
        return values

    def filled(self, given: Mapping[str, Any], function: str, where: str = "") -> dict[str, Any]:
        """Values of all parameters by name: given Python values, checked, and defaults.

        Args:
            given: Keywords of a function.
            function: Name of the function.
            where: Owner of the parameters, for messages; default: the function.

        Raises:
            TypeError: No such parameter.
            UsageError: A value is not accepted.
        """
        for name in given:
            if name not in self:
                raise TypeError(f"{function}() got an unexpected keyword argument {name!r}")
        values = self.defaults() | dict(given)
        for row in self.rows:
            if values[row.name] is not None or row.default is not None:
                row.check_given(values[row.name], f"{where or function}: {row.name}")
        return values

    def default(self, name: str) -> Any:
        """Default of a parameter; None: none."""
        return self[name].default

    def defaults(self) -> dict[str, Any]:
        """Defaults by name; None: none."""
        return {row.name: row.default for row in self.rows}

    def rivals(self) -> tuple[tuple[str, ...], ...]:
        """Groups of names of which at most one may be given."""
        groups: dict[str, list[str]] = {}
        for row in self.rows:
            if row.rivals:
                groups.setdefault(row.rivals, []).append(row.name)
        return tuple(tuple(names) for names in groups.values())

    def refuse_rivals(self, given: Collection[str], where: str = "") -> None:
        """Checks that given parameters do not exclude each other.

        Args:
            given: Names of the given parameters.
            where: Owner of the parameters, such as ``camera``; empty: messages name their flags.

        Raises:
            UsageError: Two parameters exclude each other; the message names them.
        """
        for names in self.rivals():
            both = [name for name in names if name in given]
            if len(both) > 1 and where:
                raise UsageError(f"{where}: wanted either {both[0]} or {both[1]}, got both")
            if len(both) > 1:
                flags = " and ".join(self[name].flag for name in both)
                got = "both" if len(both) == 2 else len(both)
                raise UsageError(f"{flags}: wanted one of them, got {got}")

    def check(self, values: object, where: str) -> None:
        """Checks the values of all parameters.

        Args:
            values: Object with an attribute for each parameter.
            where: Owner of the parameters, for messages.
        """
        for row in self.rows:
            row.check(getattr(values, row.name), f"{where}: {row.name}")

    def flag(self, name: str) -> str:
        """Flag of a parameter; for a name that is not in the table, the flag made from it."""
        return self[name].flag if name in self else "--" + name.replace("_", "-")
