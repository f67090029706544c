"""Applies ACES views of OpenColorIO to scene-linear light (extra ``color``)."""

from __future__ import annotations

from functools import cache
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import UsageError, suggest
from daguerre.files import extras

#: Newest built-in configuration of OpenColorIO.
CONFIG = "ocio://studio-config-latest"
LINEAR = "Linear Rec.709 (sRGB)"
DISPLAYS = {"srgb": "sRGB - Display", "p3": "Display P3 - Display"}


def view_of(light: NDArray[np.float32], view: str, space: str = "srgb") -> NDArray[np.float32]:
    """Applies a view of OpenColorIO for a display; ``light`` is changed in place.

    Args:
        light: Scene-linear Rec.709, shape (H, W, 3).
        view: Name in the configuration, such as "ACES 2.0 - SDR 100 nits (Rec.709)".
        space: ``srgb`` or ``p3``.

    Raises:
        UsageError: The view is unknown, or OpenColorIO is not installed.
    """
    check_view(view, space)
    ocio, display = _module(), DISPLAYS[space]
    config = _config(ocio)
    transform = ocio.DisplayViewTransform(src=LINEAR, display=display, view=view)
    light = np.ascontiguousarray(np.nan_to_num(light, copy=False), np.float32)
    config.getProcessor(transform).getDefaultCPUProcessor().applyRGB(light)
    return np.clip(light, 0, 1, out=light)


def check_view(view: str, space: str = "srgb") -> None:
    """Checks that a view exists, before there is light to show.

    Raises:
        UsageError: The view is unknown, or OpenColorIO is not installed.
    """
    if space not in DISPLAYS:
        wanted = " or ".join(DISPLAYS)
        raise UsageError(f"develop: colour_space: wanted {wanted} for OCIO, got {space!r}")
    known = list(_config(_module()).getViews(DISPLAYS[space]))
    if view not in known:
        raise UsageError(
            f"develop: look: wanted ocio: and a view of {', '.join(map(repr, known))}; "
            f"got {view!r}{suggest(view, known)}"
        )


@cache
def _config(ocio: ModuleType) -> Any:
    return ocio.Config.CreateFromFile(CONFIG)


def _module() -> ModuleType:
    extras.need("PyOpenColorIO", "develop: look: an OCIO view")
    import PyOpenColorIO

    found: ModuleType = PyOpenColorIO
    return found
