"""Applies effects to whole pictures in memory."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.checks import to_numbers
from daguerre.convolution.rows import Rows
from daguerre.errors import UsageError

from .effect import Effect, Step, Values
from .picture import Band, Canvas, Image
from .tiles import WholeImage


def on_array(
    effect: Effect,
    image: Image,
    values: Values,
    planes: Mapping[str, NDArray[Any]] | None = None,
) -> Image:
    """Applies an effect to a whole picture.

    Args:
        effect: Effect of the catalogue.
        image: Scene-linear picture, shape (H, W, C); it is not changed.
        values: Parameters by name; None: the default.
        planes: Further planes that the effect needs, by usual channel names, shape (H, W).

    Raises:
        UsageError: A shape or a parameter is wrong.
    """
    given = {name: value for name, value in values.items() if value is not None}
    known = effect.values(given, effect.name, UsageError)
    return step_on_array(effect.name, image, lambda canvas: effect.make(canvas, known), planes)


def step_on_array(
    name: str,
    image: Image,
    make: Callable[[Canvas], Step],
    planes: Mapping[str, NDArray[Any]] | None = None,
) -> Image:
    """Applies a step to a whole picture; ``name`` is for messages."""
    array = to_numbers(image, name, "image", "numbers of shape (H, W, C)", UsageError)
    if array.ndim != 3 or array.dtype.kind not in "fiu" or 0 in array.shape:
        raise UsageError(
            f"{name}: image: wanted numbers of shape (H, W, C), got {array.dtype} of {array.shape}"
        )
    planes = {key: np.asarray(plane) for key, plane in (planes or {}).items()}
    for channel, plane in planes.items():
        if plane.shape != array.shape[:2] or plane.dtype.kind not in "fiu":
            raise UsageError(
                f"{name}: {channel}: wanted numbers of shape {array.shape[:2]}, "
                f"got {plane.dtype} of {plane.shape}"
            )
    canvas = Canvas.of(array.shape, tuple(planes or ()), name)
    whole = Rows(0, canvas.height)
    band = Band(whole, np.ascontiguousarray(array, np.float32), planes or {})
    step = make(canvas)
    step.prepare(WholeImage(canvas, band))
    return step.apply(band, whole).image
