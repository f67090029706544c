"""Fitted lens: evaluation, errors, and conversion to data."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

import daguerre._core as _core
from daguerre.argument_checks import guarded
from daguerre.checks import wavelengths
from daguerre.errors import UsageError, core_errors
from daguerre.files import formats
from daguerre.files.value import BriefRecord

from .fit_data import error_zone, from_dict, to_dict
from .setting import FitSetting

FloatArray = NDArray[np.float64]


@guarded
@dataclass(frozen=True, repr=False)
class SceneRays(BriefRecord):
    """Scene rays for N film rays by a fit; lens frame, mm.

    Attributes:
        origins: Points on the sphere of the front surface, shape (N, 3).
        directions: Unit vectors toward the scene, shape (N, 3).
        iris: Points where the rays cross the iris, shape (N, 2).
        transmittance: Transmittance of the glass, shape (N,).
        within: Whether film, pupil and mounts let the ray pass, apart from the iris; shape (N,).
        angles: Directions as theta (dx, dy) / sin(theta), rad, shape (N, 2).
        offsets: Offsets from the centre of the entrance pupil, normal to the ray, shape (N, 2).
        mounts: Points on the limiting mounts, in their own frames, shape (N, M, 2).
    """

    origins: FloatArray
    directions: FloatArray
    iris: FloatArray
    transmittance: FloatArray
    within: NDArray[np.bool_]
    angles: FloatArray
    offsets: FloatArray
    mounts: FloatArray


@guarded
@dataclass(frozen=True)
class ErrorZone:
    """Error of a fit against the exact lens over film radii [low, high): RMS and worst ray.

    Attributes:
        low: Smallest film radius, mm.
        high: Largest film radius, mm.
        rays: Number of rays compared.
        direction_rad: Angle between the scene rays, rad.
        film_um: Distance on the film, um, when the fitted scene ray is traced exactly back.
        iris_mm: Distance on the iris, mm.
        mount_mm: Distance at the worst of the mounts, mm.
        transmittance: Error of the transmittance (0 to 1).
        lost: Share of the passing rays that the fit stops.
        leaked: Rays that the fit passes but the lens stops, as a share of the passing rays.
    """

    low: float
    high: float
    rays: int
    direction_rad: tuple[float, float]
    film_um: tuple[float, float]
    iris_mm: tuple[float, float]
    mount_mm: tuple[float, float]
    transmittance: tuple[float, float]
    lost: float
    leaked: float

    def film_px(self, pixels: int, width_mm: float) -> tuple[float, float]:
        """Returns RMS and worst error on the film, px, for ``pixels`` over ``width_mm``."""
        scale = 1e-3 * pixels / width_mm
        return self.film_um[0] * scale, self.film_um[1] * scale


@guarded(init=True)
class LensFit:
    """A lens as polynomials that map film rays to scene rays.

    A film ray is a point on the film (mm; the image is upside down) and a slope (dx/dz, dy/dz) in
    the lens frame, with z from the scene to the film.
    """

    def __init__(self, core: _core.LensFit, setting: FitSetting | None = None) -> None:
        """Wraps the core's fit, and the setting for which it was made, if known."""
        self.core = core
        self.setting = setting

    @property
    def lens(self) -> str:
        """Name of the lens."""
        return str(self.core.lens)

    @property
    def degree(self) -> int:
        """Degree of the polynomials in the ray's four coordinates."""
        return int(self.core.degree)

    @property
    def error(self) -> ErrorZone:
        """Error on rays over the whole film and pupil that were not used for fitting."""
        return ErrorZone(**error_zone(self.core.error.all))

    @property
    def zones(self) -> list[ErrorZone]:
        """Errors by film radius."""
        return [ErrorZone(**error_zone(zone)) for zone in self.core.error.zones]

    def evaluate(
        self, film_points: ArrayLike, slopes: ArrayLike, wavelength_nm: ArrayLike
    ) -> SceneRays:
        """Maps film rays to scene rays.

        Args:
            film_points: Film points, mm, shape (N, 2).
            slopes: Slopes dx/dz and dy/dz, shape (N, 2).
            wavelength_nm: Wavelength, nm, one or shape (N,).
        """
        film, slope = _rows(film_points, "film_points", 2), _rows(slopes, "slopes", 2)
        nm = _each(wavelength_nm, len(film))
        with core_errors(UsageError):
            found = self.core.evaluate(film, slope, np.ascontiguousarray(nm))
        angles, offsets, iris, mounts, light, within, origins, directions = found
        return SceneRays(
            origins, directions, iris, light, within.astype(bool), angles, offsets, mounts
        )

    def to_film(
        self, origins: ArrayLike, directions: ArrayLike, wavelength_nm: ArrayLike
    ) -> tuple[FloatArray, FloatArray]:
        """Maps scene rays to film rays: the inverse of ``evaluate``.

        Args:
            origins: Points on the rays, mm, shape (N, 3).
            directions: Unit vectors toward the scene, shape (N, 3).
            wavelength_nm: Wavelength, nm, one or shape (N,).

        Returns:
            Film points (mm) and slopes, shape (N, 2) each; NaN for rays outside the fit's film or
            pupil.
        """
        points, toward = _rows(origins, "origins", 3), _rows(directions, "directions", 3)
        nm = _each(wavelength_nm, len(points))
        with core_errors(UsageError):
            film, slopes = self.core.to_film(points, toward, np.ascontiguousarray(nm))
        return film, slopes

    def refitted(
        self,
        film_points: ArrayLike,
        slopes: ArrayLike,
        wavelength_nm: ArrayLike,
        origins: ArrayLike,
        directions: ArrayLike,
    ) -> LensFit:
        """Returns the fit with scene rays fitted to given ones, by least squares in its basis.

        Use it for maps from elsewhere, such as a Taylor series. Iris, mounts and transmittance are
        kept, and the error is unknown.

        Args:
            film_points: Film points over the whole film, mm, shape (N, 2); several for each
                coefficient.
            slopes: Slopes dx/dz and dy/dz, shape (N, 2).
            wavelength_nm: Wavelength, nm, a number or shape (N,).
            origins: A point on each scene ray, mm, shape (N, 3).
            directions: Unit vectors toward the scene, shape (N, 3).
        """
        film = _rows(film_points, "film_points", 2)
        nm = _each(wavelength_nm, len(film))
        points, toward = _rows(origins, "origins", 3), _rows(directions, "directions", 3)
        slope = _rows(slopes, "slopes", 2)
        with core_errors(UsageError):
            angles, offsets = self.core.describe(points, toward)
            return LensFit(
                self.core.refitted(film, slope, np.ascontiguousarray(nm), angles, offsets)
            )

    def to_dict(self) -> dict[str, Any]:
        """Returns the fit as JSON-compatible data, ``daguerre-lens-fit/0.1``."""
        setting = self.setting and self.setting.to_dict()
        return {**to_dict(self.core), "setting": setting}

    def save(self, path: str | Path) -> None:
        """Writes the lens as code or data: ``.osl``, ``.c``, ``.glsl``, ``.py`` or ``.json``.

        Raises:
            UsageError: The suffix is unknown, or the fit is too large for code without loops.
            InputError: The language cannot express the fit.
            OutputError: The file cannot be written.
        """
        formats.write("fit", path, self.to_dict())

    @classmethod
    def from_dict(cls, data: object) -> LensFit:
        """Makes a fit from the data of ``to_dict``.

        Raises:
            InputError: The data have another form; the message has the place.
        """
        core = from_dict(data)
        setting = data.get("setting") if isinstance(data, dict) else None
        return cls(core, None if setting is None else FitSetting.from_dict(setting))

    def __repr__(self) -> str:
        angle, film = self.error.direction_rad[0], self.error.film_um[0]
        return f"LensFit({self.lens!r}, degree {self.degree}: {angle:.2g} rad, {film:.2g} um RMS)"


def _rows(given: ArrayLike, name: str, columns: int) -> FloatArray:
    rows = np.ascontiguousarray(given, np.float64)
    if rows.ndim != 2 or rows.shape[1] != columns:
        raise UsageError(f"lens fit: {name}: wanted shape (N, {columns}), got {rows.shape}")
    return rows


def _each(wavelength_nm: ArrayLike, count: int) -> FloatArray:
    """Wavelengths of ``count`` rays, from a number for all rays or a number for each."""
    found = wavelengths(wavelength_nm, "lens fit: wavelength_nm")
    if found.shape not in ((), (1,), (count,)):
        raise UsageError(
            f"lens fit: wavelength_nm: wanted shape () or ({count},), got {found.shape}"
        )
    return np.broadcast_to(found, (count,))
