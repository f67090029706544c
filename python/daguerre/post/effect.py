"""Effects: names, parameters, and the steps that apply them to a picture."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from daguerre.convolution.rows import Rows
from daguerre.errors import InputError, UsageError
from daguerre.parameters.table import Table

from .parameter import Parameter
from .picture import Band, Canvas, RowSource

Values = Mapping[str, Any]


class Step:
    """Base class of steps: one effect with its parameters, prepared for one picture.

    A step computes rows. Its result must not depend on how the picture is cut into bands.

    Attributes:
        reach: Number of rows above and below that it reads; see also :meth:`reads`.
        block: Number of rows that it computes at a time; None: any; 0: all at once.
    """

    reach: int = 0
    block: int | None = None

    def reads(self, rows: Rows) -> Rows:
        """Returns the source rows needed for these rows; they may lie beyond the picture."""
        return rows.grown(self.reach)

    def prepare(self, source: RowSource) -> None:
        """Reads the whole picture, band by band, before the first row is computed, if needed."""

    def apply(self, band: Band, rows: Rows) -> Band:
        """Computes ``rows`` from a band with the rows that ``reads`` returned."""
        raise NotImplementedError

    def remarks(self) -> list[str]:
        """Returns notes for the user after the picture is done."""
        return []


@dataclass(frozen=True)
class Effect:
    """An entry of the catalogue of effects.

    Attributes:
        name: Name on the command line and in recipes.
        summary: Help text of one line.
        parameters: Parameters with units and defaults.
        make: Function that makes the step for a picture from all values by name.
        needs: Further channels that it needs: "depth", "motion".
        last: Whether it is applied after all others, wherever the user names it.
    """

    name: str
    summary: str
    parameters: tuple[Parameter, ...]
    make: Callable[[Canvas, Values], Step]
    needs: tuple[str, ...] = ()
    last: bool = False

    def values(self, given: Values, where: str, error: type[InputError | UsageError]) -> Values:
        """Checks the given parameters and adds defaults for the others.

        Args:
            given: Values by name, as text or as JSON values.
            where: Place for messages, such as ``--effect grain``.
            error: Type of error to raise.
        """
        return Table(*self.parameters).values(given, where, error)
