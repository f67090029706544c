"""Shape of the iris for blurs: an outline, or a picture."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre._core import IrisShape
from daguerre.errors import UsageError
from daguerre.pictures.iris import read_grey

from .effect import Values
from .parameter import Parameter

BLADES = (
    Parameter("blades", "number of iris blades; 0: round", "", 0, "whole", low=0),
    Parameter("blade_rotation", "rotation of the iris; 0: a corner points right", "deg", 0.0),
    Parameter(
        "blade_curvature",
        "curvature of the blades; 1: round, 0: straight, -1: bent inward",
        "",
        0.0,
        low=-1,
        high=1,
    ),
    Parameter(
        "aperture_image", "path of a grey picture of the opening, instead of blades", kind="file"
    ),
)
_ROUND = 256  # corners of a circle: 0.04 px off at a radius of 500 px
_LARGEST = 512  # px, largest side of a picture: more than a blur shows


def iris_shape(values: Values) -> IrisShape:
    """Makes the iris from an effect's parameters ``BLADES``.

    Raises:
        UsageError: The number of blades is invalid, or both blades and a picture are given.
        InputError: The picture cannot be read.
    """
    image = values["aperture_image"]
    if image is not None:
        if values["blades"]:
            raise UsageError("iris: wanted either blades or aperture_image, got both")
        return IrisShape.image(_smaller(read_grey(Path(image))))
    return IrisShape.outline(
        outline(values["blades"], values["blade_rotation"], values["blade_curvature"])
    )


def outline(blades: int, rotation_deg: float, curvature: float) -> NDArray[np.float64]:
    """Outline of the opening as corners, counterclockwise, y up, shape (N, 2), in any unit.

    Blades are straight (curvature 0), or arcs of a circle with a radius of 1 / curvature times the
    radius of the corners; negative curvature bends them inward.
    """
    if blades == 0:
        angle = np.linspace(0, 2 * math.pi, _ROUND, endpoint=False)
        return np.stack([np.cos(angle), np.sin(angle)], 1)
    if not 3 <= blades <= 64:
        raise UsageError(f"iris: blades: wanted 0 (round) or 3 .. 64, got {blades}")
    half = math.pi / blades
    pieces = 1 if curvature == 0 else max(8, _ROUND // blades)
    along = np.linspace(-1, 1, pieces, endpoint=False)  # the first blade, its middle on +x
    if curvature == 0:
        edge = np.stack([np.full(1, math.cos(half)), along * math.sin(half)], 1)
    else:
        radius = 1 / abs(curvature)
        opening = math.asin(min(1.0, math.sin(half) / radius))
        sagitta = math.copysign(1, curvature) * radius
        center = math.cos(half) - sagitta * math.cos(opening)
        edge = np.stack(
            [center + sagitta * np.cos(along * opening), radius * np.sin(along * opening)], 1
        )
    turns = math.radians(rotation_deg) + half * (2 * np.arange(blades) + 1)
    c, s = np.cos(turns)[:, None], np.sin(turns)[:, None]
    x, y = edge[:, 0], edge[:, 1]
    return np.ascontiguousarray(np.stack([c * x - s * y, s * x + c * y], 2).reshape(-1, 2))


def _smaller(picture: NDArray[np.float32]) -> NDArray[Any]:
    """Reduces a picture by means over blocks of pixels; its edges are cut to whole blocks."""
    block = math.ceil(max(picture.shape) / _LARGEST)
    height, width = (side // block for side in picture.shape)
    cut = picture[: height * block, : width * block].reshape(height, block, width, block)
    return np.ascontiguousarray(np.minimum(cut.mean(axis=(1, 3)), 1), np.float32)
