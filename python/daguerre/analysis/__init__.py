"""Measures a lens: spots, wavefronts, PSF, MTF, figures over the field, and a data sheet.

All figures come from exact rays through the prescription; docs/lens-bench.md has the formulas.
"""

from typing import TYPE_CHECKING

from daguerre.lazy_imports import lazy_attributes

from .bench import Bench, set_up
from .chief import chief_rays, film_heights
from .field import axial_colour, distortion, field_curvature, lateral_colour, spherical_aberration
from .figures import Figures
from .figures import figures as data_sheet
from .illumination import pupil_outline, relative_illumination, spectral_illumination
from .modulation import Mtf, modulation_transfer
from .mtf import diffraction_mtf, geometric_mtf, perfect_mtf
from .pencils import Pencil, pencil
from .psf import Psf, diffraction_psf, geometric_psf, point_spread, strehl_ratio
from .seidel import SeidelSums, seidel_sums
from .spots import Spot, best_film_z, spot
from .wavefronts import Wavefront, wavefront

if TYPE_CHECKING:
    from .ghost_trace import GhostRays, ghost_rays, trace_ghost

__all__ = [
    "Bench",
    "Figures",
    "GhostRays",
    "Mtf",
    "Pencil",
    "Psf",
    "SeidelSums",
    "Spot",
    "Wavefront",
    "axial_colour",
    "best_film_z",
    "chief_rays",
    "data_sheet",
    "diffraction_mtf",
    "diffraction_psf",
    "distortion",
    "field_curvature",
    "film_heights",
    "geometric_mtf",
    "geometric_psf",
    "ghost_rays",
    "lateral_colour",
    "modulation_transfer",
    "pencil",
    "perfect_mtf",
    "point_spread",
    "pupil_outline",
    "relative_illumination",
    "seidel_sums",
    "set_up",
    "spectral_illumination",
    "spherical_aberration",
    "spot",
    "strehl_ratio",
    "trace_ghost",
    "wavefront",
]

if not TYPE_CHECKING:  # checkers know the names above, and report all others
    __getattr__, __dir__ = lazy_attributes(
        __name__, dict.fromkeys(("GhostRays", "ghost_rays", "trace_ghost"), "ghost_trace")
    )
