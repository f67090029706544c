"""Third-order aberrations by surface: the five Seidel sums, and two of colour."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from daguerre.argument_checks import guarded
from daguerre.errors import InputError, core_errors
from daguerre.files.value import BriefRecord
from daguerre.lenses.lens import DESIGN_WAVELENGTH_NM

from .bench import Bench, FloatArray
from .plotted import Plotted

NAMES = ("S1", "S2", "S3", "S4", "S5", "C1", "C2")
WIDEST_FIELD_DEG = 45.0  # a paraxial chief ray at a larger angle is meaningless


@guarded
@dataclass(frozen=True, repr=False)
class SeidelSums(BriefRecord, Plotted):
    """Welford's sums, mm of wavefront, for the edge of the pupil and of the field.

    Attributes:
        surfaces: Columns S1, S2, S3, S4, S5, C1 and C2 (from F to C), shape (surfaces, 7).
        field_deg: Field angle of the sums, degrees.
    """

    surfaces: FloatArray
    field_deg: float

    @property
    def total(self) -> FloatArray:
        """Sums over the lens, mm, shape (7,)."""
        return np.asarray(self.surfaces.sum(axis=0))


@guarded
def seidel_sums(bench: Bench, wavelength_nm: float = DESIGN_WAVELENGTH_NM) -> SeidelSums | None:
    """Computes the Seidel sums at the bench's aperture, focus and field (at most 45 degrees).

    Returns None for a lens without axial symmetry, or with its entrance pupil at infinity.
    """
    order = bench.order
    if not bench.lens.prescription.is_axially_symmetric or math.isinf(order.entrance_pupil.z):
        return None
    slope = min(bench.field_mm / abs(order.efl), math.tan(math.radians(WIDEST_FIELD_DEG)))
    with core_errors(InputError):
        rows, _, _ = bench.lens.prescription.seidel(
            wavelength_nm, 0.5 * bench.pupil_diameter, slope, bench.focus_mm
        )
    return SeidelSums(rows, math.degrees(math.atan(slope)))
