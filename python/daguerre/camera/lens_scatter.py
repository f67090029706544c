"""Scatter properties of the parts of a lens.

See ``docs/scatter.md``.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import daguerre._core as _core
from daguerre.argument_checks import guarded
from daguerre.checks import number, numbers, short
from daguerre.errors import UsageError, core_errors

_Lobe = tuple[float, float]
_Finish = tuple[float, float, _Lobe]


@guarded
@dataclass(frozen=True)
class LensScatter:
    """Scatter properties of the parts of a lens; the defaults are a well-made lens.

    Attributes:
        barrel: Share of light that the barrel and the blackened edges of the glass scatter
            diffusely, 0 to 1.
        barrel_gloss: Share that they scatter into a lobe about the mirror direction, at normal
            incidence; it grows toward grazing incidence.
        blades: Like ``barrel``, for the iris blades.
        blades_gloss: Like ``barrel_gloss``, for the iris blades.
        gloss_lobe: Shape of that lobe: sine of the angle at which it begins to fall, and the power
            by which it falls.
        surface_rms_nm: RMS roughness of every polished surface, nm.
        surface_lobe: Shape of the lobe of polished surfaces, like ``gloss_lobe``.
    """

    barrel: float = 0.03
    barrel_gloss: float = 0.005
    blades: float = 0.03
    blades_gloss: float = 0.005
    gloss_lobe: tuple[float, float] = (0.1, -2.5)
    surface_rms_nm: float = 1.0
    surface_lobe: tuple[float, float] = (0.01, -1.5)


def core_parts(given: object) -> _core.LensScatter:
    """Checks the values and makes the core's record; None: the defaults.

    Raises:
        UsageError: A value is out of its range.
    """
    parts = LensScatter() if given is None else given
    where = "camera: scatter"
    if not isinstance(parts, LensScatter):
        raise UsageError(f"{where}: wanted a LensScatter, got {short(parts)}")
    for name in ("barrel", "barrel_gloss", "blades", "blades_gloss"):
        number(getattr(parts, name), f"{where}: {name}", 0, 1)
    number(parts.surface_rms_nm, f"{where}: surface_rms_nm", 0, 1000)
    lobes = [
        (float(knee), float(slope))
        for knee, slope in (
            numbers(getattr(parts, name), f"{where}: {name}", 2, "where it falls, and the power")
            for name in ("gloss_lobe", "surface_lobe")
        )
    ]
    with core_errors(UsageError, "camera"):
        return _made(
            (float(parts.barrel), float(parts.barrel_gloss), lobes[0]),
            (float(parts.blades), float(parts.blades_gloss), lobes[0]),
            float(parts.surface_rms_nm),
            lobes[1],
        )


@lru_cache(maxsize=8)
def _made(barrel: _Finish, blades: _Finish, rms_nm: float, lobe: _Lobe) -> _core.LensScatter:
    """Makes the core's record; cached, because its tables take 10 ms."""
    return _core.LensScatter(barrel, blades, rms_nm, lobe)
