"""Exposures of photographs, and the luminance of a value of 1.

By ISO 12232, middle grey (0.18) has the exposure H = 10 / S lux s, with S the ISO. With
H = pi / 4 L t / N^2 for f-number N and t seconds, a value of 1 has the luminance
L = 4 / pi * 10 / 0.18 * N^2 / (t S) cd/m2.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from daguerre.errors import InputError, UsageError
from daguerre.files.notes import Notes
from daguerre.sensors.iso_speed import GREY, GREY_LX_S

from .shots import Shot

#: Luminance x t S / N^2 of a value of 1.
_WHITE = 4 / math.pi * GREY_LX_S / GREY
_WORDS = {"expTime": "exposure time", "aperture": "f-number", "isoSpeed": "ISO"}


@dataclass(frozen=True)
class Exposures:
    """Exposures of the photographs of one view.

    Attributes:
        luminance: Luminance of a value of 1 in each photograph, cd/m2 if ``absolute``.
        absolute: Whether the unit is known.
    """

    luminance: tuple[float, ...]
    absolute: bool

    @property
    def stops(self) -> tuple[float, ...]:
        """Exposure of each photograph above the darkest, EV."""
        highest = max(self.luminance)
        return tuple(math.log2(highest / value) for value in self.luminance)


def exposures_of(
    shots: list[Shot],
    ev: Sequence[float] | None,
    scale: float | None,
    notes: Notes,
    flag: str = "--scale",
) -> Exposures:
    """Returns the exposures, from ``ev`` if given, else from EXIF.

    Args:
        shots: Photographs of one view.
        ev: Exposure of each photograph, EV, more is brighter; None: from EXIF.
        scale: Luminance of a value of 1, cd/m2: at 0 EV, in linear files, or without EXIF.
        notes: Gets notes on missing values.
        flag: Flag of ``scale``, for the notes.

    Raises:
        UsageError: The numbers of ``ev`` and photographs differ.
        InputError: EXIF lacks a required value.
    """
    if ev is not None:
        if len(ev) != len(shots):
            raise UsageError(f"--ev: wanted {len(shots)}, one for each photograph, got {len(ev)}")
        values = tuple((scale or 1.0) / 2**one for one in ev)
        return Exposures(values, scale is not None)
    if all(not shot.metered for shot in shots):
        if len(shots) > 1:
            raise InputError(
                f"{shots[1].path}: exposure: linear files do not store it; give --ev, such as "
                "--ev -4,0"
            )
        return Exposures((scale or 1.0,), True)
    return _by_exif(shots, scale, notes, flag)


def _by_exif(shots: list[Shot], scale: float | None, notes: Notes, flag: str) -> Exposures:
    known = {name: [shot.facts.get(name) for shot in shots] for name in _WORDS}
    if len(shots) > 1:
        _refuse_missing(shots, known)
    factors = np.ones(len(shots))
    for name, power in (("expTime", 1), ("aperture", -2), ("isoSpeed", 1)):
        values = [v if v is not None else 1.0 for v in known[name]]
        factors *= np.array(values, np.float64) ** power
    absolute = all(v is not None for values in known.values() for v in values)
    if scale is not None:  # of the first photograph
        return Exposures(tuple(scale * factors[0] / factors), True)
    if absolute:
        return Exposures(tuple(_WHITE / factors), True)
    missing = [_WORDS[name] for name, values in known.items() if None in values]
    notes.add(f"EXIF lacks {', '.join(missing)}, so the unit of light is unknown; {flag} sets it")
    return Exposures(tuple(np.median(factors) / factors), False)


def _refuse_missing(shots: list[Shot], known: dict[str, list[float | None]]) -> None:
    """Checks EXIF of several photographs: times are required, f-number and ISO in all or none."""
    for name, values in known.items():
        for shot, value in zip(shots, values, strict=True):
            if value is None and (name == "expTime" or any(values)):
                raise InputError(
                    f"{shot.path}: EXIF: wanted the {_WORDS[name]}, got none; give --ev, such as "
                    "-4,-2,0"
                )
