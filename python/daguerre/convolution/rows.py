"""Ranges of rows of a picture that is worked through in blocks."""

from __future__ import annotations

from typing import NamedTuple


class Rows(NamedTuple):
    """Rows [begin, end) of the pixels that a picture has."""

    begin: int
    end: int

    def grown(self, by: int) -> Rows:
        """With so many more on either side; the engine cuts off what the picture does not have."""
        return Rows(self.begin - by, self.end + by)

    def within(self, height: int) -> Rows:
        """Cut to the rows of a picture; where nothing is left, its nearest row."""
        begin = min(max(self.begin, 0), height - 1)
        return Rows(begin, min(max(self.end, begin + 1), height))
