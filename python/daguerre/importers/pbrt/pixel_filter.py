"""Pixel filter of pbrt: the flag that draws with it.

A scene has no filter here: that is a setting of the call or of the command line.

Source: pbrt-v4's user's guide ("Filters"); pbrt-v3's for ``alpha``, which is 1 / (2 sigma^2).
"""

from __future__ import annotations

import math

from .ledger import Ledger
from .parameters import Parameters
from .state import Entity

#: Filters that are ours, with their radius in pbrt-v4 and pbrt-v3, px.
_RADII = {
    "box": (0.5, 0.5),
    "gaussian": (1.5, 2.0),
    "mitchell": (2.0, 2.0),
    "triangle": (2.0, 2.0),
}
_OURS = {"triangle": "tent"}
#: Radii that ``--filter`` takes, px.
_LEAST, _MOST = 0.25, 16.0


def tell_filter(entity: Entity | None, version: int, ledger: Ledger) -> None:
    """Notes which flag draws with the pixel filter of a scene.

    Raises:
        InputError: A parameter is wrong.
    """
    if entity is None:
        return
    flag = _flag(entity.kind, entity.parameters, version)
    sentence = f"flags for the file's pixel filter: {flag}"
    if flag is None:
        sentence = "pbrt's pixel filter is left out: --filter chooses one"
    ledger.note(entity.place, sentence)


def _flag(kind: str, parameters: Parameters, version: int) -> str | None:
    """Flag that draws with a filter; None: none here has its shape."""
    if kind not in _RADII:
        return None
    usual = _RADII[kind][version == 3]
    radius, other = (parameters.number(f"{axis}radius", usual, 1e-6, 1e6) for axis in "xy")
    same = _is_ours(kind, radius, parameters, version)
    if not same or radius != other or not _LEAST <= radius <= _MOST:
        return None
    return f"--filter {_OURS.get(kind, kind)}:{radius:g}"


def _is_ours(kind: str, radius: float, parameters: Parameters, version: int) -> bool:
    """Whether the filter of this kind and radius has the same shape here."""
    if kind == "gaussian":
        return math.isclose(3 * _deviation(parameters, version), radius, rel_tol=1e-4)
    if kind == "mitchell":
        given = [parameters.number(name, 1 / 3, -1e6, 1e6) for name in "BC"]
        return all(math.isclose(value, 1 / 3, rel_tol=1e-3) for value in given)
    return True


def _deviation(parameters: Parameters, version: int) -> float:
    """Standard deviation of a Gaussian, px; ours is a third of the radius."""
    if version == 3:
        return 1 / math.sqrt(2 * parameters.number("alpha", 2.0, 1e-6, 1e6))
    return parameters.number("sigma", 0.5, 1e-6, 1e6)
