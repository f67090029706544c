"""Compares scenes to the bit: all attributes, motion, and some other moments."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

import daguerre as dg
from daguerre.files.value import same

#: Offsets of the other moments, s.
_LATER = (0.013, 0.5, 1.7)
#: Most moving parts of a scene that are compared at other moments.
_MANY = 2000


def differences(one: dg.Scene, other: dg.Scene) -> list[str]:
    """Names of attributes that differ between two scenes."""
    found = [name for name, part in vars(one).items() if not exact(part, getattr(other, name))]
    found += [
        name for name in ("nodes", "cameras", "node_positions") if not _ordered(one, other, name)
    ]
    if len(list(one.motion.parts())) <= _MANY:
        found += [f"at {later:g} s" for later in _LATER if not _moved(one, other, later)]
    return found


def exact(one: Any, other: Any) -> bool:
    """Whether two values are equal, and their arrays equal to the bit."""
    if isinstance(one, np.ndarray) and isinstance(other, np.ndarray):
        same_form = (one.dtype, one.shape) == (other.dtype, other.shape)
        return same_form and one.tobytes() == other.tobytes()
    return same(one, other)


def _ordered(one: dg.Scene, other: dg.Scene, name: str) -> bool:
    return list(getattr(one, name)) == list(getattr(other, name))


def _moved(one: dg.Scene, other: dg.Scene, later: float) -> bool:
    """Whether both scenes, or the errors in their place, are the same at another moment."""
    return same(*(_at(scene, scene.time + later) for scene in (one, other)))


def _at(scene: dg.Scene, time: float) -> Any:
    with np.errstate(all="ignore"):
        try:
            return scene.at(time) if math.isfinite(time) else None
        except ValueError as error:
            return repr(error)
