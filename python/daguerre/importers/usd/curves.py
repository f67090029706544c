"""Reads BasisCurves as round curves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import Usd, UsdGeom

from daguerre.errors import InputError
from daguerre.files.notes import Notes
from daguerre.motion.values import Dynamic, is_dynamic
from daguerre.motion.values import at as value_at
from daguerre.scene.curve_bases import fitting_counts
from daguerre.scene.over_time.points import ChosenOverTime
from daguerre.scene.over_time.surfaces import Array
from daguerre.scene.scene import Scene

from .points import read_points
from .primvars import note_length, read_primvar
from .spheres import read_widths
from .values import Clock

Counts = NDArray[np.int64]
_TOO_FEW = "a curve with a number of points that does not fit its basis is shortened or left out"
_BASES = {"bezier": "bezier", "bspline": "bspline", "catmullRom": "catmull-rom"}


@dataclass(frozen=True, eq=False)
class Layout:
    """How the points of a prim form its curves.

    Attributes:
        counts: Points of each curve, shape (C,).
        basis: linear, bezier, bspline or catmull-rom.
        wrap: nonperiodic, periodic or pinned.
    """

    counts: Counts
    basis: str
    wrap: str

    def spread(self, values: Array, interpolation: str) -> Array | None:
        """Values of a primvar by curve or by point; None if they do not fit.

        Varying values of cubic curves are at the ends of segments, and are interpolated between.
        """
        curves, points = len(self.counts), int(self.counts.sum())
        if interpolation == "constant" and len(values) == 1:
            return np.repeat(values, curves, axis=0)
        if interpolation == "uniform" and len(values) == curves:
            return values
        if interpolation in ("vertex", "varying") and len(values) == points:
            return values
        return self._between(values) if interpolation == "varying" else None

    def fitting(self) -> Counts:
        """Points of each curve that its basis uses, shape (C,); 0: they are too few."""
        return fitting_counts(self.counts, self.basis, self.wrap)

    def cut(
        self, points: Array | Dynamic, given: dict[str, Array]
    ) -> tuple[Array | Dynamic, Counts, dict[str, Array]]:
        """Points, counts, and values by curve or by point, without points that the basis skips."""
        fits, total = self.fitting(), int(self.counts.sum())
        starts = np.cumsum(self.counts) - self.counts
        place = np.arange(total) - np.repeat(starts, self.counts)
        rows, curves = np.flatnonzero(place < np.repeat(fits, self.counts)), fits > 0
        valid = {
            name: values[rows] if len(values) == total else values[curves]
            for name, values in given.items()
        }
        moving = is_dynamic(points)
        chosen = ChosenOverTime(points, rows) if moving else points[rows]  # type: ignore[arg-type,index]
        return chosen, fits[curves], valid

    def _between(self, values: Array) -> Array | None:
        knots = [self._knots(int(count)) for count in self.counts]
        if sum(map(len, knots)) != len(values):
            return None
        made, start = [], 0
        for count, at in zip(self.counts, knots, strict=True):
            rows = values[start : start + len(at)]
            start += len(at)
            each = np.arange(int(count))
            made.append(
                np.stack([np.interp(each, at, rows[:, k]) for k in range(rows.shape[1])], 1)
            )
        return np.concatenate(made).astype(np.float32)

    def _knots(self, count: int) -> Counts:
        """Points, counted from 0, at which the segments of a curve begin and end."""
        if self.basis == "linear" or self.wrap == "pinned":
            return np.arange(count)
        if self.basis == "bezier":
            return np.arange(0, count + (self.wrap == "nonperiodic"), 3)
        return np.arange(count) if self.wrap == "periodic" else np.arange(1, max(count - 1, 1))


def read_curves(
    prim: Usd.Prim, scene: Scene, clock: Clock, notes: Notes, *, colored: bool
) -> int | None:
    """Adds the curves of a prim; returns the index of the mesh, or None if there are none.

    Args:
        prim: The prim.
        scene: Receives the curves.
        clock: Time codes of the stage.
        notes: Receives notes on unsupported content.
        colored: Whether ``displayColor`` colours the curves.

    Raises:
        InputError: Counts, points or widths do not fit together.
    """
    schema = UsdGeom.BasisCurves(prim)
    where = f"{clock.file}: {prim.GetPath()}"
    points = read_points(schema, clock, notes)
    now: Array = value_at(points, clock.time)
    counts = clock.integers(schema.GetCurveVertexCountsAttr())
    if not len(counts) or not len(now):
        return None
    if counts.min() < 0 or int(counts.sum()) != len(now):
        raise InputError(
            f"{where}.curveVertexCounts: wanted a sum of {len(now)}, the number of points, "
            f"got {int(counts.sum())}"
        )
    layout = Layout(counts, _basis(schema, clock, notes), str(schema.GetWrapAttr().Get(clock.code)))
    fits = layout.fitting()
    if not fits.any():
        notes.add(_TOO_FEW, len(fits))
        return None
    if schema.GetNormalsAttr().HasAuthoredValue():
        notes.add("ribbons of curves are drawn as round curves")
    given: dict[str, Any] = {
        name: found
        for name, found in (
            ("uv", _values(prim, "st", 2, layout, clock, notes)),
            ("colors", _values(prim, "displayColor", 3, layout, clock, notes)),
        )
        if found is not None and len(found) and (colored or name == "uv")
    }
    if "uv" in given:
        given["uv"] = (given["uv"] * (1, -1) + (0, 1)).astype(np.float32)
    given["widths"] = _widths(schema, layout, len(now), clock, notes)
    cut = (fits != counts) | (fits == 0)
    if cut.any():
        notes.add(_TOO_FEW, int(cut.sum()))
        points, counts, given = layout.cut(points, given)
    try:
        return scene.add_curves(
            points, counts, basis=layout.basis, wrap=layout.wrap, name=str(prim.GetPath()), **given,
        )  # fmt: skip
    except InputError as error:
        raise InputError(f"{where}: {error}") from None


def _basis(schema: UsdGeom.BasisCurves, clock: Clock, notes: Notes) -> str:
    if schema.GetTypeAttr().Get(clock.code) == "linear":
        return "linear"
    name = str(schema.GetBasisAttr().Get(clock.code))
    if name not in _BASES:
        notes.add(f"curves of basis {name[:40]!r} are drawn as linear ones")
    return _BASES.get(name, "linear")


def _widths(schema: object, layout: Layout, count: int, clock: Clock, notes: Notes) -> Array:
    found = read_widths(schema, count, clock, notes)
    spread = None if found is None else layout.spread(found.flat, found.interpolation)
    if spread is None:
        if found is not None:
            note_length("widths", notes)
        notes.add("curves without widths have a width of 1")
        return np.ones(len(layout.counts), np.float32)
    return spread[:, 0]


def _values(
    prim: Usd.Prim, name: str, columns: int, layout: Layout, clock: Clock, notes: Notes
) -> Array | None:
    primvar = read_primvar(prim, name, columns, clock)
    if primvar is None or len(primvar) == 1:  # a constant colour is the material's
        return None
    found = layout.spread(primvar.flat, primvar.interpolation)
    if found is None:
        note_length(name, notes)
    return found
