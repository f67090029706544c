"""Ghosts as Taylor polynomials, and their error against exact rays.

Source: Hullin, Hanika and Heidrich 2012, Polynomial Optics, CGF 31(4).
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from daguerre.analysis.ghost_trace import GhostRays, ghost_rays, stop_index
from daguerre.analysis.ghosts import RAYS, Ghost, Ghosts, blank, splat
from daguerre.argument_checks import guarded
from daguerre.checks import rows
from daguerre.errors import UsageError
from daguerre.files.value import BriefRecord
from daguerre.lenses.lens import DESIGN_WAVELENGTH_NM

from .elements import AXIS, checked
from .lens_system import from_lens
from .system import System

FloatArray = NDArray[np.float64]

_BLOCK = 4096  # places at a time: their powers stay in the cache

#: Ray about which a ghost is expanded: in the middle of its light, or the axis.
About = Literal["light", "axis"]


@guarded
@dataclass(frozen=True, repr=False)
class GhostPolynomial(BriefRecord):
    """Taylor polynomials of one ghost: from the plane z = 0 to the film, and to the iris.

    Mounts other than the iris have no polynomial, so they stop no ray.

    Attributes:
        film: Expansion to the film.
        iris: Expansions to each crossing of the iris, one or three.
        iris_radius: Radius of the iris, mm.
        direction: Direction of the light, dx and dy.
    """

    film: System
    iris: tuple[System, ...]
    iris_radius: float
    direction: tuple[float, float]

    def points(self, places: FloatArray, *, to_iris: bool = True) -> FloatArray:
        """Points on the film of light that enters at places of the plane z = 0.

        The direction is constant, so the polynomials are first reduced to polynomials of x and y.

        Args:
            places: Places x, y, mm, shape (N, 2).
            to_iris: Whether the iris stops light.

        Returns:
            Points, mm, shape (N, 2); NaN: the iris stops the light.
        """
        places = rows(places, "points: places", 2)
        landed = _for_parallel_light(self.film, self.direction, places)
        for crossing in self.iris if to_iris else ():
            there = _for_parallel_light(crossing, self.direction, places)
            landed[~(np.hypot(*there.T) <= self.iris_radius)] = np.nan
        return landed


@guarded
def expand_ghost(light: GhostRays, degree: int, *, about: About = "light") -> GhostPolynomial:
    """Expands a ghost as Taylor polynomials.

    Args:
        light: Where the light of the ghost enters, at one wavelength.
        degree: Degree, 1 to 15.
        about: Base ray: in the middle of the ``light``, or the ``axis``.

    Raises:
        InputError: No light passes, or a surface has no expansion where the base ray meets it; the
            message has the surface.
        UsageError: The degree is not 1 .. 15.
    """
    if about not in ("light", "axis"):
        raise UsageError(f"expand_ghost: about: wanted light or axis, got {about!r}")
    bench, pair = light.bench, light.surfaces
    base = AXIS if about == "axis" else tuple(light.middle)

    def expand(to_iris: int | None) -> System:
        return from_lens(
            bench.lens, degree, ghost=pair, wavelength=light.wavelength_nm, about=base,
            film_z=bench.film_z, to_iris=to_iris,
        )  # fmt: skip

    crossings = 3 if min(pair) < stop_index(bench) < max(pair) else 1
    return GhostPolynomial(
        expand(None),
        tuple(expand(k) for k in range(crossings)),
        bench.iris_radius,
        (float(light.rays[0, 2]), float(light.rays[0, 3])),
    )


def _for_parallel_light(
    system: System, direction: tuple[float, float], places: FloatArray
) -> FloatArray:
    """Points (N, 2) of parallel light: sums of x^a y^b, with the powers of dx and dy constant."""
    powers, size = system.monomials, system.degree + 1
    constant = np.prod((np.array(direction) - system.base[2:]) ** powers[:, 2:], axis=1)
    tables = np.zeros((2, size, size))
    for table, coefficients in zip(tables, system.coefficients[:2] * constant, strict=True):
        np.add.at(table, (powers[:, 0], powers[:, 1]), coefficients)
    out = np.empty((len(places), 2))
    for begin in range(0, len(places), _BLOCK):
        block = slice(begin, begin + _BLOCK)
        x, y = (np.vander(v, size, increasing=True) for v in (places[block] - system.base[:2]).T)
        for k, table in enumerate(tables):
            out[block, k] = ((x @ table) * y).sum(axis=1)
    return out


@guarded
@dataclass(frozen=True, repr=False)
class GhostError(BriefRecord):
    """Error of the polynomial of one ghost, over the exact rays that land on the film.

    Where none of its light is on the film at this wavelength, all numbers are NaN.

    Attributes:
        ghost: The ghost.
        exact: Points where exact rays land, mm, shape (N, 2); NaN: a mount or the iris stops them.
        points: Points where the polynomial lands the same rays; NaN: its iris stops them.
        error_mm: RMS distance between polynomial and exact ray on the film, mm.
        radius_mm: RMS radius of the exact points about their centre, mm.
        shift_mm: Distance between the centres of both, mm.
        diverges: Whether the highest two degrees make the error larger.
    """

    ghost: Ghost
    exact: FloatArray
    points: FloatArray
    error_mm: float
    radius_mm: float
    shift_mm: float
    diverges: bool

    @property
    def error(self) -> float:
        """``error_mm`` over ``radius_mm``."""
        return self.error_mm / self.radius_mm if self.radius_mm > 0 else math.nan

    def facts(self) -> dict[str, Any]:
        """Returns the numbers as plain values; None: unknown."""
        numbers = {
            "error_mm": self.error_mm,
            "error": self.error,
            "radius_mm": self.radius_mm,
            "shift_mm": self.shift_mm,
        }
        known = {name: v if math.isfinite(v) else None for name, v in numbers.items()}
        return {**known, "diverges": self.diverges}


@guarded(init=True)
class PolynomialGhosts:
    """All ghosts that reach the film as Taylor polynomials, compared with exact rays.

    Polynomials and exact rays are computed in double precision by one thread, for the same rays.

    Args:
        ghosts: Ghosts of a lens without reflecting parts of the body.
        degree: Degree, 1 to 15.
        about: Base ray of each expansion: in the middle of the ghost's ``light``, or the ``axis``.
        rays: Rays over the light of each ghost.
        wavelength_nm: Wavelength, nm.

    Attributes:
        all: Errors of the ghosts that reach the film, brightest first.
        rays: Number of rays of all ghosts together.
        setup_s: CPU time of the expansions, s.
        polynomial_s: CPU time to evaluate them for all rays, s.
        exact_s: CPU time to trace the same rays exactly, s.

    Raises:
        InputError: A surface has no expansion; the message has the surface.
        UsageError: The body has reflecting parts, or the degree is not 1 .. 15.
    """

    def __init__(
        self,
        ghosts: Ghosts,
        degree: int,
        *,
        about: About = "light",
        rays: int = RAYS,
        wavelength_nm: float = DESIGN_WAVELENGTH_NM,
    ) -> None:
        self.ghosts, self.degree, self.wavelength_nm = ghosts, checked(degree), wavelength_nm
        self.rays = 0
        self.setup_s = self.polynomial_s = self.exact_s = 0.0
        if len(ghosts.core.vertices) > len(ghosts.bench.lens.surfaces):
            raise UsageError(
                "polynomial ghosts: wanted the ghosts of a lens alone, got reflecting parts of the "
                "body, too"
            )
        angle = math.radians(ghosts.angle_deg)
        toward = (0.0, math.sin(angle), math.cos(angle))
        self.all: list[GhostError] = []
        for ghost in ghosts.all:
            if ghost.light > 0:
                pair = (ghost.surfaces[0], ghost.surfaces[1])
                light = ghost_rays(
                    ghosts.bench, pair, toward, rays=rays, wavelength_nm=wavelength_nm
                )
                self.all.append(self._error(ghost, light, about))

    def __repr__(self) -> str:
        name = self.ghosts.bench.lens.name
        return f"<PolynomialGhosts of {name}: {len(self.all)}, degree {self.degree}>"

    def _error(self, ghost: Ghost, light: GhostRays, about: About) -> GhostError:
        start = time.process_time()
        exact = light.points
        traced = time.process_time()
        if not light.passed.any():
            return GhostError(ghost, exact, exact, math.nan, math.nan, math.nan, False)
        polynomial = expand_ghost(light, self.degree, about=about)
        expanded = time.process_time()
        points = polynomial.points(light.rays[:, :2])
        self.polynomial_s += time.process_time() - expanded
        self.setup_s += expanded - traced
        self.exact_s += traced - start
        self.rays += len(exact)
        half = np.asarray(self.ghosts.film) / 2
        on_film = light.passed & (np.abs(np.nan_to_num(exact, nan=np.inf)) <= half).all(axis=1)
        wanted = exact[on_film]
        if not len(wanted):
            return GhostError(ghost, exact, points, math.nan, math.nan, math.nan, False)
        places = light.rays[on_film, :2]
        found = polynomial.points(places, to_iris=False)
        lower = _two_lower(polynomial).points(places, to_iris=False)
        error = _rms(found - wanted)
        return GhostError(
            ghost,
            exact,
            points,
            error_mm=error,
            radius_mm=_rms(wanted - wanted.mean(axis=0)),
            shift_mm=float(np.hypot(*(found - wanted).mean(axis=0))),
            diverges=error > _rms(lower - wanted),
        )

    @property
    def median_error(self) -> float:
        """Median error of all ghosts, relative to their radius; NaN: there are none."""
        known = [e.error for e in self.all if math.isfinite(e.error)]
        return float(np.median(known)) if known else math.nan

    @property
    def median_error_mm(self) -> float:
        """Median error of all ghosts, mm; NaN: there are none."""
        known = [e.error_mm for e in self.all if math.isfinite(e.error_mm)]
        return float(np.median(known)) if known else math.nan

    @property
    def diverging(self) -> list[GhostError]:
        """Ghosts with an expansion that diverges."""
        return [e for e in self.all if e.diverges]

    def facts(self) -> dict[str, Any]:
        """Returns degree, median errors and times as plain values; None: unknown."""
        medians = {"median_error": self.median_error, "median_error_mm": self.median_error_mm}
        return {
            "degree": self.degree,
            "wavelength_nm": self.wavelength_nm,
            "ghosts": len(self.all),
            "diverging": len(self.diverging),
            **{name: v if math.isfinite(v) else None for name, v in medians.items()},
            "rays": self.rays,
            "setup_s": self.setup_s,
            "polynomial_s": self.polynomial_s,
            "exact_s": self.exact_s,
        }

    def picture(self, pixels: int = 240, *, exact: bool = False) -> FloatArray:
        """All ghosts on the film, upright, shape (H, W): light per mm2, over the image's light.

        Args:
            pixels: Width, px.
            exact: Whether to draw the exact rays instead of the polynomials.
        """
        film = self.ghosts.film
        image = blank(film, pixels)
        for error in self.all:
            points = error.exact if exact else error.points
            landed = points[np.isfinite(points[:, 0])]
            share = error.ghost.everywhere / max(1, len(landed))
            image += splat(landed, np.full(len(landed), share), film, image.shape)
        return image * (image.size / (film[0] * film[1]))


def _two_lower(polynomial: GhostPolynomial) -> GhostPolynomial:
    """The same without the highest two degrees; of degree 2 and 1 the lower one remains."""
    film = polynomial.film
    return replace(polynomial, film=film.truncated(max(1, film.degree - 2)))


def _rms(vectors: FloatArray) -> float:
    return math.sqrt(float((vectors**2).sum(axis=1).mean()))
