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


def differences_within(whole: dg.Scene, part: dg.Scene, begin: float, end: float) -> list[str]:
    """Names of attributes that differ between a scene and one read for an interval, s."""
    names = {*vars(whole)} - {"motion", "moments"}
    found = sorted(n for n in names if not exact(getattr(whole, n), getattr(part, n)))
    if part.moments not in (None, (begin, end)):
        found.append("moments")
    moving, other = dict(whole.motion.parts()), dict(part.motion.parts())
    if list(moving) != list(other):
        found.append("what moves")
    shares = (0.0, 0.37, 0.5, 1.0)
    times = [(1 - share) * begin + share * end for share in shares]
    for name, one in list(moving.items())[:_MANY]:
        breaks = [list(value.breaks(begin, end)) for value in (one, other.get(name, one))]
        with np.errstate(all="ignore"):
            alike = all(exact(one.at(t), other[name].at(t)) for t in (*times, *breaks[0]))
        if not alike or breaks[0] != breaks[1]:
            found.append(name)
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
