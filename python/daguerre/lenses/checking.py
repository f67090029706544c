"""Checks that a lens can be built and lets light through; for shipped and imported lenses alike.

Surfaces that cross within the axial beam are an error. Where surfaces cross only near the rim, the
element ends there, and its clear diameters are cut. Patent tables let surfaces touch just within
the widest beam (none of a hundred below 0.97 of the radius), which is taken for rounding.
"""

from __future__ import annotations

import itertools
import math

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core

from .errors import LensError, reported
from .image_circle import stated_half_image
from .lens import DESIGN_WAVELENGTH_NM, Lens
from .sag import sag
from .surface import LensSurface, bounding

#: Surfaces that touch at the rim by this much (mm) are a patent's rounding.
TOUCH = 2e-3
#: A crossing at this share of the axial beam's radius, or farther out, is rounding, too.
ROUNDING = 0.9
#: If a smaller share of the axial beam passes, the lens is slower than its stop allows.
ENOUGH_LIGHT = 0.6
#: One of so many draws of each point of the film comes first: most points need no more.
_EACH = 9
_RADII = 129
#: Rays by their share of the entrance pupil's radius, to find a ray that passes, and the widest.
_TRACED = (1.0, 0.97, 0.9, 0.8, 0.65, 0.5, 0.25, 0.1)
_PASSING = tuple(round(1 - 0.02 * k, 2) for k in range(50))
#: A frame may exceed the stated image circle by this factor.
SPILL = 1.01


def checked(lens: Lens) -> Lens:
    """Returns the lens with clear diameters cut where surfaces cross, and notes on the cuts.

    Raises:
        LensError: The lens has no focal length, surfaces cross within the axial beam, or no light
            passes; with the index of the surface.
    """
    order = lens.first_order()
    if not all(map(math.isfinite, (order.efl, order.bfl))):
        raise LensError(
            f"{lens.source}: the focal length must be finite, got {order.efl}", "lens-afocal"
        )
    if lens.nominal.f_number and not math.isfinite(order.stop_semi_diameter):
        raise LensError(
            f"{lens.source}: nominal.f_number: wanted a finite stop, got f/{order.f_number:g}",
            "lens-f-stop",
        )
    surfaces, notes = list(lens.surfaces), list(lens.notes)
    for i, j, at, inner in _crossings(lens):
        end = max(at, inner)
        notes.append(
            f"surfaces {i} and {j}{in_file(lens, i, j)} cross {at:.4g} mm off the axis: clear "
            f"radii are cut to {end:.4g} mm"
        )
        for k in (i, j):
            semi = surfaces[k].semi_diameter
            surfaces[k] = surfaces[k].replaced(semi_diameter=min(end, semi or end))
    notes += _check_light(lens)
    if list(lens.notes) == notes:
        return lens
    with reported(lens.source):
        return lens.rebuilt(surfaces, notes=tuple(notes))


def _crossings(lens: Lens) -> list[tuple[int, int, float, float]]:
    """Pairs of surfaces that cross: where, and the axial beam's radius there, mm.

    Raises:
        LensError: Surfaces cross within the beam that the clear diameters pass; the message names
            the pair that crosses deepest in it.
    """
    beam, passing = _beam(lens, within=False), None
    found, faults = [], []
    for i, j in _neighbors(list(lens.surfaces)):
        at = _crossing(lens, i, j, beam)
        if at is None:
            continue
        inner = float(min(beam[i], beam[j]))
        if at < ROUNDING * inner:  # the stop may be wider than the diameters let it be
            passing = _beam(lens, within=True) if passing is None else passing
            inner = float(min(passing[i], passing[j]))
        found.append((i, j, at, inner))
        if at < ROUNDING * inner:
            faults.append((at / inner, i, j, at, inner))
    if faults:
        _, i, j, at, inner = min(faults)
        raise LensError(
            f"{lens.source}: surfaces {i} and {j}{in_file(lens, i, j)}: edge: surfaces cross "
            f"{at:.4g} mm off the axis, within the axial beam (radius {inner:.4g} mm)",
            "lens-edge",
            i,
        )
    return found


