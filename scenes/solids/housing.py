"""A housing full of air, black inside, and its port of glass."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from extensions.glass import clear
from extensions.studio import Studio
from kit import shapes
from solids.pool import AIR, EYE, GLASS

#: A lathe's axis, up, becomes the direction of view.
FORWARD = [-math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)]
#: Glass and air overlap by this, m: the glass comes later in the file, so it is there.
OVERLAP_M = 0.001
BACK_M = -0.25

Profile = list[tuple[float, float]]


def add_housing(studio: Studio, air: Profile, port: Profile, radius_m: float) -> None:
    """Adds air and glass, by profiles (radius, height over the pupil), and a black tube."""
    for name, profile, matter in (
        ("air of the housing", air, clear(studio, "air of the housing", AIR)),
        ("port", port, clear(studio, "port", GLASS)),
    ):
        shape = shapes.lathe(profile, 192, 30)
        studio.put(name, shape, matter, EYE, rotation=FORWARD)
    r, back = radius_m, BACK_M + 0.005
    black = studio.matter("black", (0.01, 0.01, 0.01), 0.9)
    tube = [
        (0, back),
        (r, back),
        (r, 0),
        (r - 0.002, 0),
        (r - 0.002, back + 0.002),
        (0, back + 0.002),
    ]
    studio.put("tube", shapes.lathe(tube, 96), black, EYE, rotation=FORWARD)


def arc(radius: float, begin_deg: float, end_deg: float, steps: int = 96) -> NDArray[np.float64]:
    """Points of a circle about the entrance pupil, by their angle from the axis."""
    angle = np.radians(np.linspace(begin_deg, end_deg, steps + 1))
    return np.stack([radius * np.sin(angle), radius * np.cos(angle)], 1)
