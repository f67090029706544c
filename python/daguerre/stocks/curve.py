"""Characteristic curve of film: density by exposure (Hurter and Driffield 1890)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daguerre.argument_checks import guarded
from daguerre.checks import number
from daguerre.errors import InputError

FloatArray = NDArray[np.float64]
#: log10 of exposure (lux s) times ISO for middle grey, 10 / S lux s by ISO 12232.
GREY = 1.0


@guarded
@dataclass(frozen=True)
class CharacteristicCurve:
    """Characteristic curve: a straight line with a soft toe and a soft shoulder.

        D(x) = least + gamma (s(x - toe; toe_bend) - s(x - shoulder; shoulder_bend)),
        s(x; a) = a ln(1 + exp(x / a)),

    where x is log10 of exposure (lux s) times ISO. For reversal film gamma is negative, and density
    falls from least - gamma (shoulder - toe).

    Attributes:
        least: Density of base plus fog.
        gamma: Slope of the straight line.
        toe: Exposure x at which the straight line starts from the base.
        shoulder: Exposure x at which the straight line ends.
        toe_bend: Softness of the toe, in x.
        shoulder_bend: Softness of the shoulder, in x.
    """

    least: float
    gamma: float
    toe: float
    shoulder: float
    toe_bend: float = 0.2
    shoulder_bend: float = 0.3

    def check(self, where: str) -> None:
        """Checks the values of the curve.

        Raises:
            InputError: A value is out of range; the message has its name.
        """
        for name in ("least", "gamma", "toe", "shoulder"):
            number(getattr(self, name), f"{where}: {name}", error=InputError)
        number(self.least, f"{where}: least", 0, 10, error=InputError)
        for name in ("toe_bend", "shoulder_bend"):
            number(getattr(self, name), f"{where}: {name}", 0, 10, above=0, error=InputError)
        if self.gamma == 0:
            raise InputError(f"{where}: gamma: must not be 0")
        if not self.toe < self.shoulder:
            raise InputError(
                f"{where}: shoulder: wanted more than the toe, {self.toe:g}, got {self.shoulder:g}"
            )

    def density(self, x: ArrayLike) -> FloatArray:
        """Returns the density at log exposures x, of any shape."""
        at = np.asarray(x, np.float64)
        rise = _soft(at - self.toe, self.toe_bend) - _soft(at - self.shoulder, self.shoulder_bend)
        return np.asarray(self._start + self.gamma * rise)

    def exposure(self, density: ArrayLike) -> FloatArray:
        """Returns the log exposure x of a density; the nearest for densities beyond the curve."""
        x = np.linspace(self.toe - 3, self.shoulder + 3, 4096)
        d = self.density(x)
        order = slice(None) if self.gamma > 0 else slice(None, None, -1)
        return np.asarray(np.interp(np.asarray(density), d[order], x[order]))

    @property
    def _start(self) -> float:
        """Density without light."""
        return self.least + max(0.0, -self.gamma * (self.shoulder - self.toe))


def _soft(x: FloatArray, bend: float) -> FloatArray:
    return np.asarray(bend * np.logaddexp(0, x / bend))
