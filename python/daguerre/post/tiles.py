"""Runs a chain of effects over a picture, a band of rows at a time, to save memory.

Rows are pulled: the writer requests a band from the last effect, which requests the rows that it
reads from the previous effect, and so on down to the file. Each effect keeps the blocks of its last
request, so that rows common to two bands are computed once. Blocks begin at fixed rows, so that no
bit of the result depends on the requests.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from daguerre.convolution.rows import Rows

from .effect import Step
from .picture import Band, Canvas, RowSource

BLOCK = 256  # rows


class Stage:
    """A step and its source, which together are a source again."""

    def __init__(self, step: Step, source: RowSource) -> None:
        self.step, self.source = step, source
        height = source.canvas.height
        block = BLOCK if step.block is None else step.block
        self._block = min(block, height) or height
        self._kept: dict[int, Band] = {}

    @property
    def canvas(self) -> Canvas:
        """Facts about the picture, from the source."""
        return self.source.canvas

    def rows(self, rows: Rows) -> Band:
        """Computes the blocks that contain these rows, except blocks that are still kept."""
        wanted = range(rows.begin // self._block, (rows.end - 1) // self._block + 1)
        self._kept = {k: band for k, band in self._kept.items() if k in wanted}
        for k in wanted:
            if k not in self._kept:
                self._kept[k] = self._made(k)
        return joined([self._kept[k] for k in wanted], rows)

    def _made(self, k: int) -> Band:
        height = self.canvas.height
        rows = Rows(k * self._block, min((k + 1) * self._block, height))
        band = self.step.apply(self.source.rows(self.step.reads(rows).within(height)), rows)
        shape = (rows.end - rows.begin, self.canvas.width, len(self.canvas.colors))
        if band.rows != rows or band.image.shape != shape:
            raise AssertionError(f"{self.step}: {rows}, {shape}; made {band.rows}")
        return band


class WholeImage:
    """A picture in memory, as a source."""

    def __init__(self, canvas: Canvas, band: Band) -> None:
        self.canvas, self._band = canvas, band

    def rows(self, rows: Rows) -> Band:
        """Returns a view of these rows."""
        return self._band.cut(rows)


def chained(steps: Sequence[Step], source: RowSource) -> RowSource:
    """Chains steps on a source; each step is prepared with the picture before it."""
    for step in steps:
        step.prepare(source)
        source = Stage(step, source)
    return source


def joined(parts: Sequence[Band], rows: Rows) -> Band:
    """Joins bands vertically and cuts them to some rows."""
    cut = [p.cut(Rows(max(p.rows.begin, rows.begin), min(p.rows.end, rows.end))) for p in parts]
    if len(cut) == 1:
        return cut[0]
    planes = {name: np.concatenate([p.planes[name] for p in cut]) for name in cut[0].planes}
    return Band(rows, np.concatenate([p.image for p in cut]), planes)
