"""Flags from tables of parameters: a row is a flag of every command that uses its table."""

from collections.abc import Callable
from dataclasses import make_dataclass
from pathlib import Path
from typing import Annotated, Any, ClassVar, TypeVar

from daguerre.parameters.parameter import Parameter
from daguerre.parameters.table import Table

from .groups import option

_TYPES: dict[str, Any] = {"number": float, "whole": int, "flag": bool, "output": Path}
_TYPES |= {"picture": Path}


class TableFlags:
    """Flags of a table; flags not given are None."""

    table: ClassVar[Table]

    def given(self) -> dict[str, Any]:
        """Values of given flags by the names of their parameters, parsed from text."""
        values = {row: getattr(self, row.field) for row in self.table.flagged}
        return {row.name: _read(row, value) for row, value in values.items() if _is_given(value)}


Flags = TypeVar("Flags", bound=TableFlags)


def made_of(
    table: Table, names: Table | None = None, panel: str | None = None
) -> Callable[[type[Flags]], type[Flags]]:
    """Makes a data class of flags: the decorated class with a field for each row with a flag.

    Args:
        table: Rows of the flags, in the order of help.
        names: Table of the parameters that help texts refer to; None: the same.
        panel: Section of help that shows the flags; None: each row's section.
    """

    def make(base: type[Flags]) -> type[Flags]:
        made = make_dataclass(
            base.__name__,
            [(row.field, field_type(row, names or table, panel), None) for row in table.flagged],
            bases=(base,),
            namespace={"table": table, "__doc__": base.__doc__, "__module__": base.__module__},
            frozen=True,
            eq=False,  # nobody compares or prints flags, and long classes take long to make
            repr=False,
        )
        return made

    return make


def field_type(row: Parameter, names: Table, panel: str | None) -> Any:
    """Type of a flag for Typer, with its names and its help."""
    kind = list[str] if row.repeated else str if row.parser else _TYPES.get(row.kind, str)
    shown = option(
        *row.flags, metavar=row.placeholder, help=row.help(names.flag), panel=panel or row.panel
    )
    return Annotated[kind | None, shown]


def _is_given(value: object) -> bool:
    return value is not None and value != []


def _read(row: Parameter, value: Any) -> Any:
    if row.kind == "picture":
        from daguerre.pictures.iris import read_grey

        return read_grey(value)
    return tuple(map(row.from_text, value)) if row.repeated else row.from_text(value)