def in_file(lens: Lens, *indices: int) -> str:
    """Surface numbers as the imported file counts them, in parentheses."""
    rows = lens.data.get("surfaces", [])
    numbers = [rows[i].get("from") for i in indices if i < len(rows)]
    if any(n is None for n in numbers):
        return ""
    return f" (in the file: {' and '.join(str(n) for n in numbers)})"


def _neighbors(surfaces: list[LensSurface]) -> list[tuple[int, int]]:
    """Pairs of surfaces that bound one element or one air gap; planes in air bound neither."""
    placed = {i for i, s in enumerate(surfaces) if any(s.decenter) or any(s.tilt)}
    solid = [i for i in bounding(surfaces) if i not in placed]
    return [(i, j) for i, j in itertools.pairwise(solid) if not placed & set(range(i, j + 1))]


def _crossing(lens: Lens, i: int, j: int, beam: NDArray[np.float64]) -> float | None:
    """Distance from the axis (mm) at which two surfaces cross, or None."""
    a, b = lens.surfaces[i], lens.surfaces[j]
    gap = float(lens.vertices[j] - lens.vertices[i])
    known = [s for s in (a.semi_diameter_after, a.semi_diameter, b.semi_diameter) if s is not None]
    reach = max(min([*known, math.inf]), min(beam[i], beam[j]))
    if not math.isfinite(reach):
        reach = min(beam[i], beam[j])
    r = np.linspace(0, reach, _RADII)
    nearest = math.inf
    round_form = all(s.kind not in ("biconic", "toroid", "cyl-x", "cyl-y") for s in (a, b))
    for angle in (0.0,) if round_form else (0.0, 45.0, 90.0):
        x, y = r * math.cos(math.radians(angle)), r * math.sin(math.radians(angle))
        left = gap + sag(b, x, y) - sag(a, x, y)
        below = np.flatnonzero(left < -TOUCH)
        if below.size:
            k = int(below[0])
            share = (left[k - 1] / (left[k - 1] - left[k])) if k else 0.0
            first = r[k - 1] + share * (r[k] - r[k - 1]) if k else 0.0
            nearest = min(nearest, float(first))
    return nearest if nearest < math.inf else None


def _beam(lens: Lens, *, within: bool) -> NDArray[np.float64]:
    """Radius of the axial beam at each surface, mm, shape (surfaces,).

    Args:
        lens: The lens.
        within: Whether to bound it by the diameters that the file states, which may pass less than
            the stop.
    """
    order = lens.first_order()
    radius = 0.5 * order.entrance_pupil.diameter
    out = np.zeros(len(lens.surfaces))
    if not math.isfinite(radius) or not math.isfinite(order.entrance_pupil.z):
        return out
    sizes = [
        math.inf if s.semi_diameter is None or s.derived else s.semi_diameter for s in lens.surfaces
    ]
    for share in _PASSING if within else _TRACED:
        origin, direction = ray_to_pupil(lens, order.entrance_pupil.z, 0.0, share * radius)
        path = lens.prescription.path(origin[None], direction[None], DESIGN_WAVELENGTH_NM, False)
        if len(path) != len(out):
            continue
        heights = np.asarray(np.hypot(path[:, 0], path[:, 1]), np.float64)
        if not within or (heights <= sizes).all():
            return heights
    return out


