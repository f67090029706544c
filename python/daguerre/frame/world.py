"""Positions in the world, which are doubles far from 0, and relative to an origin in files.

Files have 32-bit numbers, 0.5 m apart at 5,000,000 m. So their positions are relative to the
``world_origin`` of the metadata, m, which is absent near 0.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .aovs import BY_NAME

Planes = dict[str, NDArray[Any]]
_POSITION = BY_NAME["P"].channels
_DEPTH = BY_NAME["depth"].channels[0]


def in_world(planes: Mapping[str, NDArray[Any]], origin: Sequence[float] | None) -> Planes:
    """Converts the positions among channels to the world.

    Args:
        planes: Channels (H, W) by name; pixels without a surface have depth 0.
        origin: Origin of the positions, m; None: 0.
    """
    return _shifted(planes, origin, 1)


def relative(planes: Mapping[str, NDArray[Any]], origin: Sequence[float] | None) -> Planes:
    """Converts the positions among channels to 32-bit numbers relative to an origin, m."""
    return _shifted(planes, origin, -1)


def _shifted(
    planes: Mapping[str, NDArray[Any]], origin: Sequence[float] | None, sign: int
) -> Planes:
    found = dict(planes)
    if origin is None or not any(origin) or not found.keys() >= {*_POSITION}:
        return found
    met = np.any([found[name] != 0 for name in _POSITION], axis=0)
    if _DEPTH in found:
        met = found[_DEPTH] != 0
    for name, value in zip(_POSITION, origin, strict=True):
        moved = found[name].astype(np.float64) + sign * np.where(met, value, 0.0)
        found[name] = moved if sign > 0 else moved.astype(np.float32)
    return found
