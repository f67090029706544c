"""Expands a lens, or a ghost in it."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Unpack

import numpy as np
from numpy.typing import ArrayLike

import daguerre._core as _core
from daguerre.checks import doubles, number, short, shown, whole
from daguerre.errors import InputError, UsageError
from daguerre.lenses.errors import reported
from daguerre.lenses.focus import Focused
from daguerre.lenses.lens import Lens, check_wavelength
from daguerre.lenses.library import load
from daguerre.parameters.keywords import takes

from .elements import checked
from .parameters import EXPANSION, ExpansionKeywords
from .system import System
from .wavelengths import nodes_of


@takes(EXPANSION, ExpansionKeywords)
def from_lens(
    lens: Lens | Focused | str | Path, degree: int = 5, **keywords: Unpack[ExpansionKeywords]
) -> System:
    """Expands a lens as a polynomial, from a plane before it to the film.

    Even degrees are allowed; a lens with axial symmetry has no terms of even degree.

    Args:
        lens: Lens, focused lens, name or file.
        degree: Degree, 1 to 15.
        {keywords}

    Returns:
        The expansion; x and y are in the lens frame on all planes, in both directions.

    Raises:
        InputError: The base ray is stopped, or a surface is not smooth where it meets it; the
            message has the surface.
        UsageError: A parameter is invalid.
    """
    own_film = lens.film_z_mm if isinstance(lens, Focused) else None
    prescribed = load(lens.lens if isinstance(lens, Focused) else lens)
    asked = EXPANSION.filled(keywords, "from_lens")
    object_z, film_z, to_iris = (asked[name] for name in ("object_z", "film_z", "to_iris"))
    ghost, reverse = asked["ghost"], asked["reverse"]
    if not isinstance(reverse, bool):
        raise UsageError(f"from_lens: reverse: wanted True or False, got {shown(reverse)}")
    if film_z is None:
        film_z = prescribed.image_z if own_film is None else own_film
    ray = _ray(asked["about"])
    planes = float(object_z), number(film_z, "from_lens: film_z")
    if reverse:
        planes = planes[::-1]
    pair = None if ghost is None else _pair(ghost)
    crossing = None if to_iris is None else int(to_iris)
    nm = nodes_of(asked["wavelength"])
    check_wavelength(np.asarray(nm))
    degree = checked(degree)
    with reported(prescribed.source):
        core = _core.polynomial_of_lens(
            prescribed.prescription, degree, nm, planes, pair, not reverse, crossing, ray
        )
    pupil = None
    if not reverse and ghost is None:
        pupil = _pupil_ahead(prescribed, object_z)
    return System(core, pupil)


def _pupil_ahead(lens: Lens, object_z: float) -> float | None:
    """Distance of the entrance pupil ahead of a plane, mm; None: at infinity, or afocal."""
    try:
        z = lens.first_order().entrance_pupil.z - float(object_z)
    except InputError:
        return None
    return z if math.isfinite(z) else None


def _ray(about: ArrayLike) -> list[float]:
    ray = doubles(about, "from_lens", "about", "(x, y, dx, dy)")
    if ray.shape != (4,):
        raise UsageError(f"from_lens: about: wanted (x, y, dx, dy), got shape {ray.shape}")
    return [float(v) for v in ray]


def _pair(ghost: tuple[int, int]) -> tuple[int, int]:
    """Checks for two whole numbers; the core checks that the surfaces exist."""
    try:
        one, other = ghost
    except (TypeError, ValueError):
        raise UsageError(
            f"from_lens: ghost: wanted two surfaces (i, j), got {short(ghost)}"
        ) from None
    first, second = (whole(i, "from_lens: ghost: surface", -1, 1 << 30) for i in (one, other))
    return first, second
