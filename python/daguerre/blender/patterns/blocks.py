"""Evaluates patterns block by block, so that what they need stays in the processor's cache."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

#: Points that are evaluated at once.
_BLOCK = 1 << 15


def in_blocks(
    function: Callable[..., Sequence[Any]], axes: int, count: int
) -> Callable[..., list[NDArray[np.float32]]]:
    """Makes a function of single precision, on flat arrays, one of numbers and arrays.

    Args:
        function: Takes ``axes`` coordinates, arrays (N,), and parameters, each a number or (N,).
        axes: Number of coordinates.
        count: Number of results.
    """

    def apply(*values: ArrayLike) -> list[NDArray[np.float32]]:
        given = [np.asarray(value, np.float32) for value in values]
        shape = np.broadcast_shapes(*(one.shape for one in given))
        total = int(np.prod(shape, dtype=np.int64))
        flat = [one.reshape(-1) if one.shape == shape else one for one in given]
        results = [np.empty(total, np.float32) for _ in range(count)]
        for start in range(0, total, _BLOCK):
            part = slice(start, min(start + _BLOCK, total))
            arguments = [one[part] if one.ndim else one[()] for one in flat]
            for i in range(axes):
                arguments[i] = np.array(np.broadcast_to(arguments[i], part.stop - start))
            with np.errstate(all="ignore"):
                found = function(*arguments)
            for result, one in zip(results, found, strict=True):
                result[part] = one
        return [result.reshape(shape) for result in results]

    return apply
