"""Fits a lens of the library or a file."""

from __future__ import annotations

import math
from typing import Unpack

import daguerre._core as _core
from daguerre import lenses
from daguerre.argument_checks import guarded
from daguerre.checks import numbers, short, shown, whole
from daguerre.errors import UsageError
from daguerre.lenses.engraved import opened
from daguerre.lenses.errors import reported
from daguerre.lenses.focus import focused
from daguerre.lenses.image_circle import FULL_FRAME, film_mm
from daguerre.lenses.setting import LensSetting
from daguerre.parameters.keywords import takes

from .lens_fit import LensFit
from .parameters import FIT, FitKeywords
from .setting import FitSetting, iris_shape

#: Highest degree of a fit.
MAX_DEGREE = 13
#: Extent of the fit in sizes of the film, as pixel filters reach a little beyond the frame.
FILM_MARGIN = 1.02


@takes(FIT, FitKeywords)
@guarded
def fit(lens: lenses.Lens | str, degree: int = 7, **keywords: Unpack[FitKeywords]) -> LensFit:
    """Fits polynomials that map film rays to scene rays.

    Args:
        lens: A lens, its name in the library, or a file.
        degree: Degree of the polynomials in the ray's four coordinates; odd, 1 to 13.
        {keywords}

    Returns:
        The fit, with its error on rays that were not used for fitting.

    Raises:
        UsageError: The degree or the size of the film is invalid.
        LensError: F-stop, focus or zoom is out of the lens's range.
    """
    if isinstance(lens, str):
        lens = lenses.load(lens)
    whole(degree, "lens fit: degree", 1, MAX_DEGREE)
    if degree % 2 == 0:
        raise UsageError(f"lens fit: degree: wanted an odd number from 1 to 13, got {degree}")
    asked = FIT.filled(keywords, "fit", "lens fit")
    if not isinstance(asked["iris"], _core.Iris | None):
        raise UsageError(f"lens fit: iris: wanted an Iris, got {shown(asked['iris'])}")
    f_stop, focus, iris = asked["f_stop"], asked["focus"], asked["iris"]
    if f_stop is not None:
        at = lens if asked["zoom"] is None else lens.at_zoom(asked["zoom"])
        f_stop = opened(f_stop, at.first_order().f_number)
    width, height = _film(lens, asked["film"])
    sharp = focused(lens, LensSetting(f_stop, focus, asked["zoom"], asked["focus_by"]))
    request = _core.LensFitRequest(
        film_z_mm=sharp.film_z_mm,
        film_radius_mm=FILM_MARGIN * math.hypot(width, height) / 2,
        film_half_mm=(FILM_MARGIN * width / 2, FILM_MARGIN * height / 2),
        iris=_core.Iris() if iris is None else iris,
        degree=degree,
        segments=asked["segments"],
        terms=asked["terms"] or 0,
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
        return film_mm(lens, FULL_FRAME)
    width, height = numbers(given, "lens fit: film", 2, "width and height in mm")
    if not (0 < width < 1e4 and 0 < height < 1e4):
        raise UsageError(
            "lens fit: film: wanted width and height above 0 and below 10000 mm, got "
            f"{short(given)}"
        )
    return width, height
