"""Third-order (Seidel) aberrations of an axially symmetric system."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daguerre.argument_checks import guarded
from daguerre.checks import number

FloatArray = NDArray[np.float64]

#: Largest deviation of coefficients from symmetry, relative to the largest of their kind.
TOLERANCE = 1e-9


@guarded
@dataclass(frozen=True)
class SeidelTerms:
    """Third-order part of a ray's position on the last plane, mm.

    With the point p where it crosses the entrance pupil (mm) and the field t, the tangent of the
    angle under which the object point is seen from the pupil's centre::

        spherical p |p|^2  +  coma (t |p|^2 + 2 p (p.t))  +  astigmatism t (p.t)
            +  field_curvature p |t|^2  +  distortion t |t|^2

    so that ``spherical`` is in mm per mm^3, ``coma`` in mm per mm^2, ``astigmatism`` and
    ``field_curvature`` (sagittal) in mm per mm, ``distortion`` in mm. On a plane that is not the
    image of the object, the coefficient of p (p.t) is not quite twice the coefficient of t |p|^2;
    ``coma`` is the latter.
    """

    spherical: float
    coma: float
    astigmatism: float
    field_curvature: float
    distortion: float
    convergence: float  # n' u' behind the system by mm of marginal height, in a front medium of 1

    @property
    def petzval(self) -> float:
        """Field curvature without astigmatism (Petzval), mm per mm."""
        return 2 * self.field_curvature - self.astigmatism

    def sums(self, pupil_radius: float, field_slope: float) -> FloatArray:
        """Returns Seidel's sums S1 to S5 in Welford's form, mm of wavefront, shape (5,).

        Args:
            pupil_radius: Radius of the entrance pupil, mm.
            field_slope: Tangent of the angle at the edge of the field.
        """
        kinds = (
            2 * self.spherical,
            2 * self.coma,
            self.astigmatism,
            self.petzval,
            2 * self.distortion,
        )
        r = number(pupil_radius, "sums: pupil_radius", -1e6, 1e6)
        number(field_slope, "sums: field_slope", -1e6, 1e6)
        powers = [r ** (4 - k) * field_slope**k for k in (0, 1, 2, 2, 3)]
        return np.array(kinds) * powers * self.convergence

    def rows(self) -> list[tuple[str, float, str]]:
        """Returns name, value and unit of each term."""
        return [
            ("spherical aberration", self.spherical, "mm/mm^3"),
            ("coma", self.coma, "mm/mm^2"),
            ("astigmatism", self.astigmatism, "mm/mm"),
            ("field curvature", self.field_curvature, "mm/mm"),
            ("distortion", self.distortion, "mm"),
        ]


def seidel_terms(
    monomials: NDArray[np.int32], coefficients: FloatArray, pupil: float, object_distance: float
) -> SeidelTerms | None:
    """The terms of an expansion about the axis; None: it has no axial symmetry.

    Args:
        monomials: Exponents, shape (M, 4), degree 3 at least.
        coefficients: Shape (4, M).
        pupil: Distance of the entrance pupil ahead of the first plane, mm.
        object_distance: Distance of the object in front of that pupil, mm; infinity allowed.
    """
    if not _symmetric(monomials, coefficients):
        return None
    at = {
        tuple(int(e) for e in row): column
        for row, column in zip(monomials, coefficients.T, strict=True)
    }
    (a, _, c, _), (b, _, d, _) = at[1, 0, 0, 0], at[0, 0, 1, 0]
    # The point on the first plane is q - pupil m, q on the pupil's and m the slope. The direction
    # d is m - m |m|^2 / 2 to third order.
    kinds = _shifted(np.array([at[e][0] for e in KINDS]), -pupil)
    kinds[5] -= b / 2
    # An object point at a finite distance sees the pupil under m = t + q / distance.
    nearness = 1 / object_distance
    kinds = _shifted(kinds[::-1], nearness)[::-1]
    spherical, _, coma, field_curvature, astigmatism, distortion = (float(k) for k in kinds)
    slope = float(c + nearness * (d - pupil * c))
    return SeidelTerms(
        spherical, coma, astigmatism, field_curvature, distortion, slope / float(a * d - b * c)
    )


#: Monomials of x' in which p |p|^2, p (p.d), d |p|^2, p |d|^2, d (p.d), d |d|^2 are found alone.
#: Read from the end it is the same list with p and d exchanged.
KINDS = ((3, 0, 0, 0), (1, 1, 0, 1), (0, 2, 1, 0), (1, 0, 0, 2), (0, 1, 1, 1), (0, 0, 3, 0))


def _shifted(kinds: FloatArray, h: float) -> FloatArray:
    """Changes factors of the kinds of (p, d) to factors of the kinds of (q, d), p = q + h d."""
    k0, k1, k2, k3, k4, k5 = kinds
    return np.array(
        [
            k0,
            2 * h * k0 + k1,
            h * k0 + k2,
            h * h * k0 + h * k1 + k3,
            2 * h * h * k0 + h * k1 + 2 * h * k2 + k4,
            h**3 * k0 + h * h * (k1 + k2) + h * (k3 + k4) + k5,
        ]
    )


def _symmetric(monomials: NDArray[np.int32], coefficients: FloatArray) -> bool:
    """Whether degrees 0 to 3 go with the ray when it is turned about the axis."""
    angle = 0.7
    turn = np.kron(np.eye(2), [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    rays = np.random.default_rng(1).normal(size=(12, 4))
    for degree in range(4):
        part = monomials.sum(axis=1) == degree

        def value(rays: FloatArray, part: NDArray[np.bool_] = part) -> FloatArray:
            powers = np.prod(rays[:, None, :] ** monomials[part], axis=2)
            return np.asarray(powers @ coefficients[:, part].T)

        gap = np.abs(value(rays @ turn.T) - value(rays) @ turn.T).max(axis=0)
        if (gap > TOLERANCE * np.abs(coefficients[:, part]).max(axis=1, initial=0.0)).any():
            return False
    return True
