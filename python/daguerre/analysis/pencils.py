"""Pencils: all the light of one object point that reaches the film, and rays through it."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from daguerre.argument_checks import guarded
from daguerre.checks import rows
from daguerre.errors import InputError
from daguerre.files.value import BriefRecord
from daguerre.lenses.lens import DESIGN_WAVELENGTH_NM

from .bench import Bench, FloatArray, Rays
from .chief import chief_rays
from .plotted import Sectioned

COARSE = 41  # rays across, in the search for the light's bounds
FLAT_FIELD = math.radians(75)  # beyond it object points lie on a sphere, not on a plane


@guarded
@dataclass(frozen=True, repr=False)
class Pencil(BriefRecord, Sectioned):
    """Rays from one object point through a window in front of the lens.

    The window is normal to the chief ray, at ``center``, with the axes ``sagittal`` and
    ``tangential``. It bounds the light that passes tightly.

    Attributes:
        bench: The lens.
        film: Film point of the chief ray, mm, shape (2,).
        angle: Angle of the chief ray in front of the lens, rad.
        source: Object point, mm, shape (3,); None: infinitely far.
        direction: Unit vector of the chief ray, shape (3,).
        low, high: Bounds of the window along its axes, mm, shape (2,).
        radial: Unit vector on the film in the direction of the field, shape (2,).
    """

    bench: Bench
    film: FloatArray
    angle: float
    source: FloatArray | None
    center: FloatArray
    direction: FloatArray
    sagittal: FloatArray
    tangential: FloatArray
    low: FloatArray
    high: FloatArray
    radial: FloatArray

    def trace(
        self, at: FloatArray, wavelength_nm: float = DESIGN_WAVELENGTH_NM, *, clip: bool = True
    ) -> Rays:
        """Traces rays through window coordinates (N, 2), mm."""
        at = rows(at, "trace: at", 2)
        through = self.center + at[:, :1] * self.sagittal + at[:, 1:] * self.tangential
        if self.source is None:
            length = 20.0 * (1 + abs(float(self.bench.lens.vertices[-1])))
            directions = np.broadcast_to(self.direction, through.shape)
            return self.bench.rays(
                through - length * directions, directions, wavelength_nm, clip=clip
            )
        directions = through - self.source
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
        origins = np.broadcast_to(self.source, through.shape)
        return self.bench.rays(origins, directions, wavelength_nm, clip=clip)

    def grid(self, count: int) -> FloatArray:
        """Centres of count x count equal cells of the window, shape (count^2, 2), mm."""
        u = (np.arange(count) + 0.5) / count
        x, y = (self.low[k] + (self.high[k] - self.low[k]) * u for k in range(2))
        return np.stack(np.meshgrid(x, y), -1).reshape(-1, 2)

    def flux(self, at: FloatArray) -> FloatArray:
        """Light through equal cells of the window, 1 at ``center``, shape (N,)."""
        at = rows(at, "flux: at", 2)
        if self.source is None:
            return np.ones(len(at))
        distance2 = float(((self.center - self.source) ** 2).sum())
        return np.asarray((distance2 / (distance2 + (at**2).sum(axis=1))) ** 1.5)

    def on_film(self, points: FloatArray) -> FloatArray:
        """Film points (N, 2) relative to the chief ray's, on the sagittal and tangential axes."""
        off = rows(points, "on_film: points", 2) - self.film
        r = self.radial
        return np.column_stack([off @ [r[1], -r[0]], off @ r])


@guarded
def pencil(
    bench: Bench,
    film_mm: float | tuple[float, float] = 0.0,
    *,
    distance_mm: float | None = None,
) -> Pencil | None:
    """Finds the light of the object point with its chief ray through a film point.

    Args:
        bench: The lens.
        film_mm: Image height along y, or film point (x, y), mm.
        distance_mm: Distance of the object point's plane from the entrance pupil, along the axis,
            mm; beyond 75 degrees from the axis, the point's own distance. None: the focus distance.

    Returns:
        The pencil, or None if none of its light arrives.

    Raises:
        InputError: The distance is not positive.
    """
    film = np.array([0.0, film_mm] if np.isscalar(film_mm) else film_mm, np.float64)
    distance = bench.focus_mm if distance_mm is None else distance_mm
    wide = unbounded(bench, film, distance)
    return None if wide is None else _bounded(wide)


def unbounded(bench: Bench, film: FloatArray, distance_mm: float) -> Pencil | None:
    """Pencil of a film point (2,) with its chief ray and axes, but not yet bounds of its light."""
    if not distance_mm > 0:
        raise InputError(f"distance: wanted more than 0, got {distance_mm / 1e3:g} m")
    chief = chief_rays(bench, film[None, :])
    if not np.isfinite(chief.directions).all():
        return None
    direction, center = chief.directions[0], chief.points[0]
    size = float(np.hypot(*film))
    radial = film / size if size > 0 else np.array([0.0, 1.0])
    sagittal = np.array([radial[1], -radial[0], 0.0])
    return Pencil(
        bench=bench,
        film=film,
        angle=float(chief.angles[0]),
        source=_source(bench, center, direction, distance_mm),
        center=center,
        direction=direction,
        sagittal=sagittal,
        tangential=np.cross(direction, sagittal),
        low=np.zeros(2),
        high=np.zeros(2),
        radial=radial,
    )


def _source(
    bench: Bench, on_lens: FloatArray, direction: FloatArray, distance: float
) -> FloatArray | None:
    """Point of the chief ray at a distance: on a plane, or for wide fields on a sphere."""
    if math.isinf(distance):
        return None
    pupil = np.array([0.0, 0.0, bench.order.entrance_pupil.z])
    if direction[2] > math.cos(FLAT_FIELD):
        return np.asarray(on_lens - direction * ((on_lens[2] - pupil[2] + distance) / direction[2]))
    off = on_lens - pupil
    along = float(off @ direction)
    return np.asarray(on_lens - direction * (along + math.sqrt(along**2 - off @ off + distance**2)))


def _bounded(wide: Pencil) -> Pencil | None:
    """Returns the pencil with bounds around the light that passes; None: no light passes."""
    bench, delta = wide.bench, 1e-3 * wide.bench.pupil_diameter
    probes = wide.trace(np.array([[0, 0], [delta, 0], [0, delta]]), clip=False)
    scale = np.array([bench.iris_radius, bench.iris_radius])
    if probes.passed.all():
        # Map from the window to the iris, close to the chief ray.
        jacobian = (probes.iris[1:] - probes.iris[0]).T / delta
        inverse = np.linalg.inv(jacobian) if abs(np.linalg.det(jacobian)) > 1e-9 else np.eye(2)
        scale = bench.iris_radius * np.linalg.norm(inverse, axis=1)
    low, high = -1.4 * scale, 1.4 * scale
    for _ in range(6):
        box = replace(wide, low=low, high=high)
        seen = box.grid(COARSE)[box.trace(box.grid(COARSE)).passed]
        cell = (high - low) / COARSE
        if len(seen) == 0:
            low, high = 1.7 * low, 1.7 * high
            continue
        touches = (seen.min(axis=0) < low + cell) | (seen.max(axis=0) > high - cell)
        new_low, new_high = seen.min(axis=0) - cell, seen.max(axis=0) + cell
        tight = (new_high - new_low) > 0.7 * (high - low)
        spread = 0.6 * (high - low)
        low = np.where(touches, low - spread, new_low)
        high = np.where(touches, high + spread, new_high)
        if tight.all() and not touches.any():
            return replace(wide, low=low, high=high)
    return replace(wide, low=low, high=high) if len(seen) else None
