"""A lens on the bench: focused, its iris set, with exact rays in both directions.

Lens frame: mm, +z from the object to the film, z = 0 at the first vertex.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from daguerre.argument_checks import guarded
from daguerre.checks import number, rows, wavelengths
from daguerre.errors import UsageError
from daguerre.files.value import BriefRecord
from daguerre.lenses import FirstOrder, Lens
from daguerre.lenses.engraved import AS_GIVEN, opened
from daguerre.lenses.errors import LensError
from daguerre.lenses.focus import focused
from daguerre.lenses.glasses.catalogue import LINE_C, LINE_D, LINE_F
from daguerre.lenses.image_circle import half_image
from daguerre.lenses.lens import DESIGN_WAVELENGTH_NM
from daguerre.lenses.setting import By, LensSetting
from daguerre.lenses.stop_size import check_stop_size

from .plotted import Sectioned

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

#: Wavelengths of the lines F, d and C, nm, and their weights for the eye (CIE 1924 V).
FDC_NM = (LINE_F, LINE_D, LINE_C)
FDC_WEIGHTS = (0.181, 0.783, 0.072)


@dataclass(frozen=True, repr=False)
class Rays(BriefRecord):
    """Traced rays, each at the last surface that it met.

    Attributes:
        points: Points on that surface, mm, shape (N, 3).
        directions: Unit vectors behind that surface, shape (N, 3).
        iris: Points where the rays cross the stop, mm, shape (N, 2); NaN if they do not.
        path: Optical path from the origins to ``points``, mm, shape (N,).
        transmittance: Transmittance of the surfaces passed, shape (N,).
        passed: Whether a ray passed all surfaces, and was not stopped; shape (N,).
    """

    points: FloatArray
    directions: FloatArray
    iris: FloatArray
    path: FloatArray
    transmittance: FloatArray
    passed: BoolArray

    def at(self, z: float) -> FloatArray:
        """Points (N, 2) on the plane z, mm; NaN for rays that did not pass."""
        t = (z - self.points[:, 2]) / self.directions[:, 2]
        out = self.points[:, :2] + t[:, None] * self.directions[:, :2]
        out[~self.passed] = np.nan
        return np.asarray(out)


@guarded
@dataclass(frozen=True, repr=False)
class Bench(BriefRecord, Sectioned):
    """A lens at one focus, zoom and f-stop.

    Attributes:
        lens: The lens, with the gaps of its zoom and focus.
        f_stop: Engraved f-stop, at infinity focus.
        film_z: Position of the film along the axis, mm.
        focus_mm: Distance of the object in focus from the entrance pupil, mm; may be infinite.
        field_mm: Half of the image circle, mm: the largest image height of the figures.
    """

    lens: Lens
    f_stop: float
    iris_radius: float
    film_z: float
    focus_mm: float
    field_mm: float
    order: FirstOrder

    def rays(
        self,
        origins: FloatArray,
        directions: FloatArray,
        wavelength_nm: float = DESIGN_WAVELENGTH_NM,
        *,
        to_film: bool = True,
        clip: bool = True,
    ) -> Rays:
        """Traces rays exactly, in double precision.

        Args:
            origins: Points before the first surface (or behind the last), shape (N, 3), mm.
            directions: Directions toward the lens, shape (N, 3).
            wavelength_nm: One wavelength, nm.
            to_film: Whether rays run from the object to the film; else from film to object.
            clip: Whether clear apertures and the iris stop rays.
        """
        origins = rows(origins, "rays: origins", 3)
        directions = rows(directions, "rays: directions", 3)
        if len(origins) != len(directions):
            raise UsageError(f"rays: directions: wanted {len(origins)}, got {len(directions)}")
        nm = np.full(len(origins), wavelengths(wavelength_nm, "rays: wavelength_nm"))
        points, out, iris, path, transmittance, stopped = self.lens.prescription.rays(
            origins, directions, nm, clip, to_film
        )
        passed = stopped < 0
        if clip:
            with np.errstate(invalid="ignore"):
                passed &= np.hypot(iris[:, 0], iris[:, 1]) <= self.iris_radius * (1 + 1e-12)
        return Rays(points, out, iris, path, transmittance, passed)

    def moved(self, film_z: float) -> Bench:
        """Returns this bench with the film at ``film_z``, mm."""
        return replace(self, film_z=film_z)

    def stopped(self, f_stop: float) -> Bench:
        """Returns this bench at another f-stop."""
        return replace(self, f_stop=f_stop, iris_radius=_iris_radius(self.lens, self.order, f_stop))

    @property
    def pupil_diameter(self) -> float:
        """Diameter of the paraxial entrance pupil at this f-stop, mm."""
        if math.isinf(self.order.stop_semi_diameter):
            return abs(self.order.efl) / self.f_stop
        open_share = self.iris_radius / self.order.stop_semi_diameter
        return self.order.entrance_pupil.diameter * open_share

    @property
    def magnification(self) -> float:
        """Image size / object size at the focus distance; negative: upside down."""
        return (self.order.back_focal_point - self.film_z) / self.order.efl

    @property
    def projection(self) -> str:
        """Nominal projection of the lens: ``rectilinear``, or a fisheye's."""
        return self.lens.nominal.projection or "rectilinear"

    @property
    def is_fisheye(self) -> bool:
        """Whether the nominal projection is not rectilinear."""
        return self.projection != "rectilinear"


