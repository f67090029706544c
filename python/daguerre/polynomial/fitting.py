"""Fits a lens of the library or a file."""

from __future__ import annotations

import math

import daguerre._core as _core
from daguerre import lenses
from daguerre.checks import number, numbers, short, whole
from daguerre.errors import UsageError
from daguerre.lenses.errors import reported
from daguerre.lenses.focus import focused
from daguerre.lenses.setting import By, LensSetting

from .lens_fit import LensFit
from .setting import FitSetting, iris_shape

#: The highest degree that is fitted.
MAX_DEGREE = 13
#: Pixel filters reach a little over the frame's edge.
FILM_MARGIN = 1.02


def fit(
    lens: lenses.Lens | str,
    degree: int = 7,
    *,
    f_stop: float | None = None,
    focus: float = math.inf,
    focus_by: By = "paraxial",
    film: tuple[float, float] | None = None,
    zoom: float | None = None,
    segments: int = 1,
    terms: int | None = None,
    iris: _core.Iris | None = None,
) -> LensFit:
    """Fits polynomials from film rays to scene rays.

    Args:
        lens: A lens, or the name of one in the library or of a file.
        degree: Degree of the polynomials in the ray's four coordinates: odd, 1 to 13.
        f_stop: F-stop; default: wide open.
        focus: Distance from the entrance pupil, m.
        focus_by: The paraxial image, or the smallest spot on the axis: ``best``.
        film: Width and height, mm; the format of the lens's file if None, else 36 x 24 mm.
        zoom: Focal length of a zoom, mm; as it stands if None.
        segments: Parts of the film by radius, each with polynomials of its own; the worst part is
            halved until there are as many. Lenses without axial symmetry have one.
        terms: Coefficients of each vector, chosen one by one (orthogonal matching pursuit); the
            complete basis if None.
        iris: Shape of the iris; round if None.

    Returns:
        The fit, with its error on rays that it was not fitted to.

    Raises:
        UsageError: A degree that is not fitted, or a film without size.
        LensError: The lens cannot open, focus or zoom like that.
    """
    if isinstance(lens, str):
        lens = lenses.load(lens)
    whole(degree, "lens fit: degree", 1, MAX_DEGREE)
    if degree % 2 == 0:
        raise UsageError(f"lens fit: degree: wanted an odd number from 1 to 13, got {degree}")
    whole(segments, "lens fit: segments", 1, 16)
    if terms is not None:
        whole(terms, "lens fit: terms", 1, 10000)
    width, height = _film(lens, film)
    if f_stop is not None:
        number(f_stop, "lens fit: f_stop", 0.1, 1000)
    sharp = focused(lens, LensSetting(f_stop, focus, zoom, focus_by))
    request = _core.LensFitRequest(
        film_z_mm=sharp.film_z_mm,
        film_radius_mm=FILM_MARGIN * math.hypot(width, height) / 2,
        film_half_mm=(FILM_MARGIN * width / 2, FILM_MARGIN * height / 2),
        iris=iris or _core.Iris(),
        degree=degree,
        segments=segments,
        terms=terms or 0,
    )
    with reported(lens.source):
        core = _core.LensFit.fit(sharp.lens.prescription, f_stop or 0.0, request)
    setting = FitSetting(
        f_stop=f_stop or sharp.lens.first_order().f_number,
        focus_m=focus,
        zoom_mm=sharp.lens.zoom_mm,
        source=lens.patent,
        iris=None if iris is None else iris_shape(iris),
    )
    return LensFit(core, setting)


def _film(lens: lenses.Lens, given: tuple[float, float] | None) -> tuple[float, float]:
    if given is None:
        text = lens.data.get("format") or "36x24"
        width, height = (float(side) for side in text.split("x"))
        return width, height
    width, height = numbers(given, "lens fit: film", 2, "width and height in mm")
    if not (0 < width < 1e4 and 0 < height < 1e4):
        raise UsageError(f"lens fit: film: wanted width and height in mm, got {short(given)}")
    return width, height
