"""Compositing of objects over a plate in linear light, with the layers of catchers.

:mod:`daguerre.frame.catcher` defines ``catcher`` and ``catcher_ratio``. All forms give the same
picture where the plate equals the modelled set. Elsewhere *auto* removes light as a share of
the plate, which has the true materials, and adds light by difference, which does not depend on how
dark the plate is.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daguerre.checks import short
from daguerre.errors import UsageError, suggest

from .frame import Frame

Plane = NDArray[np.float32]
AUTO, RATIO, DIFFERENCE = FORMS = ("auto", "ratio", "difference")


@dataclass(frozen=True)
class Change:
    """Change of a plate: ``factor`` times the plate, plus ``light``; shapes (H, W, C)."""

    factor: Plane
    light: Plane

    def of(self, plate: Plane) -> Plane:
        """The composite."""
        return np.asarray(self.factor * plate + self.light, np.float32)


def change_of(
    light: Plane, alpha: Plane, catcher: Plane | None, ratio: Plane | None, form: str = AUTO
) -> Change:
    """Computes the change that objects bring to any plate.

    Args:
        light: Light of the objects, premultiplied, shape (H, W, C).
        alpha: Coverage of the objects, shape (H, W).
        catcher: Difference layer of the catchers, shape (H, W, C); None: there are no catchers.
        ratio: Ratio layer of the catchers.
        form: ``auto``, ``ratio`` or ``difference``.

    Raises:
        UsageError: No such form.
    """
    if form not in FORMS:
        raise UsageError(
            f"form: wanted {', '.join(FORMS)}, got {short(form)}{suggest(form, FORMS)}"
        )
    left = (1 - alpha)[..., None]
    if catcher is None or ratio is None:
        return Change(np.broadcast_to(left, light.shape), light)
    if form == DIFFERENCE:
        return Change(np.broadcast_to(left, light.shape), light + catcher)
    if form == RATIO:
        return Change(left * ratio, light)
    return Change(left * np.minimum(ratio, 1), light + np.maximum(catcher, 0))


def change_of_rgb(frame: Frame, form: str = AUTO) -> Change:
    """Computes the change in red, green and blue, relative exposure."""
    return change_of(frame.rgb, frame.alpha, frame.catcher, frame.catcher_ratio, form)