@guarded
def set_up(
    lens: Lens,
    *,
    f_stop: float | None = None,
    focus_m: float = math.inf,
    zoom_mm: float | None = None,
    by: By = "best",
    field_mm: float | None = None,
) -> Bench:
    """Puts a lens on the bench.

    Args:
        lens: A lens of the library, or read from a file.
        f_stop: F-stop; None, or up to 3 % wider than the lens opens: wide open.
        focus_m: Focus distance from the entrance pupil, m; may be infinite.
        zoom_mm: Focal length of a zoom, mm.
        by: Position of the film: ``best``: where the spot on the axis is smallest; ``paraxial``:
            where rays close to the axis meet.
        field_mm: Half of the image circle, mm; None: the lens's.

    Raises:
        InputError: The lens does not have this focus, zoom or f-stop.
    """
    return on_bench(lens, LensSetting(f_stop, focus_m, zoom_mm, by), field_mm)


def on_bench(lens: Lens, setting: LensSetting, field_mm: float | None = None) -> Bench:
    """Puts a lens on the bench at one setting; see :func:`set_up`."""
    if setting.zoom_mm is not None:
        lens = lens.at_zoom(setting.zoom_mm)
    far = lens.first_order()
    stop = far.f_number if setting.f_stop is None else opened(setting.f_stop, far.f_number)
    radius = _iris_radius(lens, far, stop)
    found = focused(lens, replace(setting, f_stop=stop, zoom_mm=None))
    order = found.lens.first_order()
    return Bench(
        lens=found.lens,
        f_stop=stop,
        iris_radius=radius,
        film_z=found.film_z_mm,
        focus_mm=1e3 * setting.focus_m,
        field_mm=field_mm or half_image(lens, order),
        order=order,
    )


def at_film(lens: Lens, film_z: float, field_mm: float) -> Bench:
    """Puts a lens on the bench, wide open, with its film at ``film_z`` (mm) in paraxial focus."""
    order = lens.first_order()
    x = film_z - order.back_focal_point
    front = order.front_principal_point - order.front_focal_point
    focus = order.entrance_pupil.z - order.front_focal_point + order.efl * front / x if x else 0.0
    return Bench(
        lens=lens,
        f_stop=order.f_number,
        iris_radius=order.stop_semi_diameter,
        film_z=film_z,
        focus_mm=focus if 0 < focus < 200 * abs(order.efl) else math.inf,
        field_mm=field_mm,
        order=order,
    )


def _iris_radius(lens: Lens, order: FirstOrder, f_stop: float) -> float:
    # The pupil's diameter is focal length / f-stop; the stop's is proportional to it.
    check_stop_size(lens)
    number(f_stop, f"{lens.name}: f-stop")
    if not (math.isfinite(f_stop) and f_stop > 0):
        raise LensError(
            f"{lens.name}: f-stop: wanted a positive number, got {f_stop:g}", "lens-f-stop"
        )
    if f_stop < AS_GIVEN * order.f_number:
        raise LensError(
            f"{lens.name}: f-stop: wanted f/{order.f_number:.3g} or narrower "
            f"(the widest of this lens), got f/{f_stop:g}",
            "lens-f-stop",
        )
    return float(order.stop_semi_diameter * order.f_number / f_stop)
