"""Exact rays of one ghost: where parallel light enters that becomes it, and where it lands.

Lengths in mm, in the lens frame. A ray is (x, y, dx, dy): a point of the plane z = 0, which touches
the first vertex, and x and y of the unit direction.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core
from daguerre.argument_checks import guarded
from daguerre.cached import cached_property
from daguerre.checks import number, numbers, rows, whole
from daguerre.errors import InputError, UsageError, core_errors
from daguerre.files.value import BriefRecord
from daguerre.lenses.lens import DESIGN_WAVELENGTH_NM, check_wavelength

from .bench import Bench

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

_LOOKS = 6  # maximum number of steps of the search for where light enters
_NARROW, _WIDE = 32, 160  # rays across a step of the search, and across a repeated step
_FEW = 16  # with fewer rays that pass, the step is repeated with more rays
_FULL = 0.25  # the search ends once this share of the rays passes
_SHIFTS = (0.754877666, 0.569840291)  # low-discrepancy sequence (R2) for places within cells
_STEP = 0.02  # the middle is rounded to this share of the window: symmetry puts it on the axis


@guarded
@dataclass(frozen=True, repr=False)
class GhostRays(BriefRecord):
    """Parallel light of one ghost, evenly over the part of the front where it enters.

    Attributes:
        bench: The lens.
        surfaces: Indices of the two reflecting surfaces.
        wavelength_nm: Wavelength, nm.
        rays: Rays before the lens, shape (N, 4): x, y on the plane z = 0 (mm), dx, dy.
    """

    bench: Bench
    surfaces: tuple[int, int]
    wavelength_nm: float
    rays: FloatArray

    @cached_property
    def points(self) -> FloatArray:
        """Exact points on the plane of the film, mm, shape (N, 2); NaN: the ray is stopped."""
        return trace_ghost(self.bench, self.surfaces, self.rays, self.wavelength_nm)

    @property
    def passed(self) -> BoolArray:
        """Which rays reach the plane of the film, shape (N,)."""
        return np.isfinite(self.points[:, 0])

    @cached_property
    def middle(self) -> FloatArray:
        """A ray in the middle of the rays that pass, shape (4,).

        Raises:
            InputError: No ray passes.
        """
        passing = self.rays[self.passed]
        if not len(passing):
            raise InputError(
                f"{self.bench.lens.name}: ghost {self.surfaces[0]}-{self.surfaces[1]}: "
                f"no light of {self.wavelength_nm:g} nm passes"
            )
        step = np.maximum(_STEP * np.ptp(self.rays[:, :2], axis=0), 1e-12)
        middle = np.round(passing[:, :2].mean(axis=0) / step) * step
        mean = np.concatenate([middle, passing[0, 2:]])
        if np.isfinite(
            trace_ghost(self.bench, self.surfaces, mean[None], self.wavelength_nm)
        ).all():
            return mean
        # The light is a ring or a crescent: its middle is dark.
        return np.asarray(passing[np.argmin(((passing - mean)[:, :2] ** 2).sum(axis=1))])


@guarded
def ghost_rays(
    bench: Bench,
    surfaces: tuple[int, int],
    direction: tuple[float, float, float],
    *,
    rays: int = 4096,
    wavelength_nm: float = DESIGN_WAVELENGTH_NM,
) -> GhostRays:
    """Finds where parallel light enters that becomes a ghost, and traces rays there.

    Args:
        bench: The lens.
        surfaces: Two reflecting surfaces, in either order.
        direction: Direction of the light, x, y, z; z points to the film.
        rays: Rays over the window that holds the light.
        wavelength_nm: Wavelength, nm.

    Raises:
        UsageError: The direction points away from the lens, or a number is out of range.
    """
    side = math.isqrt(whole(rays, "ghost_rays: rays", 1, 1 << 22))
    toward = np.array(numbers(direction, "ghost_rays: direction", 3, "x, y, z"))
    if toward[2] <= 0:
        raise UsageError(f"ghost_rays: direction: wanted z > 0, toward the film, got {direction}")
    toward /= np.linalg.norm(toward)
    pair = surfaces[0], surfaces[1]

    def light(window: FloatArray, across: int) -> GhostRays:
        found = _front_rays(bench, _cells(window, across), toward)
        return GhostRays(bench, pair, float(wavelength_nm), found)

    return light(_window(light), side)


def _window(light: Callable[[FloatArray, int], GhostRays]) -> FloatArray:
    """The part of the front where light enters: low and high corner, shape (2, 2), in -1 .. 1."""
    window, across = np.array([[-1.0, -1.0], [1.0, 1.0]]), _NARROW
    for _ in range(_LOOKS):
        passed = light(window, across).passed
        if passed.sum() < _FEW and across < _WIDE:
            across = _WIDE
            continue
        if not passed.any():
            break
        at, step = _cells(window, across)[passed], (window[1] - window[0]) / across
        closer = np.stack([at.min(axis=0) - step, at.max(axis=0) + step])
        window, across = np.clip(closer, window[0], window[1]), _NARROW
        if passed.mean() > _FULL:
            break
    return window


@guarded
def trace_ghost(
    bench: Bench,
    surfaces: tuple[int, int],
    rays: FloatArray,
    wavelength_nm: float = DESIGN_WAVELENGTH_NM,
) -> FloatArray:
    """Traces rays exactly along the path of a ghost, in double precision.

    Args:
        bench: The lens.
        surfaces: Two reflecting surfaces, in either order.
        rays: Rays (x, y, dx, dy) on the plane z = 0, mm, shape (N, 4).
        wavelength_nm: Wavelength, nm.

    Returns:
        Points on the plane of the film, mm, shape (N, 2); NaN: a mount or the iris, at one of its
        crossings, stops the ray.

    Raises:
        InputError: The surfaces do not exist or cannot reflect.
    """
    check_wavelength(np.array([number(wavelength_nm, "trace_ghost: wavelength_nm")]))
    rays = rows(rays, "trace_ghost: rays", 4)
    dz = np.sqrt(np.maximum(0, 1 - (rays[:, 2:] ** 2).sum(axis=1, keepdims=True)))
    origins = np.hstack([rays[:, :2], np.zeros_like(dz)])
    directions = np.hstack([rays[:, 2:], dz])
    nm = np.full(len(rays), float(wavelength_nm))
    with core_errors(InputError):
        points, out, _, _, _, stopped = _stopped_down(bench).rays(
            origins, directions, nm, True, True, (int(surfaces[0]), int(surfaces[1]))
        )
    with np.errstate(divide="ignore", invalid="ignore"):
        landed = points[:, :2] + ((bench.film_z - points[:, 2:]) / out[:, 2:]) * out[:, :2]
    landed[(stopped >= 0) | ~(out[:, 2] > 0)] = np.nan
    return np.asarray(landed)


def _stopped_down(bench: Bench) -> _core.Prescription:
    """The lens with the iris as the mount of its stop, which rays meet at each crossing."""
    surfaces = list(bench.lens.surfaces)
    k = stop_index(bench)
    surfaces[k] = surfaces[k].replaced(semi_diameter=bench.iris_radius)
    return bench.lens.rebuilt(surfaces).prescription


def stop_index(bench: Bench) -> int:
    """Returns the index of the surface that is the stop."""
    return next(k for k, s in enumerate(bench.lens.surfaces) if s.stop or s.kind == "stop")


def _cells(window: FloatArray, across: int) -> FloatArray:
    """Places in the cells of a window, as many across as down, shape (N, 2)."""
    k = np.arange(across * across)
    cells = np.stack([k % across, k // across], axis=1)
    within = np.modf(np.outer(k + 1, _SHIFTS))[0]
    return np.asarray(window[0] + (cells + within) / across * (window[1] - window[0]))


def _front_rays(bench: Bench, at: FloatArray, toward: FloatArray) -> FloatArray:
    """Parallel rays on the plane z = 0, through places of the front as the light sees it."""
    front = bench.lens.surfaces[0]
    half = front.semi_diameter or max(s.semi_diameter or 0 for s in bench.lens.surfaces)
    if front.radius and math.isfinite(front.radius):
        half = math.hypot(half, min(half, abs(front.radius)))  # as far as its rim may stand out
    across = np.array([toward[2], 0.0, -toward[0]])
    across /= np.linalg.norm(across)
    up = np.cross(toward, across)
    points = half * (at[:, :1] * across + at[:, 1:] * up)
    points -= points[:, 2:] / toward[2] * toward
    return np.hstack([points[:, :2], np.broadcast_to(toward[:2], (len(points), 2))])
