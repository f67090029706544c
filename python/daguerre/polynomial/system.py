"""Polynomial system: maps rays to rays; can be composed, inverted and printed."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

import daguerre._core as _core
from daguerre.checks import doubles, number, whole
from daguerre.errors import UsageError, core_errors
from daguerre.lenses.lens import DESIGN_WAVELENGTH_NM

from .terms import SeidelTerms, seidel_terms

FloatArray = NDArray[np.float64]
NAMES = ("x", "y", "dx", "dy")


@dataclass(frozen=True, eq=False, repr=False)
class System:
    """Taylor expansion of an optical system about its base ray.

    A ray is ``(x, y, dx, dy)`` on a plane: a point in mm, and x and y of its unit direction. These
    cosines (not slopes), times the index of the medium, are the momenta conjugate to x and y, so a
    system conserves etendue up to its degree. z points along the light.

    ``P2 @ P1`` applies first P1, then P2, to the lower degree of both. This is exact to that degree
    if P2 is expanded about the ray on which P1 ends.

    Attributes:
        core: System in the core.
        pupil: Distance of the entrance pupil ahead of the first plane, mm; None: unknown.
    """

    core: _core.PolynomialSystem
    pupil: float | None = None

    @property
    def degree(self) -> int:
        """Highest degree of the monomials."""
        return int(self.core.degree)

    @property
    def wavelengths(self) -> FloatArray:
        """Wavelengths of the expansion, nm, shape (W,); empty: it holds for all."""
        return np.asarray(self.core.nm, np.float64)

    @property
    def monomials(self) -> NDArray[np.int32]:
        """Powers of x, y, dx and dy, sorted by degree, shape (M, 4)."""
        return np.asarray(self.core.monomials())

    @property
    def coefficients(self) -> FloatArray:
        """Coefficients of monomials of the ray minus the base ray, (4, M); (W, 4, M) for W > 1."""
        c = np.asarray(self.core.coefficients())
        return c[0] if len(c) == 1 else c

    @property
    def base(self) -> FloatArray:
        """Base ray on the first plane, shape (4,); (W, 4) for W > 1 wavelengths."""
        rays = np.asarray(self.core.origin())
        return rays[0] if len(rays) == 1 else rays

    @property
    def image(self) -> FloatArray:
        """Base ray on the last plane, shape (4,); (W, 4) for W > 1 wavelengths."""
        return self.coefficients[..., 0].copy()

    @property
    def matrix(self) -> FloatArray:
        """Matrix of first order: ABCD of both sections, shape (4, 4); (W, 4, 4) for W > 1."""
        first = self.monomials.sum(axis=1) == 1
        return self.coefficients[..., first].copy()

    def __call__(self, rays: ArrayLike, wavelength: ArrayLike | None = None) -> FloatArray:
        """Maps rays from the first plane to the last.

        Args:
            rays: Rays on the first plane, shape (N, 4) or (4,).
            wavelength: Wavelength, nm, one or shape (N,); default: the only one, else 587.56 nm.

        Raises:
            UsageError: Shapes do not match, or a wavelength is outside the system's range.
        """
        rows, nm = self._arguments(rays, wavelength)
        out = _said(self.core.evaluate, rows, nm)
        return np.asarray(out).reshape(np.shape(rays))

    def jacobian(self, rays: ArrayLike, wavelength: ArrayLike | None = None) -> FloatArray:
        """Returns derivatives of the ray on the last plane (rows), shape (N, 4, 4) or (4, 4)."""
        rows, nm = self._arguments(rays, wavelength)
        out = _said(self.core.jacobian, rows, nm)
        return np.asarray(out).reshape(*np.shape(rays), 4)

    def __matmul__(self, first: System) -> System:
        """Composes systems: ``first``, then this system."""
        if not isinstance(first, System):
            return NotImplemented
        return System(_said(self.core.after, first.core), self._pupil_before(first))

    def inverse(self) -> System:
        """Returns the inverse, from the last plane to the first, exact up to the degree."""
        return System(_said(self.core.inverse))

    def truncated(self, degree: int) -> System:
        """Returns the system without monomials above a degree."""
        degree = whole(degree, "truncated: degree", 1, self.degree)
        return replace(self, core=self.core.truncated(degree))

    def at(self, wavelength: float) -> System:
        """Returns the system at one wavelength, nm, interpolated between its nodes."""
        return replace(self, core=_said(self.core.at, number(wavelength, "wavelength in nm")))

    def seidel(
        self,
        wavelength: float | None = None,
        *,
        pupil: float | None = None,
        object_distance: float = np.inf,
    ) -> SeidelTerms:
        """Returns the third-order aberrations of the point on the last plane, by name.

        Args:
            wavelength: Wavelength, nm; default: the system's only wavelength, else 587.56 nm.
            pupil: Distance of the entrance pupil ahead of the first plane, mm; default: the known
                distance, else 0.
            object_distance: Distance of the object from that pupil, mm.

        Raises:
            UsageError: The degree is below 3, the system has no axial symmetry, or a distance is
                invalid.
        """
        if wavelength is not None:
            wavelength = number(wavelength, "seidel: wavelength in nm")
        if pupil is not None:
            pupil = number(pupil, "seidel: pupil in mm")
        given: Any = object_distance  # of any type yet
        endless = isinstance(given, float) and math.isinf(given)
        if not endless and not number(object_distance, "seidel: object_distance"):
            raise UsageError(
                "seidel: object_distance: the distance from the pupil must not be 0 mm"
            )
        terms = self._terms(wavelength, pupil, object_distance)
        if terms is None:
            raise UsageError(
                "seidel: wanted a degree of at least 3 and axial symmetry about the base ray, "
                f"got degree {self.degree}" + ("" if self.degree < 3 else " without symmetry")
            )
        return terms

    def _terms(
        self, wavelength: float | None, pupil: float | None, object_distance: float
    ) -> SeidelTerms | None:
        if self.degree < 3:
            return None
        if pupil is None:
            pupil = self.pupil or 0.0
        here = (
            self.at(float(np.asarray(self._wavelength(wavelength))))
            if self.wavelengths.size
            else self
        )
        if here.base.any():
            return None
        return seidel_terms(here.monomials, here.coefficients, pupil, object_distance)

    def _pupil_before(self, first: System) -> float | None:
        """Entrance pupil of a composed system: the first's, else this one's imaged through it."""
        if first.pupil is not None or self.pupil is None:
            return first.pupil
        matrix = first.matrix if first.matrix.ndim == 2 else first.matrix[0]
        (a, b), (c, d) = matrix[0, [0, 2]], matrix[2, [0, 2]]
        behind = a + self.pupil * c
        return float((b + self.pupil * d) / behind) if behind else None

    def _wavelength(self, wavelength: ArrayLike | None) -> ArrayLike:
        if wavelength is not None:
            return wavelength
        return self.wavelengths[0] if self.wavelengths.size == 1 else DESIGN_WAVELENGTH_NM

    def _arguments(
        self, rays: ArrayLike, wavelength: ArrayLike | None
    ) -> tuple[FloatArray, FloatArray]:
        who = "polynomial system"
        rows = np.atleast_2d(doubles(rays, who, "rays", "(x, y, dx, dy) of shape (N, 4)"))
        nm = np.atleast_1d(doubles(self._wavelength(wavelength), who, "wavelength", "nm"))
        if rows.ndim != 2 or rows.shape[1] != 4 or nm.ndim != 1:
            raise UsageError(
                "polynomial system: wanted rays (x, y, dx, dy) of shape (N, 4) and wavelengths of "
                f"shape () or (N,), got {np.shape(rays)} and {np.shape(nm)}"
            )
        return rows, nm

    def __repr__(self) -> str:
        return str(self)

    def __str__(self) -> str:
        return "\n".join(self._lines())

    def _lines(self) -> list[str]:
        nm = self.wavelengths
        at = ", ".join(f"{x:.6g}" for x in nm) + " nm" if nm.size else "any wavelength"
        lines = [
            f"polynomial system of degree {self.degree}, {len(self.monomials)} monomials, {at}"
        ]
        here = self if nm.size < 2 else self.at(float(nm[len(nm) // 2]))
        if nm.size > 1:
            lines.append(f"at {here.wavelengths[0]:.6g} nm")
        if here.base.any() or here.image.any():
            lines += [f"  base ray   {_ray(here.base)} -> {_ray(here.image)}"]
        lines += _first_order(here.matrix)
        terms = here._terms(None, None, np.inf)
        if terms is None:
            return [*lines, *_count_by_degree(here)]
        where = "on the first plane" if self.pupil is None else f"{self.pupil:.6g} mm ahead"
        lines.append(f"  third order, object at infinity, entrance pupil {where}")
        lines += [f"    {name:<22}{value:>+14.6e}  {unit}" for name, value, unit in terms.rows()]
        return [*lines, *_count_by_degree(here)]


def _said(call: Callable[..., Any], *arguments: object) -> Any:
    """Calls the core; re-raises its errors as ``UsageError``."""
    with core_errors(UsageError):
        return call(*arguments)


def _ray(ray: FloatArray) -> str:
    return "(" + ", ".join(f"{v:.6g}" for v in ray) + ")"


def _first_order(matrix: FloatArray) -> list[str]:
    """Rows of x' and dx', and of y' and dy' if they differ, without zeros."""
    rows = [0, 2] if np.allclose(matrix[::2, ::2], matrix[1::2, 1::2]) else [0, 1, 2, 3]
    lines = []
    for row in rows:
        size = np.abs(matrix[row]).max()
        parts = [
            f"{v:+.6g} {name}"
            for v, name in zip(matrix[row], NAMES, strict=True)
            if abs(v) > 1e-13 * size
        ]
        lines.append(f"    {NAMES[row] + chr(39):<4}= " + " ".join(parts))
    return ["  first order", *lines]


def _count_by_degree(system: System) -> list[str]:
    """Number of non-zero coefficients by degree."""
    degrees, used = system.monomials.sum(axis=1), (system.coefficients != 0).any(axis=0)
    counts = [f"{int(used[degrees == g].sum())} of degree {g}" for g in range(1, system.degree + 1)]
    counts = [c for c in counts if not c.startswith("0 ")]
    return ["  monomials in use: " + ", ".join(counts)]
