"""Measures the row time of a rolling shutter from the skew of edges in pictures while panning."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daguerre.argument_checks import guarded
from daguerre.camera.projection import Projection
from daguerre.checks import number, numbers, short, to_numbers
from daguerre.errors import InputError, UsageError

from .measure import plane

FloatArray = NDArray[np.float64]
BEND = 3  # of the curve that an edge follows where distortion bends it
CONTRAST = 0.6  # least share of the median contrast; lines with less are where squares meet
NARROWEST, WIDTHS = 3.0, 2.5  # width of the window: px, and standard deviations of the edge
TIMES = 6  # iterations of the search for an edge
OUTLIER = 5.0  # median distances from the fit, above which a line is left out
REST = 1e-9  # radians between pictures; less is rounding
LEAST = 8  # lines that see the edge
SURE = 3.0  # standard errors above which lines are told to be exposed in turn


@guarded
@dataclass(frozen=True)
class RowTime:
    """Timing of the lines of a rolling shutter.

    Attributes:
        line_time: Time from one line to the next, s.
        readout_time: Time for all lines of the picture, s.
        scan_order: Side of the picture that is read first: ``top``, ``bottom``, ``left`` or
            ``right``; ``none``: no measurable delay.
        turn_rate: Turn rate of the camera, degrees per second, positive to the right or up.
        error: Standard error of ``line_time`` from the fit, s.
    """

    line_time: float
    readout_time: float
    scan_order: str
    turn_rate: float
    error: float


@guarded(but=("corner",))
def row_time(
    regions: ArrayLike,
    projection: Projection,
    *,
    turn_rate: float | None = None,
    fps: float | None = None,
    corner: tuple[int, int] = (0, 0),
    still: ArrayLike | None = None,
) -> RowTime:
    """Measures the time from one line of pixels to the next in pictures of a turning camera.

    A vertical edge while the camera pans measures shutters that scan from the top or bottom; a
    horizontal edge while it tilts those from the left or right. Each line of pixels sees the edge
    in its direction at the line's exposure. So pictures must not be undistorted, which would move
    pixels to other lines.

    Args:
        regions: Linear light, shape (H, W), or (K, H, W) for K successive pictures, each with one
            edge along its longer side, from end to end. Checkerboards are suitable: dark and light
            may change sides along the edge.
        projection: Projection of the whole picture, in its size.
        turn_rate: Turn rate of the camera, degrees per second, positive to the right or up; either
            this or ``fps``.
        fps: Pictures per second, for two or more pictures with a constant, unknown turn rate.
        corner: First column and row of the region in the picture.
        still: Same region of a picture without motion, if the edge is not along the axis of the
            turn; None: it is.

    Raises:
        UsageError: Neither or both of ``turn_rate`` and ``fps``, or a number is out of range.
        InputError: There is no such edge, or the camera did not turn.
    """
    if (turn_rate is None) == (fps is None):
        got = "neither" if fps is None else "both"
        raise UsageError(f"row time: wanted either turn_rate or fps, got {got}")
    shots = _shots(regions)
    view = _View.of(projection, shots, corner)
    line = None if still is None else view.line_at_rest(still)
    seen = [view.turned(shot, line) for shot in shots]
    lines, turned = (np.concatenate(parts) for parts in zip(*seen, strict=True))
    shot = np.repeat(np.arange(len(seen)), [len(part) for part, _ in seen])
    if turn_rate is not None:
        rate = math.radians(number(turn_rate, "row time: turn_rate", -1e6, 1e6))
        if rate == 0:
            raise UsageError(
                "row time: turn_rate: wanted a rate other than 0 degrees per second, got 0"
            )
        (*_, lean), (*_, error) = _fit(np.eye(len(shots))[shot], lines, turned)
        return view.told(lean / rate, error / abs(rate), rate)
    interval = 1 / number(fps, "row time: fps", 1e-6, 1e9)
    if len(shots) < 2:
        raise UsageError("row time: fps: wanted at least two pictures, got one")
    steps = np.column_stack([np.ones(len(shot)), shot.astype(np.float64)])
    (_, step, lean), (_, step_error, lean_error) = _fit(steps, lines, turned)
    if abs(step) <= max(SURE * step_error, REST):
        raise InputError("row time: wanted an edge that moves between pictures, got one at rest")
    time = lean / step * interval
    error = math.hypot(lean_error, lean / step * step_error) / abs(step) * interval
    return view.told(time, error, step / interval)


@dataclass(frozen=True)
class _View:
    """Region of a picture, with its lines of pixels across the edge.

    With an upright edge they are rows, and the camera turns right; with a level one they are
    columns, and it turns up.
    """

    projection: Projection
    corner: tuple[int, int]
    shape: tuple[int, int]

    @classmethod
    def of(cls, projection: Projection, shots: FloatArray, corner: tuple[int, int]) -> _View:
        if not isinstance(projection, Projection):
            raise UsageError(f"row time: projection: wanted a Projection, got {short(projection)}")
        x, y = numbers(corner, "row time: corner", 2, "a column and a row")
        (height, width), size = shots.shape[1:], projection.size
        if min(x, y) < 0 or x % 1 or y % 1 or x + width > size[0] or y + height > size[1]:
            raise UsageError(
                f"row time: corner: wanted whole pixels and a region of {width} x {height} px "
                f"inside the projection's picture of {size[0]} x {size[1]}; got {x:g}, {y:g}"
            )
        return cls(projection, (int(x), int(y)), (height, width))

    @property
    def is_upright(self) -> bool:
        """Whether the edge is upright."""
        return self.shape[0] >= self.shape[1]

    def turned(self, shot: FloatArray, line: FloatArray | None) -> tuple[FloatArray, FloatArray]:
        """Returns the lines that see the edge, and the camera's angle at their times, radians.

        ``line`` is the edge's plane at rest; None: the edge lies along the axis of the turn, and
        angles have an unknown constant offset.
        """
        lines, (side, along, ahead) = self._edge(shot)
        angle = np.arctan2(side, ahead)
        if line is not None:
            angle = angle - _angle_at_rest(line, along / np.hypot(side, ahead), angle)
        return lines, -angle if self.is_upright else angle  # y is down

    def line_at_rest(self, still: ArrayLike) -> FloatArray:
        """Returns the unit normal of the plane through the camera and the edge."""
        light = plane(still, "row time: still", LEAST)
        if light.shape != self.shape:
            raise InputError(
                f"row time: still: wanted the shape of the regions, {self.shape}, got {light.shape}"
            )
        _, directions = self._edge(light)
        return np.asarray(np.linalg.svd(directions.T)[2][2])

    def told(self, signed: float, error: float, rate: float) -> RowTime:
        """Returns the result; the sign of the time gives the order of the lines."""
        time = abs(float(signed))
        first, last = ("top", "bottom") if self.is_upright else ("left", "right")
        order = "none" if time <= SURE * error else first if signed > 0 else last
        lines = self.projection.size[1 if self.is_upright else 0]
        return RowTime(time, time * lines, order, math.degrees(rate), float(error))

    def _edge(self, shot: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Returns lines that see the edge, and directions to it: in the turn, its axis, ahead."""
        light = shot if self.is_upright else shot.T
        lines, place = _follow(light)
        pixels = np.column_stack([place, lines] if self.is_upright else [lines, place])
        seen = self.projection.unproject(pixels + self.corner)
        if not np.isfinite(seen).all():
            raise InputError("row time: wanted an edge in view of the projection, got one outside")
        order = (0, 1, 2) if self.is_upright else (1, 0, 2)
        return lines.astype(np.float64), seen.T[list(order)]


