"""Focus of a tilted lens.

The lens turns about the centre of its entrance pupil (``core/camera/tilt.h``). The film stays
perpendicular to the camera's -z. Focus distances are along the lens's axis.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


def turn(tilt_deg: tuple[float, float]) -> FloatArray:
    """Rotation, camera from lens, shape (3, 3): about the camera's x, then about its y."""
    a, b = np.radians(tilt_deg)
    about_x = np.array([[1, 0, 0], [0, math.cos(a), -math.sin(a)], [0, math.sin(a), math.cos(a)]])
    about_y = np.array([[math.cos(b), 0, math.sin(b)], [0, 1, 0], [-math.sin(b), 0, math.cos(b)]])
    return np.asarray(about_y @ about_x)


def cosine(tilt_deg: tuple[float, float]) -> float:
    """Cosine of the angle between the axes of lens and camera."""
    return float(turn(tilt_deg)[2, 2])


def note(tilt_deg: tuple[float, float], focal_length: float) -> str:
    """Note on the plane of focus, which passes through a line f / sin(tilt) from the lens.

    Source: Merklinger 1996, Focusing the View Camera, ch. 5 (the hinge rule).
    """
    hinge = focal_length / math.sqrt(1 - cosine(tilt_deg) ** 2)
    angle = math.degrees(math.acos(cosine(tilt_deg)))
    far = f"{hinge:.3g} mm" if hinge < 1000 else f"{hinge / 1000:.3g} m"
    return (
        f"the lens is tilted by {angle:.3g} deg: the plane of focus hinges on a line {far} from "
        "the lens"
    )


@dataclass(frozen=True)
class CardinalPoints:
    """Cardinal points of a lens, z in its frame; see ``FirstOrder``.

    Attributes:
        front_focal_z: Front focal point.
        back_focal_z: Rear focal point.
        focal_squared: Product of both focal lengths, mm^2.
        front_focal: Front focal length, mm.
        pupil_z: Centre of the entrance pupil.
    """

    front_focal_z: float
    back_focal_z: float
    focal_squared: float
    front_focal: float
    pupil_z: float

    @classmethod
    def thin(cls, focal_length: float) -> CardinalPoints:
        """Makes the cardinal points of a thin lens."""
        return cls(-focal_length, focal_length, focal_length**2, focal_length, 0)


def focus_on(cardinal: CardinalPoints, tilt_deg: tuple[float, float], point_m: FloatArray) -> float:
    """Focus distance (m, along the lens's axis) at which a point is sharp.

    The point's image (Newton's x x' = f f') lies on the film. This gives the film's position, and
    with it the distance that is sharp on the axis.

    Args:
        cardinal: Cardinal points of the lens.
        tilt_deg: Tilt about x and y.
        point_m: Point in the camera's frame, m, shape (3,).
    """
    rotation = turn(tilt_deg)
    p = 1e3 * rotation.T @ point_m
    before = cardinal.front_focal_z - (p[2] + cardinal.pupil_z)  # of the front focus
    if not before > 0:
        return math.inf
    image_z = cardinal.back_focal_z + cardinal.focal_squared / before - cardinal.pupil_z
    scale = -cardinal.front_focal / before
    depth = float((rotation @ [scale * p[0], scale * p[1], image_z])[2])  # of the film
    behind = depth / rotation[2, 2] + cardinal.pupil_z - cardinal.back_focal_z
    if not behind > 0:
        return math.inf
    return 1e-3 * float(cardinal.focal_squared / behind - cardinal.front_focal_z + cardinal.pupil_z)


def focus_still(film_mm: float, tilt_deg: tuple[float, float], point_m: FloatArray) -> float:
    """Focus distance for a thin lens with a film that focusing does not move (``ThinLens``).

    With c the chief ray of depth 1, a the axis and D the film's distance, the point in focus has
    the depth t with 1 / t = (c . a) (a_z / D + 1 / focus) - 1 / D.
    """
    axis = -turn(tilt_deg)[:, 2]
    depth, film = -point_m[2], film_mm * 1e-3
    along = float(point_m / depth @ axis)
    inverse = (1 / depth + 1 / film) / along + float(axis[2]) / film
    return 1 / inverse if inverse > 0 else math.inf