def ray_to_pupil(
    lens: Lens, pupil_z: float, x: float, y: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Ray from the object on the axis to a point of the entrance pupil."""
    start = -(50.0 + abs(pupil_z) + 10 * math.hypot(x, y))
    configuration = lens.configurations[0] if lens.configurations else None
    distance = configuration.object_distance_mm if configuration else None
    if distance is None:
        return np.array([x, y, start]), np.array([0.0, 0.0, 1.0])
    direction = np.array([x, y, pupil_z + distance])
    return np.array([0.0, 0.0, -distance]), direction / np.linalg.norm(direction)


def _check_light(lens: Lens) -> list[str]:
    """Raises an error if no ray of the axial beam reaches the film; returns a note if few do."""
    order = lens.first_order()
    radius = 0.5 * order.entrance_pupil.diameter
    if not math.isfinite(radius) or radius <= 0 or not math.isfinite(order.entrance_pupil.z):
        return []
    share = (np.arange(9) - 4) / 4.5
    rays = [
        ray_to_pupil(lens, order.entrance_pupil.z, radius * x, radius * y)
        for x in share
        for y in share
        if x * x + y * y <= 1
    ]
    origins, directions = (np.ascontiguousarray(part) for part in zip(*rays, strict=True))
    nm = np.full(len(rays), DESIGN_WAVELENGTH_NM)
    stopped = lens.prescription.rays(origins, directions, nm, True)[-1]
    passed = float((stopped < 0).mean())
    if passed > 0:
        if passed >= ENOUGH_LIGHT or not lens.prescription.is_axially_symmetric:
            return []  # this beam is too wide in one direction for an anamorphic pupil
        return [
            f"clear diameters pass {100 * passed:.0f} % of the axial beam: the lens is slower than "
            f"the f/{order.f_number:.3g} of its open stop"
        ]
    worst = int(np.bincount(stopped).argmax())
    raise LensError(
        f"{lens.source}: surface {worst}{in_file(lens, worst)}: wanted rays of the axial beam "
        f"to pass, got {np.count_nonzero(stopped == worst)} of {len(rays)} stopped there",
        "lens-no-light",
        worst,
    )


def frame_notes(
    exact: _core.ExactLens,
    lens: Lens,
    frame_mm: tuple[float, float],
    shift_mm: tuple[float, float],
) -> list[str]:
    """Returns a note on a frame outside the image circle, real or stated; empty if all is inside.

    Raises:
        LensError: The whole frame lies outside.
    """
    count, draws = 33, 36
    x, y = (
        s + size * ((np.arange(count) + 0.5) / count - 0.5)
        for s, size in zip(shift_mm, frame_mm, strict=True)
    )
    film = np.stack(np.meshgrid(x, y), -1).reshape(-1, 2)
    lit = _lit(exact, film, draws)
    frame = f"{frame_mm[0]:g} x {frame_mm[1]:g} mm"
    if not lit.any():
        raise LensError(
            f"{lens.source}: frame: all of {frame} is outside the image circle (is the shift "
            f"too large?)",
            "lens-no-light",
        )
    if lit.all():
        return _beyond_stated(lens, frame_mm, frame)
    circle = 2 * float(np.hypot(*film[lit].T).max())
    return [
        f"the image circle of {lens.name} is about {circle:.2g} mm across: "
        f"{100 * (1 - lit.mean()):.2g} % of the frame of {frame} stays dark"
    ]


def _beyond_stated(lens: Lens, frame_mm: tuple[float, float], frame: str) -> list[str]:
    """Note on a frame that is lit, but larger than the image circle that the source states."""
    half = stated_half_image(lens, lens.first_order())
    if half is None or math.hypot(*frame_mm) <= SPILL * 2 * half:
        return []
    return [
        f"the frame of {frame} is larger than the image circle of {lens.name}, "
        f"{2 * half:.3g} mm across"
    ]


def _lit(exact: _core.ExactLens, film: NDArray[np.float64], draws: int) -> NDArray[np.bool_]:
    """Whether light reaches points of the film (N, 2), mm; few need more than the first draws."""
    side = round(math.sqrt(draws))
    grid = (np.stack(np.meshgrid(*[np.arange(side)] * 2), -1).reshape(-1, 2) + 0.5) / side
    lit = np.zeros(len(film), np.bool_)
    for u in (grid[::_EACH], grid):
        lit[~lit] = _any_lit(exact, film[~lit], u)
    return lit


def _any_lit(
    exact: _core.ExactLens, film: NDArray[np.float64], u: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """Whether light reaches points of the film (N, 2), mm, by one of the draws (M, 2)."""
    points = np.repeat(film, len(u), axis=0).astype(np.float32)
    draws = np.tile(u, (len(film), 1)).astype(np.float32)
    nm = np.full(len(points), 550, np.float32)
    weights = np.asarray(exact.generate(points, draws, nm)[2]).reshape(len(film), len(u))
    return np.asarray((weights > 0).any(axis=1))
