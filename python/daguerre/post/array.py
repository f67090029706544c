"""Effects on arrays: one band that is the whole picture."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import UsageError

from .effect import Effect, Values
from .picture import Band, Canvas, Image, Rows
from .tiles import WholeImage


def on_array(
    effect: Effect,
    image: Image,
    values: Values,
    planes: Mapping[str, NDArray[Any]] | None = None,
) -> Image:
    """An effect on a whole picture.

    Args:
        effect: Of the list.
        image: Scene-linear, shape (H, W, C); it is not changed.
        values: Parameters by name; those that are None count as not given.
        planes: What the effect needs besides colour, by usual channel names, shape (H, W).

    Raises:
        UsageError: A wrong shape, or a wrong parameter.
    """
    array = np.asarray(image)
    if array.ndim != 3 or array.dtype.kind not in "fiu" or 0 in array.shape:
        raise UsageError(
            f"{effect.name}: image: wanted numbers of shape (H, W, C), got {array.shape} "
            f"{array.dtype}"
        )
    given = {name: value for name, value in values.items() if value is not None}
    known = effect.values(given, effect.name, UsageError)
    canvas = Canvas.of(array.shape, tuple(planes or ()), effect.name)
    whole = Rows(0, canvas.height)
    band = Band(whole, np.ascontiguousarray(array, np.float32), planes or {})
    step = effect.make(canvas, known)
    step.prepare(WholeImage(canvas, band))
    return step.apply(band, whole).image
