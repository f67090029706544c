"""Veiling glare of a lens: light from a white surround in the image of a black patch.

The veiling glare index follows ISO 9358: the light in the centre of the image of a black patch,
over the light there if the patch were as white as its surround.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

import daguerre._core as _core
from daguerre.argument_checks import guarded
from daguerre.camera.lens_scatter import core_parts
from daguerre.errors import InputError, core_errors

from .ghosts import NM, WEIGHTS

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from daguerre.camera.lens_scatter import LensScatter

    from .bench import Bench

WALKS = 60000
_BATCHES = 10


@guarded(init=True)
class VeilingGlare:
    """The veiling glare index, and its parts from ghosts and from scatter.

    Random walks run from the film backward through the lens. Walks that end in the direction of
    the patch are its image, all other walks are glare. The surround is far away, white up to 90
    degrees from the axis and lit by D65; wavelengths are weighted by the eye's sensitivity.

    Args:
        bench: The lens.
        scatter: Scatter of the parts of the lens; None: a well-made lens's.
        stack: Reflecting parts of the body; None: none.
        patch_mm: Diameter of the patch's image, on the axis, mm; None: a tenth of the image
            circle's.
        walks: Number of walks from the film, for all wavelengths together.
        seed: Seed of all random numbers.

    Attributes:
        index: Veiling glare index, %.
        ghosts: Light of ghosts, without scatter, relative to the image; its standard error is
            ``ghosts_error``.
        scatter: Light scattered by barrel, blades or surfaces, relative to the image.

    Raises:
        InputError: No light reaches the film, the barrel is unknown, or a part is invalid.
    """

    def __init__(
        self,
        bench: Bench,
        *,
        scatter: LensScatter | None = None,
        stack: _core.SensorStack | None = None,
        patch_mm: float | None = None,
        walks: int = WALKS,
        seed: int = 0,
    ) -> None:
        self.patch_mm = patch_mm or 0.2 * bench.field_mm
        with core_errors(InputError):
            lens = _core.ScatterLens(
                bench.lens.prescription,
                bench.film_z,
                _core.Iris(),
                bench.iris_radius,
                stack or _core.SensorStack(),
                bench.field_mm,
                core_parts(scatter),
            )
        edge = math.cos(math.atan(0.5 * self.patch_mm / abs(bench.order.efl)))
        each = max(1, walks // (_BATCHES * len(NM)))
        sums = np.array(
            [
                _light(lens, 0.1 * self.patch_mm, edge, each, seed * _BATCHES + i)
                for i in range(_BATCHES)
            ]
        )
        picture = sums[:, 0].mean()
        if not picture > 0:
            raise InputError(f"{bench.lens.name}: veiling glare: no light reaches the film")
        shares = sums / picture
        mean, spread = shares.mean(0), shares.std(0, ddof=1) / math.sqrt(_BATCHES)
        self.ghosts, self.scatter = float(mean[1]), float(mean[2])
        self.ghosts_error, self.scatter_error = float(spread[1]), float(spread[2])
        glare = self.ghosts + self.scatter
        self.index = 100 * glare / (1 + glare)

    def __repr__(self) -> str:
        return f"<VeilingGlare {self.index:.3g} %>"

    def facts(self) -> dict[str, Any]:
        """Returns all results as plain values."""
        return {
            "index_percent": self.index,
            "ghosts": self.ghosts,
            "ghosts_error": self.ghosts_error,
            "scatter": self.scatter,
            "scatter_error": self.scatter_error,
            "patch_mm": self.patch_mm,
        }


def _light(
    lens: _core.ScatterLens, spot: float, edge: float, walks: int, seed: int
) -> NDArray[np.float64]:
    """Light of the image, of ghosts and of scatter, summed with the weights of wavelengths."""
    total = np.zeros(3)
    for k, (nm, share) in enumerate(zip(NM, WEIGHTS, strict=True)):
        found = np.asarray(lens.from_film((0.0, 0.0), spot, nm, walks, seed * len(NM) + k))
        cosine, weight, events = found[:, 0], found[:, 2], found[:, 3]
        around = (cosine > 0) & (cosine < edge)
        parts = (cosine >= edge) & (events == 0), around & (events == 0), around & (events > 0)
        total += share * np.array([weight[part].sum() for part in parts])
    return total
