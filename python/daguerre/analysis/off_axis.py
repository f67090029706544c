"""Benches with a tilted lens, or with elements that are decentred or tilted, as in cameras."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from daguerre.lenses.groups import Group, angles, placed
from daguerre.lenses.lens import Lens
from daguerre.setup.tilt import turn

from .bench import Bench, FloatArray

#: First and last surface, shift along x and y (mm), tilt about x and y (degrees).
Move = tuple[tuple[int, int], tuple[float, float], tuple[float, float]]


def off_axis(bench: Bench, moves: Sequence[Move] = (), tilt: tuple[float, float] = (0, 0)) -> Bench:
    """Moves elements and tilts the lens of a bench, which was focused without them.

    Args:
        bench: The lens.
        moves: Moves of its elements, in the form of ``Camera.decenter``.
        tilt: Tilt of the whole lens about the centre of its entrance pupil, about x, then the
            film's y, degrees (``Camera.tilt``). The film stays normal to z and keeps its distance
            along the lens's axis.
    """
    lens = bench.lens
    for surfaces, shift, turned in moves:
        lens = lens.decentered(surfaces, shift, turned)
    if not any(tilt):
        return replace(bench, lens=lens)
    pupil = bench.order.entrance_pupil.z
    matrix = turn(tilt)
    film_z = pupil + (bench.film_z - pupil) * float(matrix[2, 2])
    return replace(bench, lens=_turned(lens, matrix, pupil), film_z=film_z)


def _turned(lens: Lens, matrix: FloatArray, pivot_z: float) -> Lens:
    """Turns all surfaces about a point on the axis."""
    group = Group(0, len(lens.surfaces) - 1, tilt=angles(matrix), pivot_mm=pivot_z)
    return lens.rebuilt(placed(lens.surfaces, group))
