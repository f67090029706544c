"""Ranges of rows, for pictures that are computed in blocks."""

from __future__ import annotations

from typing import NamedTuple


class Rows(NamedTuple):
    """Rows [begin, end) of a picture."""

    begin: int
    end: int

    def grown(self, by: int) -> Rows:
        """Extends the range by rows on each side, even beyond the picture; see ``within``."""
        return Rows(self.begin - by, self.end + by)

    def within(self, height: int) -> Rows:
        """Cuts the range to a picture of this height; at least its nearest row stays."""
        begin = min(max(self.begin, 0), height - 1)
        return Rows(begin, min(max(self.end, begin + 1), height))
