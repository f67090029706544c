"""Illuminance of the ground by an environment, as a light meter reads it, lux."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from daguerre.checks import number
from daguerre.color.spectra import luminance_of_rgb
from daguerre.errors import InputError

if TYPE_CHECKING:
    from .parts import Environment

_STRIPE = 256  # rows


def illuminance(environment: Environment) -> float:
    """Illuminance of an unobstructed horizontal plane that faces up, lux.

    E = integral of L cos(theta) over the upper hemisphere, exact for the rows of a panorama.
    """
    luma = luminance_of_rgb()
    if environment.image is None:
        return float(math.pi * environment.scale * (luma @ np.asarray(environment.color)))
    height, width = environment.image.shape[:2]
    edges = np.minimum(np.pi * np.arange(height + 1) / height, np.pi / 2)  # from the zenith
    weights = np.diff(np.sin(edges) ** 2) * np.pi / width  # of a pixel: cos(theta) dw
    total = 0.0
    for row in range(0, -(-height // 2), _STRIPE):
        rows = slice(row, row + _STRIPE)
        light = environment.image[rows, :, :3].astype(np.float64).sum(axis=1) @ luma
        total += float(weights[rows] @ light)
    return total * environment.scale


def scale_for(environment: Environment, lux: float, where: str = "environment: lux") -> float:
    """Computes the scale, cd/m2, that gives an environment an illuminance.

    Raises:
        UsageError: The illuminance is not a number of at least 0.
        InputError: The environment is black above the horizon.
    """
    number(lux, where, 0)
    now = illuminance(environment)
    if not now > 0:
        raise InputError(f"{where}: no light comes from above the horizon")
    return environment.scale * lux / now
