"""Nominal projections of lenses: image height over focal length, by the angle from the axis.

Source: Miyamoto 1964, Fish Eye Lens, JOSA 54(8).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.float64]

#: Height over focal length by the angle from the axis, rad.
PROJECTIONS: dict[str, Callable[[FloatArray], FloatArray]] = {
    "rectilinear": np.tan,
    "equidistant": lambda angle: angle,
    "equisolid": lambda angle: 2 * np.sin(0.5 * angle),
    "stereographic": lambda angle: 2 * np.tan(0.5 * angle),
    "orthographic": np.sin,
}
#: Projections by the names that lens files may use.
PROJECTION_NAMES = {
    **{name: name for name in PROJECTIONS},
    **{f"fisheye-{name}": name for name in PROJECTIONS if name != "rectilinear"},
}


def projected(projection: str, efl: float, angle: ArrayLike) -> FloatArray:
    """Image height of a projection, mm, at an angle from the axis, rad."""
    return np.asarray(efl * PROJECTIONS[projection](np.asarray(angle, np.float64)))
