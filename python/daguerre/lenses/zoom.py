"""Sets a zoom to a focal length by interpolating between the positions that its file gives."""

from __future__ import annotations

import dataclasses
import itertools
import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .configurations import Configuration
from .errors import LensError
from .lens import DESIGN_WAVELENGTH_NM, Lens
from .surface import stop_of

#: Focal lengths beyond the range by this share are set to its end: printed lengths are rounded.
TOLERANCE = 0.005
#: Stop and f-number of a position may disagree by this share, as both are rounded.
_AGREES = 0.02
_STEP = 1e-4  # step of numerical derivatives, mm


@dataclass(frozen=True)
class Position:
    """The lens at one configuration focused at infinity; lengths in mm."""

    configuration: Configuration
    gaps: dict[int, float]
    efl: float
    f_number: float | None
    stop: float | None


def positions(lens: Lens) -> list[Position]:
    """Configurations at infinity, from the shortest focal length to the longest."""
    at_infinity = [c for c in lens.configurations if c.at_infinity]
    moving = sorted({i for c in lens.configurations for i in c.gaps})
    found = []
    for c in at_infinity:
        gaps = {i: c.gaps.get(i, _table_gap(lens, i)) for i in moving}
        stop = c.stop_semi_diameter or _table_stop(lens)
        efl = lens.with_gaps(gaps).first_order().efl
        found.append(Position(c, gaps, efl, c.f_number, stop))
    return sorted(found, key=lambda position: position.efl)


def standing_mm(lens: Lens, configuration: Configuration) -> float | None:
    """Focal length of the zoom position to which a configuration belongs; None: not a zoom."""
    if sum(c.at_infinity for c in lens.configurations) < 2:
        return None
    return max(positions(lens), key=lambda p: configuration.like(p.configuration)).efl


@dataclass(frozen=True)
class Zoom:
    """A lens as a zoom, by the positions of its file."""

    lens: Lens

    def range_mm(self) -> tuple[float, float] | None:
        """Shortest and longest focal length; None: not a zoom."""
        if sum(c.at_infinity for c in self.lens.configurations) < 2:
            return None
        ends = positions(self.lens)
        return ends[0].efl, ends[-1].efl

    def at(self, zoom_mm: float) -> Lens:
        """Returns the lens at one focal length, focused at infinity as in its file.

        Between two positions of the file, all moving gaps take the smallest changes that give the
        focal length and keep film and focus between their values at the two positions. So the lens
        is exact at each position of the file.

        Raises:
            LensError: The focal length is outside the lens's range; ``lens-zoom``.
        """
        lens = self.lens
        low, high, share = bracket(lens, zoom_mm)
        if share in (0, 1):
            return _standing(lens, high if share else low, zoom_mm)
        gaps = _between(lens, low, high, zoom_mm)
        f_number = _mix(_opening(lens, low), _opening(lens, high), share)
        moved = lens.with_gaps(gaps)
        stop = _mix(low.stop, high.stop, share)
        if f_number is not None and stop is not None:
            # To first order, the pupil scales with the iris.
            stop *= with_stop(moved, stop).first_order().f_number / f_number
        return _named(with_stop(moved, stop), zoom_mm, f_number)


class Bracket(NamedTuple):
    """Positions on both sides of a focal length.

    Attributes:
        low, high: The positions.
        share: Fraction of the focal length between them.
    """

    low: Position
    high: Position
    share: float


def bracket(lens: Lens, zoom_mm: float) -> Bracket:
    """Finds the positions on both sides of a focal length."""
    found = positions(lens)
    if not found:
        raise LensError(
            f"{lens.source}: zoom: the lens has no configuration that is focused at infinity",
            "lens-zoom",
        )
    short, long = found[0].efl, found[-1].efl
    if not short - TOLERANCE * abs(short) <= zoom_mm <= long + TOLERANCE * abs(long):
        wanted = f"{short:.4g} to {long:.4g} mm"
        if len(found) == 1:
            wanted = f"{short:.4g} mm (this lens is not a zoom)"
        raise LensError(f"{lens.source}: zoom: wanted {wanted}, got {zoom_mm:g} mm", "lens-zoom")
    mm = min(max(zoom_mm, short), long)
    for low, high in itertools.pairwise(found):
        if low.efl <= mm <= high.efl:
            return Bracket(low, high, _share(lens, low, high, mm))
    return Bracket(found[0], found[0], 0.0)


def _share(lens: Lens, low: Position, high: Position, mm: float) -> float:
    """Fraction of a focal length between two positions, by ratios; 0: they are equal."""
    if mm == low.efl:  # if both positions are equal, the first
        return 0.0
    if low.efl <= 0 <= high.efl:
        raise LensError(
            f"{lens.source}: zoom: wanted focal lengths of one sign around {mm:.4g} mm, got "
            f"{low.efl:.4g} and {high.efl:.4g} mm",
            "lens-zoom",
        )
    return math.log(mm / low.efl) / math.log(high.efl / low.efl)


