"""Divides the film of a fit into as few zones as keep its error small."""

from __future__ import annotations

from collections.abc import Callable

from .lens_fit import LensFit

#: RMS error on the film that is worth telling, um: half a pixel of 960 over 36 mm.
WORTH_TELLING = 20.0
#: Numbers of film zones by radius to try.
SEGMENTS = (1, 2, 4)


def fewest(fitted: Callable[[int], LensFit]) -> LensFit:
    """Returns the first fit without a weak region, else the fit with the most zones.

    Args:
        fitted: Makes the fit of a number of zones.
    """
    for count in SEGMENTS[:-1]:
        found = fitted(count)
        if weak_region(found) is None:
            return found
    return fitted(SEGMENTS[-1])


def weak_region(fitted: LensFit) -> str | None:
    """Returns a note on the region of the film where a fit is poor, if any.

    A file has no exact lens to fall back to.
    """
    weak = [z for z in fitted.zones if z.rays and z.film_um[0] > WORTH_TELLING]
    if not weak:
        return None
    worst = max(z.film_um[0] for z in weak)
    return (
        f"the fit is off by more than {WORTH_TELLING:g} um RMS from {weak[0].low:.3g} to "
        f"{weak[-1].high:.3g} mm off the middle, up to {worst:.2g} um"
    )
