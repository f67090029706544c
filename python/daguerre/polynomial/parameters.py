"""Parameters of fits and expansions of lenses: a row for each, for keywords, texts and checks."""

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
    Parameter("focus", "Focus distance from the entrance pupil, m", "m", math.inf, "value"),
    Parameter(
        "focus_by", "Focus by the ``paraxial`` image, or by the smallest axial spot, ``best``",
        default="paraxial", kind="value",
    ),
    Parameter(
        "film", "Width and height, mm; None: the format in the lens's file, else 36 x 24 mm",
        "mm", kind="value",
    ),
    Parameter("zoom", "Focal length of a zoom, mm; None: the current one", "mm", kind="value"),
    Parameter(
        "segments", "Number of film zones by radius, each with its own polynomials; the worst zone "
        "is halved until there are as many", default=1, kind="whole", low=1, high=16,
        more="Lenses without axial symmetry have one",
    ),
    Parameter(
        "terms", "Number of coefficients per vector, chosen by orthogonal matching pursuit; "
        "None: the complete basis", kind="whole", low=1, high=10000,
    ),
    Parameter("iris", "Shape of the iris; None: round", kind="value"),
)
EXPANSION = Table(
    Parameter(
        "ghost", "Two surfaces that reflect the light, in either order; the farther one reflects "
        "first", kind="value",
    ),
    Parameter(
        "wavelength", "Wavelength, or nodes for interpolation of the coefficients, nm, shape () or "
        "(W,); see ``wavelength_nodes``", "nm", DESIGN_WAVELENGTH_NM, "value",
    ),
    Parameter(
        "reverse", "Whether to expand from the film to the plane before the lens", default=False,
        kind="flag",
    ),
    Parameter(
        "to_iris", "Index of the iris crossing at which to end instead; 0: the first, -1: the last "
        "(a ghost may cross it three times)", kind="whole", low=-1, high=2,
        more="Points are in the iris's own frame",
    ),
    Parameter(
        "object_z", "Plane before the lens, z in the lens frame, mm; 0 is at the first vertex",
        "mm", 0.0,
    ),
    Parameter(
        "film_z", "Film, z, mm; None: as the lens is focused, else its image plane", "mm",
    ),
    Parameter(
        "about", "Base ray (x, y, dx, dy) on the plane where light starts, shape (4,)",
        default=AXIS, kind="value",
    ),
)
# fmt: on
