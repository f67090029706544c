"""Flags that set a lens on the bench."""

from daguerre.lenses.setting import By

from .from_table import TableFlags

#: Section of help with the flags of the bench.
BENCH = "On the bench"


class BenchFlags(TableFlags):
    """Setting of a lens; without flags, wide open and focused at infinity."""

    focus_by: By | None

    def check(self) -> None:
        """Checks the focus criterion."""
        self.table["focus_by"].check(self.focus_by, "--focus-by")
