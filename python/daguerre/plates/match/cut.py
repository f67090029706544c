"""Cuts a mosaic into blocks, depending on its pattern."""

from __future__ import annotations

from daguerre.plates.photograph import RawNumbers

from .blocks import Blocks
from .planes import blocks_of_planes
from .squares import blocks_of_squares

#: Largest number of blocks in one picture; more add no information.
MOST = 400_000


def blocks_of(raw: RawNumbers, share: float = 1.0) -> Blocks:
    """Cuts blocks from a whole mosaic, without blocks that have clipped photosites.

    Args:
        raw: Mosaic.
        share: Share of ``MOST`` to cut at most.
    """
    if max(raw.cells.shape) > 2:
        return blocks_of_squares(raw, int(MOST * share))
    return blocks_of_planes(raw, int(MOST * share))
