"""Absorption inside of closed meshes."""

from __future__ import annotations

import math

from .surfaces import Absorption

#: Least share of light that passes over the distance of an absorption.
_LEAST_SHARE = 1e-6


def absorption(inside: Absorption) -> tuple[float, float, float]:
    """Absorption coefficients, 1/m: light of share ``color`` is left after the distance."""
    red, green, blue = (
        -math.log(max(share, _LEAST_SHARE)) / inside.distance_m for share in inside.color
    )
    return red, green, blue