def _follow(light: FloatArray) -> tuple[NDArray[np.int_], FloatArray]:
    """Returns rows that see the edge, and its position: centre of its slope, near a curve.

    The window narrows to the edge's width, which leaves out noise on both sides.
    """
    slope, rows = np.diff(light, axis=1), np.arange(len(light))
    at = np.arange(slope.shape[1]) + 0.5
    away, width = np.zeros_like(slope), slope.shape[1] / 4
    for _ in range(TIMES):
        weights = slope * np.exp(-0.5 * (away / width) ** 4)
        contrast = weights.sum(axis=1)
        known = np.abs(contrast) > CONTRAST * np.median(np.abs(contrast))
        if known.sum() < LEAST:
            raise InputError(
                f"row time: wanted an edge in {LEAST} lines of pixels or more, got {known.sum()}"
            )
        weights = weights[known] / contrast[known, None]
        place = weights @ at
        away = at - np.polyval(np.polyfit(rows[known], place, BEND), rows)[:, None]
        spread = float(np.median((weights * away[known] ** 2).sum(axis=1)))
        width = max(NARROWEST, width / 2, WIDTHS * math.sqrt(max(spread, 0.0)))
    return rows[known], place


def _angle_at_rest(normal: FloatArray, height: FloatArray, near: FloatArray) -> FloatArray:
    """Angles of a line in a plane, by height above the horizon of the turn, radians.

    n . (sin a, h, cos a) = 0 has two solutions; the one closer to ``near`` is taken.
    """
    side, along, ahead = normal
    middle = math.atan2(side, ahead)
    away = np.arccos(np.clip(-along * height / math.hypot(side, ahead), -1, 1))
    both = np.stack([middle + away, middle - away])
    both += 2 * math.pi * np.round((near - both) / (2 * math.pi))
    return np.asarray(np.take_along_axis(both, np.abs(both - near).argmin(axis=0)[None], 0)[0])


def _fit(
    shifts: FloatArray, lines: FloatArray, turned: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Fits angles by shifts and lines (least squares); returns coefficients, standard errors.

    Outliers are left out, such as lines on which squares of a board meet.
    """
    basis, kept = np.column_stack([shifts, lines]), np.ones(len(lines), bool)
    for _ in range(TIMES):
        found, *_ = np.linalg.lstsq(basis[kept], turned[kept], rcond=None)
        left = np.abs(turned - basis @ found)
        used, kept = kept, left <= OUTLIER * np.median(left)
    variance = (left[used] @ left[used]) / max(used.sum() - basis.shape[1], 1)
    covariance = np.linalg.inv(basis[used].T @ basis[used]) * variance
    return np.asarray(found), np.asarray(np.sqrt(np.diag(covariance)))


def _shots(regions: ArrayLike) -> FloatArray:
    given = to_numbers(regions, "row time", "regions", "shape (H, W) or (K, H, W)")
    if given.ndim not in (2, 3) or given.shape[0] == 0:
        raise InputError(f"row time: regions: wanted shape (H, W) or (K, H, W), got {given.shape}")
    shots = given[None] if given.ndim == 2 else given
    return np.stack([plane(shot, "row time: regions", LEAST) for shot in shots])