def _opening(lens: Lens, position: Position) -> float | None:
    """F-number of a position: from its stop's size, if the file states another by more than 2 %.

    Zooming away from a position starts from its stop's size, so this f-number does not jump there.
    """
    traced, stated = _traced(lens, position), position.f_number
    return traced if traced and stated and abs(traced / stated - 1) > _AGREES else stated


def _traced(lens: Lens, position: Position) -> float | None:
    """F-number by the size of the stop at a position; None: the file has no size."""
    if position.stop is None:
        return None
    f_number = with_stop(lens.with_gaps(position.gaps), position.stop).first_order().f_number
    return f_number if math.isfinite(f_number) and f_number > 0 else None


def stop_notes(lens: Lens) -> list[str]:
    """Notes on positions of a zoom where stop and stated f-number disagree."""
    if sum(c.at_infinity for c in lens.configurations) < 2:
        return []
    return [
        f"zoom: at {p.efl:.4g} mm the file states f/{p.f_number:.3g}, but the size of its stop is "
        f"f/{traced:.3g}, which is used there and on the way to the next positions"
        for p in positions(lens)
        if p.f_number and (traced := _traced(lens, p)) and _opening(lens, p) != p.f_number
    ]


def with_stop(lens: Lens, semi_diameter: float | None) -> Lens:
    """Returns the lens with another semi-diameter of its open iris, mm."""
    if semi_diameter is None:
        return lens
    i = stop_of(lens.surfaces)
    surfaces = list(lens.surfaces)
    surfaces[i] = surfaces[i].replaced(semi_diameter=semi_diameter)
    return lens.rebuilt(surfaces)


def _standing(lens: Lens, position: Position, zoom_mm: float) -> Lens:
    moved = with_stop(lens.with_gaps(position.gaps), position.stop)
    return _named(moved, zoom_mm, position.f_number)


def _named(lens: Lens, zoom_mm: float, f_number: float | None) -> Lens:
    nominal = dataclasses.replace(
        lens.nominal,
        efl_mm=zoom_mm,
        f_number=f_number or lens.nominal.f_number,
        full_field_deg=None,
    )
    return lens.rebuilt(lens.surfaces, nominal=nominal, zoom_mm=zoom_mm)


def _between(lens: Lens, low: Position, high: Position, zoom_mm: float) -> dict[int, float]:
    """Solves the moving gaps by Newton's method, with the smallest steps that fit."""
    moving = [i for i in low.gaps if low.gaps[i] != high.gaps[i]]
    ends = np.array([[p.gaps[i] for i in moving] for p in (low, high)])
    share = _share(lens, low, high, zoom_mm)
    gaps = ends[0] + share * (ends[1] - ends[0])
    goal = np.array([zoom_mm, 0.0])
    goal[1] = (1 - share) * _state(lens, moving, ends[0])[1]
    goal[1] += share * _state(lens, moving, ends[1])[1]
    for _ in range(40):
        miss = _state(lens, moving, gaps) - goal
        if np.abs(miss).max() < 1e-10 * zoom_mm:
            break
        gaps = gaps - np.linalg.pinv(_slopes(lens, moving, gaps)) @ miss
        gaps = np.maximum(gaps, 0.0)
    else:
        raise LensError(
            f"{lens.source}: zoom: no path from {low.efl:.4g} to {high.efl:.4g} mm keeps the "
            f"focus at {zoom_mm:g} mm",
            "lens-zoom",
        )
    return {**low.gaps, **dict(zip(moving, (float(g) for g in gaps), strict=True))}


def _state(lens: Lens, moving: list[int], gaps: NDArray[np.float64]) -> NDArray[np.float64]:
    """Focal length, and distance of the paraxial focus behind the film, mm."""
    moved = lens.with_gaps(dict(zip(moving, (float(g) for g in gaps), strict=True)))
    order = moved.prescription.first_order(DESIGN_WAVELENGTH_NM)
    return np.array([order.efl, order.bfl - (moved.surfaces[-1].thickness or 0.0)])


def _slopes(lens: Lens, moving: list[int], gaps: NDArray[np.float64]) -> NDArray[np.float64]:
    """Derivatives of ``_state`` by differences, shape (2, gaps)."""
    columns = []
    for i in range(len(moving)):
        ahead, behind = gaps.copy(), gaps.copy()
        ahead[i] += _STEP
        behind[i] = max(behind[i] - _STEP, 0.0)
        change = _state(lens, moving, ahead) - _state(lens, moving, behind)
        columns.append(change / (ahead[i] - behind[i]))
    return np.stack(columns, axis=1)


def _mix(low: float | None, high: float | None, share: float) -> float | None:
    return None if low is None or high is None else (1 - share) * low + share * high


def _table_gap(lens: Lens, i: int) -> float:
    return float(lens.data["surfaces"][i].get("thickness") or 0.0)


def _table_stop(lens: Lens) -> float | None:
    i = stop_of(lens.surfaces)
    size = lens.data["surfaces"][i].get("semi_diameter")
    return None if size is None else float(size)
