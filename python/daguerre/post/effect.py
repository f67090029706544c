"""Effects: by which name, with which parameters, and how one is put to work on a picture."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from daguerre.convolution.rows import Rows
from daguerre.errors import InputError, UsageError
from daguerre.parameters.table import Table

from .parameter import Parameter
from .picture import Band, Canvas, Source

Values = Mapping[str, Any]


class Step:
    """One effect with its parameters, made for one picture: the base of all.

    A step is a function of rows: what it makes of them must not depend on how a picture is cut.

    Attributes:
        reach: How many rows above and below it reads; see also :meth:`reads`.
        block: Rows that it makes at a time; None: as the engine likes; 0: all at once.
    """

    reach: int = 0
    block: int | None = None

    def reads(self, rows: Rows) -> Rows:
        """Which rows it needs to make these; may go beyond the picture."""
        return rows.grown(self.reach)

    def prepare(self, source: Source) -> None:
        """Before the first row is made: to look at the whole picture, band by band."""

    def apply(self, band: Band, rows: Rows) -> Band:
        """Makes ``rows`` from a band that has those that ``reads`` asked for."""
        raise NotImplementedError

    def remarks(self) -> list[str]:
        """Remarks for the user when the picture is done."""
        return []


@dataclass(frozen=True)
class Effect:
    """An entry of the list of effects.

    Attributes:
        name: On the command line and in recipes.
        summary: One line.
        parameters: With units and defaults.
        make: A step for a picture, from all values by name.
        needs: Channels besides colour: "depth", "motion".
        last: Whether it belongs behind all others, wherever it is named.
    """

    name: str
    summary: str
    parameters: tuple[Parameter, ...]
    make: Callable[[Canvas, Values], Step]
    needs: tuple[str, ...] = ()
    last: bool = False

    def values(self, given: Values, where: str, error: type[InputError | UsageError]) -> Values:
        """All parameters: those given, checked, and defaults for the others.

        Args:
            given: By name, as text or as values of JSON.
            where: For messages, such as ``--effect grain``.
            error: Type of error to raise.
        """
        return Table(*self.parameters).values(given, where, error)
