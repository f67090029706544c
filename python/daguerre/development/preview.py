"""Makes the small preview of a DNG."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .channels import of_cells

if TYPE_CHECKING:
    from daguerre.frame.raw import Raw

LONGEST = 512


def preview_of(raw: Raw) -> NDArray[np.uint8]:
    """Makes a developed picture of at most 512 px, shape (h, w, 3); not for Quad-Bayer.

    It samples only some cells of the pattern, which is fast but rough.
    """
    from .recipe import develop

    return develop(of_cells(raw, cell_means(raw, LONGEST))).bytes8()


def cell_means(raw: Raw, longest: int) -> NDArray[np.float32]:
    """Means of DN above black of each channel in cells of the pattern, shape (h, w, C)."""
    cells = raw.sensor.pattern.cells
    rows, columns = cells.shape
    step = max(rows, columns) * -(-max(raw.mosaic.shape) // (max(rows, columns) * longest))
    height, width = (max((side - max(rows, columns)) // step + 1, 1) for side in raw.mosaic.shape)
    sums = np.zeros((height, width, len(raw.sensor.channels)), np.float32)
    counts = np.bincount(cells.ravel(), minlength=sums.shape[2])
    for (y, x), channel in np.ndenumerate(cells):
        part = raw.mosaic[y::step, x::step][:height, :width]
        sums[: part.shape[0], : part.shape[1], channel] += part
    return np.asarray(sums / counts - raw.black_level, np.float32)
