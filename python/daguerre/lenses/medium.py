"""Glasses and other optical media: refractive index by wavelength, and absorption."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import daguerre._core as _core
from daguerre.cached import cached_property
from daguerre.files.value import Value

_CORE: dict[str, Callable[..., _core.Glass]] = {
    "constant": _core.Glass.constant,
    "abbe": _core.Glass.abbe,
    "partial": _core.Glass.partial,
    "matched": lambda like, nd, vd: _core.Glass.matched(like.core, nd, vd),
    "table": _core.Glass.table,
    "sellmeier": _core.Glass.sellmeier,
    "polynomial": _core.Glass.polynomial,
    "water": _core.Glass.water,
    "vacuum": _core.Glass.vacuum,
}


@dataclass(frozen=True, eq=False)
class Medium(Value):
    """A glass or another optical medium.

    The core's glass is made with the medium, and again after unpickling. Impossible numbers raise
    the core's ``ValueError``.

    Attributes:
        formula: ``constant``, ``abbe``, ``partial`` (nd, Vd, theta_gF), ``matched`` (the dispersion
            of another medium at an nd and Vd), ``table``, ``sellmeier``, ``polynomial``, ``water``
            or ``vacuum``.
        numbers: Arguments of the formula.
        vacuum: Whether the index is relative to vacuum instead of air.
        absorption: Wavelengths (nm) and absorption coefficients, base e (1/mm); empty: none.
    """

    formula: str
    numbers: tuple[Any, ...] = ()
    vacuum: bool = False
    absorption: tuple[tuple[float, ...], ...] = ()

    def __post_init__(self) -> None:
        _ = self.core

    @cached_property
    def core(self) -> _core.Glass:
        """Glass in the core, for tracing."""
        made = _CORE[self.formula](*self.numbers)
        made = made.against_vacuum() if self.vacuum else made
        return made.with_absorption(*self.absorption) if self.absorption else made

    @property
    def absorbs(self) -> bool:
        """Whether absorption coefficients are known."""
        return bool(self.absorption)

    def against_vacuum(self) -> Medium:
        """Returns the medium with its numbers taken as relative to vacuum instead of air."""
        return replace(self, vacuum=True)

    def with_absorption(self, nm: Sequence[float], per_mm: Sequence[float]) -> Medium:
        """Returns the medium with absorption coefficients, base e, 1/mm."""
        return replace(self, absorption=(tuple(nm), tuple(per_mm)))

    def with_absorption_of(self, other: Medium) -> Medium:
        """Returns the medium with the absorption of another."""
        return replace(self, absorption=other.absorption)

    def index(self, nm: float) -> float:
        """Returns the index relative to air at a wavelength, nm."""
        return float(self.core.index(nm))

    def absorption_per_mm(self, nm: float) -> float:
        """Returns the absorption coefficient at a wavelength (nm), base e, 1/mm."""
        return float(self.core.absorption_per_mm(nm))


AIR = Medium("constant", (1.0,))
