"""A mosaic cut into blocks, in the way that its pattern allows."""

from __future__ import annotations

from daguerre.plates.photograph import RawNumbers

from .blocks import Blocks
from .planes import blocks_of_planes
from .squares import blocks_of_squares

#: Blocks that are looked at in one picture; more tell nothing new.
MOST = 400_000


def blocks_of(raw: RawNumbers, share: float = 1.0) -> Blocks:
    """Blocks all over a mosaic; those with a photosite at either end of the numbers are left out.

    Args:
        raw: The mosaic.
        share: Share of ``MOST`` that may come of it.
    """
    if max(raw.cells.shape) > 2:
        return blocks_of_squares(raw, int(MOST * share))
    return blocks_of_planes(raw, int(MOST * share))
