"""Ghosts of a lens: which pairs of surfaces send light to the film, how much, and where.

The source is at infinity, below the axis; its image is above. All lengths are in mm.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core
from daguerre.argument_checks import guarded
from daguerre.checks import whole
from daguerre.errors import InputError, core_errors
from daguerre.files.value import BriefRecord
from daguerre.lenses.lens import DESIGN_WAVELENGTH_NM

from .bench import Bench
from .plotted import Plotted

if TYPE_CHECKING:
    from collections.abc import Sequence

#: Wavelengths of the report, nm, every 40 nm, and their weights: CIE 1924 V times D65.
NM = (450.0, 490.0, 530.0, 570.0, 610.0, 650.0)
_EYE = (4.4, 22.5, 92.5, 92.0, 45.0, 8.5)
WEIGHTS = tuple(w / sum(_EYE) for w in _EYE)
RAYS = 4096
_DRAWN = 9  # most rays of a drawing


@dataclass(frozen=True, repr=False)
class Ghost(BriefRecord):
    """One ghost: light that is reflected by two surfaces.

    Attributes:
        surfaces: Indices of the reflecting surfaces, in the order in which light meets them;
            surfaces of the body follow surfaces of the lens.
        light: Light of the ghost on the film, relative to the image of the same source straight
            ahead.
        everywhere: Light on the whole plane of the film, relative to the same image.
        center: Centre of the light on the film, x and y, mm.
        radius: RMS radius of the light on the film about its centre, mm.
        points: Points where rays land, x, y (mm), and their shares, shape (N, 3).
    """

    surfaces: tuple[int, ...]
    light: float
    everywhere: float
    center: tuple[float, float]
    radius: float
    points: NDArray[np.float32]


@guarded(init=True)
class Ghosts(Plotted):
    """The ghosts of a lens for a distant source, brightest first.

    Args:
        bench: The lens.
        angle_deg: Angle of the source from the axis, degrees.
        film: Width and height of the film, mm; None: 3 : 2 within the image circle.
        stack: Reflecting parts of the body; None: none.
        rays: Rays over the front of the lens, for each ghost.

    Raises:
        InputError: No light passes the lens, or ``stack`` is invalid.
    """

    def __init__(
        self,
        bench: Bench,
        angle_deg: float,
        *,
        film: tuple[float, float] | None = None,
        stack: _core.SensorStack | None = None,
        rays: int = RAYS,
    ) -> None:
        self.bench, self.angle_deg = bench, angle_deg
        half = bench.field_mm / math.hypot(3, 2)
        self.film = film or (6 * half, 4 * half)
        self.stack = stack or _core.SensorStack()
        half_film = (self.film[0] / 2, self.film[1] / 2)
        with core_errors(InputError):
            self.core = _core.GhostLens(
                bench.lens.prescription,
                bench.film_z,
                _core.Iris(),
                bench.iris_radius,
                self.stack,
                math.hypot(*half_film),
            )
            found = self.core.spots(
                math.radians(angle_deg), half_film, list(NM), list(WEIGHTS), rays, True
            )
        self.all = [
            Ghost(tuple(surfaces), light, everywhere, center, radius, points)
            for surfaces, light, everywhere, center, radius, points in found
        ]

    def __repr__(self) -> str:
        name = self.bench.lens.name
        return f"<Ghosts of {name}: {len(self.all)}, light from {self.angle_deg:g} deg>"

    def find(self, surfaces: Sequence[int]) -> Ghost:
        """Returns the ghost of two surfaces, given in either order.

        Raises:
            InputError: There is no such ghost.
        """
        for ghost in self.all:
            if sorted(ghost.surfaces) == sorted(surfaces):
                return ghost
        reflecting = ", ".join(str(i) for i in self.core.reflecting)
        raise InputError(
            f"{self.bench.lens.name}: ghost: wanted two different surfaces out of {reflecting}; "
            f"got {','.join(str(i) for i in surfaces)}"
        )

    def facts(self) -> list[dict[str, Any]]:
        """Returns all ghosts as plain values."""
        return [
            {
                "surfaces": list(g.surfaces),
                "light": g.light,
                "light_everywhere": g.everywhere,
                "center_mm": list(g.center),
                "radius_mm": g.radius,
            }
            for g in self.all
        ]

    def paths(self, ghost: Ghost) -> list[NDArray[np.float64]]:
        """Rays of a ghost in the meridional section, from the drawing's left edge to the film."""
        angle = math.radians(self.angle_deg)
        direction = [0.0, math.sin(angle), math.cos(angle)]
        low = -(self.bench.lens.surfaces[0].semi_diameter or 0.5 * self.bench.pupil_diameter)
        high = -low
        for _ in range(3):  # narrow the range where few rays pass
            found, heights = [], []
            for y in np.linspace(low, high, 401):
                path = np.asarray(
                    self.core.path(
                        list(ghost.surfaces), [0.0, float(y), 0.0], direction, DESIGN_WAVELENGTH_NM
                    )
                )
                if len(path):
                    start = path[0] - 0.25 * self.bench.film_z * np.asarray(direction)
                    found.append(np.vstack([start, path]))
                    heights.append(float(y))
            if not found or len(found) >= 4 * _DRAWN:
                break
            gap = (high - low) / 400
            low, high = heights[0] - gap, heights[-1] + gap
        step = max(1, len(found) // _DRAWN)
        return found[step // 2 :: step][:_DRAWN]

    def picture(self, pixels: int = 600) -> NDArray[np.float64]:
        """All ghosts on the film, upright, shape (H, W): light per mm2, over the image's light."""
        image = blank(self.film, pixels)
        for ghost in self.all:
            if ghost.light > 0:
                points = ghost.points.astype(np.float64)
                image += splat(points[:, :2], ghost.light * points[:, 2], self.film, image.shape)
        width, height = self.film
        return image * (image.size / (width * height))


def blank(film: tuple[float, float], pixels: int) -> NDArray[np.float64]:
    """A dark picture of a film (width and height, mm), ``pixels`` wide."""
    whole(pixels, "picture: pixels", 1, 8192)
    return np.zeros((max(1, round(pixels * film[1] / film[0])), pixels))


def splat(
    points: NDArray[np.float64],
    light: NDArray[np.float64],
    film: tuple[float, float],
    shape: tuple[int, ...],
) -> NDArray[np.float64]:
    """Adds up light in the pixels of an upright picture of the film, shape (H, W).

    Args:
        points: Points on the film, mm, shape (N, 2); the image there is upside down.
        light: Light of each point, shape (N,).
        film: Width and height of the film, mm.
        shape: Height and width of the picture, px.
    """
    (width, height), (rows, columns) = film, shape
    edges = [
        np.linspace(-height / 2, height / 2, rows + 1),
        np.linspace(-width / 2, width / 2, columns + 1),
    ]
    held, _, _ = np.histogram2d(points[:, 1], -points[:, 0], bins=edges, weights=light)
    return np.asarray(held)
