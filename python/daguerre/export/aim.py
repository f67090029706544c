"""Fits the aim, film slopes for points of the iris, and the exposure at the centre of the film.

Both come from rays through the exported functions themselves, in numpy.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import languages
from .lens_code import RAY
from .plan import Aim, LensPlan, Vector

FloatArray = NDArray[np.float64]
Exponents = list[tuple[int, ...]]
#: Film points (mm), slopes, wavelengths (nm) and iris points (mm).
FilmRays = tuple[FloatArray, FloatArray, FloatArray, FloatArray]

IRIS_OUTPUTS = RAY.index("iris_x"), RAY.index("iris_y")
DEGREES = (4, 5)  # tried degrees in the variables of axial symmetry
FREE_DEGREES = (5, 6)  # tried degrees without symmetry, in all coordinates
RAYS = 6000
MARGIN = 1.06  # fitted radius over the iris radius; also the largest enlargement
EXPOSURE_NM = range(440, 680, 20)
#: V(lambda), CIE 1924, and D65, ISO/CIE 11664-2; their product weights wavelengths.
_EYE = (0.023, 0.06, 0.139, 0.323, 0.71, 0.954, 0.995, 0.87, 0.631, 0.381, 0.175, 0.061)
_DAYLIGHT = (104.9, 117.8, 115.9, 109.4, 104.8, 104.4, 100, 95.8, 90, 87.7, 83.7, 80.2)
EXPOSURE_WEIGHTS = np.array(_EYE) * _DAYLIGHT / np.dot(_EYE, _DAYLIGHT)
OPENINGS = np.sqrt(np.linspace(0.02, 1.0, 8))  # shares of the iris radius
EXPOSURE_TERMS = 3


def with_aim(plan: LensPlan) -> LensPlan:
    """Adds the aim, if one fits, and the exposure to a plan, which can then sample rays."""
    aim = fit_aim(plan)
    plan = replace(plan, aim=aim, exposure=(1.0,))
    return replace(plan, exposure=exposure(plan))


def callables(plan: LensPlan) -> tuple[Callable[..., Any], Callable[..., Any]]:
    """Returns ``evaluate`` and ``sample`` as numpy functions."""
    room: dict[str, Any] = {}
    name = languages.identifier(plan.name)
    # Safe to execute: without facts, the lens's name is the only text from its file.
    exec(compile(languages.numpy_file(plan, []), f"<{name}>", "exec"), room)
    return room[f"{name}_evaluate"], room[f"{name}_sample"]


def fit_aim(plan: LensPlan) -> Aim | None:
    """Fits the film slope m(film point, iris point, l) to rays; None: no fit is good enough."""
    outer = plan.blades.outer if plan.blades else 1.0
    rays = _film_rays(plan, MARGIN * outer * plan.iris_radius_mm)
    tried = (_aim(plan, rays, n) for n in (DEGREES if plan.symmetric else FREE_DEGREES))
    return next((aim for aim in tried if aim.enlargement < MARGIN), None)


def _aim(plan: LensPlan, rays: FilmRays, degree: int) -> Aim:
    """Fits an aim of one degree, enlarged by its error on fresh rays."""
    film, slope, nm, iris = rays
    radius = MARGIN * (plan.blades.outer if plan.blades else 1.0) * plan.iris_radius_mm
    exponents = _exponents(plan.symmetric, degree)
    f = (film - plan.film_center_mm) / plan.film_half_mm
    basis = _basis(plan, f, iris / radius, nm, exponents)
    train = len(nm) // 2
    fitted, found = _least_squares(plan.symmetric, basis, slope, train, exponents)
    fresh = [a[train:] for a in (film, found, nm)]
    error = np.hypot(*(_iris_points(plan, *fresh) - iris[train:]).T).max(initial=0)
    linear = np.linalg.lstsq(np.hstack([iris, film]), slope, rcond=None)[0][:2]
    orientation = 1.0 if np.linalg.det(linear) > 0 else -1.0
    enlargement = 1.002 + 1.25 * float(error) / plan.iris_radius_mm
    return Aim(fitted, radius, enlargement, orientation)


def exposure(plan: LensPlan) -> tuple[float, ...]:
    """Fits the mean weight on the axis in daylight, in the form of `LensPlan.exposure`."""
    _, sample = callables(plan)
    u1, u2 = quasi_random(2, 1024).T
    values = [
        sum(
            share * float(np.mean(sample(0.0, 0.0, u1, u2, nm, plan.f_stop / opening)[-1]))
            for nm, share in zip(EXPOSURE_NM, EXPOSURE_WEIGHTS, strict=True)
        )
        for opening in OPENINGS
    ]
    if any(mount.inner_mm for s in plan.segments for mount in s.mounts):
        return (values[-1],)  # a lens with a hole has one f-stop
    powers = np.vander(OPENINGS**2, EXPOSURE_TERMS, increasing=True)
    found = np.linalg.lstsq(powers, np.array(values), rcond=None)[0]
    return tuple(float(c) for c in found)


def focal_length(plan: LensPlan) -> float:
    """Film height over the slope of its scene ray, near the axis, mm."""
    height = 0.01 * plan.film_half_mm[0]
    u1, u2 = quasi_random(2, 512).T
    slopes = []
    for x in (-height, height):
        dx, _, dz, weight = callables(plan)[1](x, 0.0, u1, u2, 550.0, plan.f_stop)[-4:]
        slopes.append(np.average(-dx / dz, weights=np.broadcast_to(weight, u1.shape)))
    return float(2.0 * height / (slopes[1] - slopes[0]))


def _film_rays(plan: LensPlan, iris_mm: float) -> FilmRays:
    """Rays from the whole film that cross the iris within ``iris_mm`` of the axis."""
    x = quasi_random(5, RAYS)
    f = _disc(x[:, 0], x[:, 1]) if plan.symmetric else 2.0 * x[:, :2] - 1.0
    film = np.array(plan.film_center_mm) + f * plan.film_half_mm
    q = _disc(x[:, 2], x[:, 3])
    slope = (q - f * plan.q_by_film - plan.q_shift) / plan.q_by_slope
    offset, scale = plan.wavelength
    nm = 1e3 / np.sqrt((2.0 * x[:, 4] - 1.0 - offset) / scale)
    iris = _iris_points(plan, film, slope, nm)
    inside = np.hypot(*iris.T) < iris_mm
    return film[inside], slope[inside], nm[inside], iris[inside]


def _iris_points(plan: LensPlan, film: FloatArray, slope: FloatArray, nm: FloatArray) -> FloatArray:
    evaluate, _ = callables(replace(plan, aim=None))
    outputs = evaluate(*film.T, *slope.T, nm, plan.f_stop)
    return np.stack([outputs[i] for i in IRIS_OUTPUTS], axis=1)


def _basis(
    plan: LensPlan, f: FloatArray, a: FloatArray, nm: FloatArray, exponents: Exponents
) -> list[FloatArray]:
    """Basis columns, (N, terms), for x and for y; without symmetry one array for both."""
    wave = plan.wavelength[0] + plan.wavelength[1] * 1e6 / nm**2
    if not plan.symmetric:
        return [_monomials([*a.T, *f.T, wave], exponents)]
    s, w, u = (f * a).sum(1), 2.0 * (a * a).sum(1) - 1.0, 2.0 * (f * f).sum(1) - 1.0
    terms = _monomials([s, w, u, wave], exponents)
    return [np.hstack([f[:, i : i + 1] * terms, a[:, i : i + 1] * terms]) for i in (0, 1)]


def _least_squares(
    symmetric: bool,
    basis: list[FloatArray],
    slope: FloatArray,
    train: int,
    exponents: Exponents,
) -> tuple[Vector, FloatArray]:
    """Fits coefficients to the first ``train`` rays; returns them and values for all rays."""
    if symmetric:  # one set of coefficients for both components
        rows = np.concatenate([b[:train] for b in basis])
        c = np.linalg.lstsq(rows, slope[:train].T.ravel(), rcond=None)[0]
        found = np.stack([b @ c for b in basis], axis=1)
        both = np.split(c, 2)
    else:
        both = list(np.linalg.lstsq(basis[0][:train], slope[:train], rcond=None)[0].T)
        found = np.stack([basis[0] @ c for c in both], axis=1)
    first, second = (dict(zip(exponents, map(float, c), strict=True)) for c in both)
    return Vector(first, second), found


def _exponents(symmetric: bool, degree: int) -> Exponents:
    """Exponents of a complete basis; the last variable, the wavelength, counts double."""
    choices = product(range(degree + 1), repeat=4 if symmetric else 5)
    return [e for e in choices if sum(e) + e[-1] <= degree]


def _monomials(variables: list[FloatArray], exponents: Exponents) -> FloatArray:
    highest = max(max(e) for e in exponents)
    powers = [[v**k for k in range(highest + 1)] for v in variables]
    columns = [math.prod(powers[i][k] for i, k in enumerate(e)) for e in exponents]
    return np.stack(columns, axis=1)


def _disc(u1: FloatArray, u2: FloatArray) -> FloatArray:
    r, angle = np.sqrt(u1), 2.0 * math.pi * u2
    return np.stack([r * np.cos(angle), r * np.sin(angle)], axis=1)


def quasi_random(dimensions: int, count: int) -> FloatArray:
    """Points in [0, 1) by an additive recurrence, the generalised golden ratio (Roberts 2018)."""
    g = 2.0
    for _ in range(50):
        g = (1.0 + g) ** (1.0 / (dimensions + 1))
    steps = g ** -np.arange(1.0, dimensions + 1.0)
    return np.asarray((0.5 + np.outer(np.arange(1, count + 1), steps)) % 1.0)
