"""Records that the writers for other renderers take: a scene and a resolved camera."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from daguerre.files.notes import Notes
from daguerre.scene.scene import Scene


@dataclass(frozen=True)
class LensFile:
    """A prescription of spherical surfaces, front to rear.

    Attributes:
        rows: Radius of curvature (0: the stop, or a plane of no effect), distance to the next row,
            index of the next medium at 587.56 nm, and clear diameter, shape (N, 4), mm.
        stop_diameter_mm: Diameter of the iris at its setting.
        focus_from_film_m: Distance from the film to the plane in focus.
        pupil_from_film_m: Distance from the film to the entrance pupil, along the axis.
        gain: Factor on the film's light that makes a world of luminance 1 a picture of 1.
        chromatic: Whether the indices of its glass change with wavelength.
    """

    rows: NDArray[np.float64]
    stop_diameter_mm: float
    focus_from_film_m: float
    pupil_from_film_m: float
    gain: float
    chromatic: bool = False


@dataclass(frozen=True)
class ExportedView:
    """A camera as other renderers know it: a pinhole or a thin lens before an upright film.

    Attributes:
        world_from_camera: Rigid pose, shape (4, 4), m; it looks along -z, +y is up.
        film_mm: Width and height of the picture on the film.
        shift_mm: Position of the picture's middle relative to the axis, right and up.
        film_distance_mm: Distance from the lens to the film.
        aperture_radius_m: Radius of the lens; 0: a pinhole.
        focus_distance_m: Distance from the lens to the plane in focus, along the axis.
        near_m: Distance below which nothing is seen.
        lens: Prescription that the thin lens approximates, if its surfaces are spherical.
        gain: Factor on the light of the picture, by the exposure mode.
    """

    world_from_camera: NDArray[np.float64]
    film_mm: tuple[float, float]
    shift_mm: tuple[float, float] = (0.0, 0.0)
    film_distance_mm: float = 50.0
    aperture_radius_m: float = 0.0
    focus_distance_m: float = np.inf
    near_m: float = 0.0
    lens: LensFile | None = None
    gain: float = 1.0

    @property
    def window(self) -> tuple[float, float, float, float]:
        """Tangents of the directions of the picture's edges: left, right, bottom, top."""
        (width, height), (x, y), f = self.film_mm, self.shift_mm, self.film_distance_mm
        return (x - width / 2) / f, (x + width / 2) / f, (y - height / 2) / f, (y + height / 2) / f


@dataclass(frozen=True)
class Outgoing:
    """A scene at its time, its camera, and the settings of the picture.

    Attributes:
        scene: The scene.
        view: The camera.
        resolution: Width and height of the picture, px.
        spp: Samples per pixel.
        max_depth: Largest number of surfaces along a light path.
        notes: Remarks on approximations and missing parts; writers add theirs.
    """

    scene: Scene
    view: ExportedView
    resolution: tuple[int, int]
    spp: int
    max_depth: int
    notes: Notes = field(default_factory=Notes)
