"""Flags that set a lens on the bench."""

from daguerre.lenses.setting import By

from .from_table import TableFlags

#: Part of a help that shows what is done with the lens.
BENCH = "On the bench"


class BenchFlags(TableFlags):
    """How a lens is set; without flags wide open and focused at infinity."""

    focus_by: By | None

    def check(self) -> None:
        """Refuses ways to focus that there are not."""
        self.table["focus_by"].check(self.focus_by, "--focus-by")
