"""The characteristic curve of film: density by exposure (Hurter and Driffield 1890)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daguerre.checks import number
from daguerre.doors import guarded
from daguerre.errors import InputError

FloatArray = NDArray[np.float64]
#: log10 of exposure times ISO (lux s) of middle grey: 10 / S lux s, as of ISO 12232.
GREY = 1.0


@guarded
@dataclass(frozen=True)
class CharacteristicCurve:
    """A straight line between a toe and a shoulder, which is what three numbers and two bends make.

        D(x) = least + gamma (s(x - toe; toe_bend) - s(x - shoulder; shoulder_bend)),
        s(x; a) = a ln(1 + exp(x / a)),

    x the log10 of exposure (lux s) times ISO. With a negative gamma density falls from
    least - gamma (shoulder - toe): reversal film.

    Attributes:
        least: Density of base and fog.
        gamma: Slope of the straight line.
        toe: Where the straight line would leave the base, x.
        shoulder: Where it would end.
        toe_bend: How soft it begins, in x.
        shoulder_bend: How soft it ends, in x.
    """

    least: float
    gamma: float
    toe: float
    shoulder: float
    toe_bend: float = 0.2
    shoulder_bend: float = 0.3

    def check(self, where: str) -> None:
        """Refuses what is no curve.

        Raises:
            InputError: The message names the value.
        """
        for name in ("least", "gamma", "toe", "shoulder"):
            number(getattr(self, name), f"{where}: {name}", error=InputError)
        number(self.least, f"{where}: least", 0, 10, error=InputError)
        for name in ("toe_bend", "shoulder_bend"):
            number(getattr(self, name), f"{where}: {name}", 0, 10, above=0, error=InputError)
        if self.gamma == 0:
            raise InputError(f"{where}: gamma: wanted another number than 0")
        if not self.toe < self.shoulder:
            raise InputError(
                f"{where}: shoulder: wanted more than the toe at {self.toe:g}, got "
                f"{self.shoulder:g}"
            )

    def density(self, x: ArrayLike) -> FloatArray:
        """Density at log exposures, of any shape."""
        at = np.asarray(x, np.float64)
        rise = _soft(at - self.toe, self.toe_bend) - _soft(at - self.shoulder, self.shoulder_bend)
        return np.asarray(self._start + self.gamma * rise)

    def exposure(self, density: ArrayLike) -> FloatArray:
        """The log exposure that made a density; the nearest for what the curve does not reach."""
        x = np.linspace(self.toe - 3, self.shoulder + 3, 4096)
        d = self.density(x)
        order = slice(None) if self.gamma > 0 else slice(None, None, -1)
        return np.asarray(np.interp(np.asarray(density), d[order], x[order]))

    @property
    def _start(self) -> float:
        """Density of no light."""
        return self.least + max(0.0, -self.gamma * (self.shoulder - self.toe))


def _soft(x: FloatArray, bend: float) -> FloatArray:
    return np.asarray(bend * np.logaddexp(0, x / bend))
