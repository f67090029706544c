"""Lenses on the bench that are turned, or whose elements are, as cameras have them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from daguerre.lenses.groups import Group, angles, placed
from daguerre.lenses.lens import Lens
from daguerre.setup.tilt import turn

from .bench import Bench, FloatArray

#: First and last surface, shift along x and y (mm), turn about x and y (degrees).
Move = tuple[tuple[int, int], tuple[float, float], tuple[float, float]]


def off_axis(bench: Bench, moves: Sequence[Move] = (), tilt: tuple[float, float] = (0, 0)) -> Bench:
    """A lens that was focused as if it were straight, with its parts moved.

    Args:
        bench: The lens.
        moves: Moves of its elements, in the form of ``Camera.decenter``.
        tilt: Turn of all of it about the centre of its entrance pupil, about x, then the film's
            y, degrees (``Camera.tilt``). The film stays across z, and where the lens's axis meets
            it it has its distance.
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
    """All surfaces turned about a point of the axis."""
    group = Group(0, len(lens.surfaces) - 1, tilt=angles(matrix), pivot_mm=pivot_z)
    return lens.rebuilt(placed(lens.surfaces, group))
