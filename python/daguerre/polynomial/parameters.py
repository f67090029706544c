"""Parameters of fits and expansions of lenses: one row each, for keywords, texts and checks."""

from __future__ import annotations

import math
from typing import TypedDict

from numpy.typing import ArrayLike

import daguerre._core as _core
from daguerre.lenses.lens import DESIGN_WAVELENGTH_NM
from daguerre.lenses.setting import By
from daguerre.parameters.parameter import Parameter
from daguerre.parameters.table import Table

from .elements import AXIS


class FitKeywords(TypedDict, total=False):
    """Keywords of ``fit``."""

    f_stop: float | None
    focus: float
    focus_by: By
    film: tuple[float, float] | None
    zoom: float | None
    segments: int
    terms: int | None
    iris: _core.Iris | None


class ExpansionKeywords(TypedDict, total=False):
    """Keywords of ``from_lens``."""

    ghost: tuple[int, int] | None
    wavelength: ArrayLike
    reverse: bool
    to_iris: int | None
    object_z: float
    film_z: float | None
    about: ArrayLike


# fmt: off
#: ``LensSetting`` checks focus and zoom.
FIT = Table(
    Parameter("f_stop", "F-stop; default: wide open", low=0.1, high=1000),
    Parameter("focus", "Distance from the entrance pupil, m", "m", math.inf, "value"),
    Parameter(
        "focus_by", "The paraxial image, or the smallest spot on the axis: ``best``",
        default="paraxial", kind="value",
    ),
    Parameter(
        "film", "Width and height, mm; the format of the lens's file if None, else 36 x 24 mm",
        "mm", kind="value",
    ),
    Parameter("zoom", "Focal length of a zoom, mm; as it stands if None", "mm", kind="value"),
    Parameter(
        "segments", "Parts of the film by radius, each with polynomials of its own; the worst part "
        "is halved until there are as many", default=1, kind="whole", low=1, high=16,
        more="Lenses without axial symmetry have one",
    ),
    Parameter(
        "terms", "Coefficients of each vector, chosen one by one (orthogonal matching pursuit); "
        "the complete basis if None", kind="whole", low=1, high=10000,
    ),
    Parameter("iris", "Shape of the iris; round if None", kind="value"),
)
EXPANSION = Table(
    Parameter(
        "ghost", "Two surfaces at which light is reflected on its way, in either order: at the one "
        "farther along first", kind="value",
    ),
    Parameter(
        "wavelength", "One, or nodes between which the coefficients follow the wavelength, nm, "
        "shape () or (W,); see ``wavelength_nodes``", "nm", DESIGN_WAVELENGTH_NM, "value",
    ),
    Parameter(
        "reverse", "From the film to the plane before the lens", default=False, kind="flag",
    ),
    Parameter(
        "to_iris", "End at the iris instead: at the crossing of this number, 0 for the first, -1 "
        "for the last (a ghost may cross it three times)", kind="whole", low=-1, high=2,
        more="Points are those of the iris's own frame",
    ),
    Parameter(
        "object_z", "The plane before the lens, z in the lens frame, mm: 0 touches the first "
        "vertex", "mm", 0.0,
    ),
    Parameter(
        "film_z", "The film, mm; not given: as the lens is focused, else its image plane", "mm",
    ),
    Parameter(
        "about", "Base ray, x, y and cosines on the plane where light starts, shape (4,)",
        default=AXIS, kind="value",
    ),
)
# fmt: on
