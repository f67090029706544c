"""Reads curves: strands of one material become one mesh.

Every strand becomes a chain of cubic Bezier segments in the space of its object or the world. Flat
curves, which turn toward the viewer, and ribbons are drawn as round curves.

Source: pbrt-v4's user's guide ("curve"); Farin 2002, Curves and Surfaces for CAGD.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from daguerre.files.notes import Notes

from .state import Entity

Array = NDArray[np.float64]
#: Bezier points of a segment of a B-spline of degree 2 and 3, from its control points.
_OF_BSPLINE = {
    2: np.array([(1, 1, 0), (0, 2, 0), (0, 1, 1)]) / 2,
    3: np.array([(1, 4, 1, 0), (0, 4, 2, 0), (0, 2, 4, 0), (0, 1, 4, 1)]) / 6,
}
#: Cubic Bezier points from quadratic points.
_RAISED = np.array([(3, 0, 0), (1, 2, 0), (0, 2, 1), (0, 0, 3)]) / 3


@dataclass(eq=False)
class Strands:
    """Strands of one material.

    Attributes:
        points: Bezier points, (N, 3) each.
        widths: Diameters at the points.
        first: Directive of the first strand.
        all: All directives.
    """

    first: Entity
    points: list[Array] = field(default_factory=list)
    widths: list[Array] = field(default_factory=list)
    all: list[Entity] = field(default_factory=list)

    def add(self, entity: Entity, notes: Notes) -> None:
        """Adds a strand.

        Raises:
            InputError: A parameter is wrong.
        """
        points, widths = _strand(entity, notes)
        world = entity.state.transform.start
        self.points.append(points @ world[:3, :3].T + world[:3, 3])
        self.widths.append(widths * abs(np.linalg.det(world[:3, :3])) ** (1 / 3))
        self.all.append(entity)


def group_of(entity: Entity) -> tuple[object, ...]:
    """Values that the strands of a mesh share."""
    state = entity.state
    material = state.material if isinstance(state.material, str) else id(state.material)
    return material, state.inside, state.outside, id(state.emission), state.reversed


def _strand(entity: Entity, notes: Notes) -> tuple[Array, Array]:
    parameters = entity.parameters
    kind = parameters.text("type", "flat")
    if kind not in ("flat", "ribbon", "cylinder"):
        entity.place.fail(f"type: wanted flat, ribbon or cylinder, got {kind[:40]!r}")
    if kind != "cylinder":
        notes.add(f"a curve of type {kind!r} is drawn round")
    basis = parameters.text("basis", "bezier")
    if basis not in ("bezier", "bspline"):
        entity.place.fail(f"basis: wanted bezier or bspline, got {basis[:40]!r}")
    degree = parameters.integer("degree", 3, 2, 3)
    for name in ("N", "splitdepth", "alpha"):
        parameters.find(name)
    control = parameters.points("P", "point3", "vector3")
    points = np.zeros((0, 3)) if control is None else control
    fits = len(points) > degree if basis == "bspline" else (len(points) - 1) % degree == 0
    if len(points) <= degree or not fits:
        wanted = "at least" if basis == "bspline" else f"a multiple of {degree} and 1, at least"
        entity.place.fail(f"P: wanted {wanted} {degree + 1} points, got {len(points)}")
    chain = _chain(points, basis, degree)
    width = parameters.number("width", 1.0, 0.0)
    ends = parameters.number("width0", width, 0.0), parameters.number("width1", width, 0.0)
    return chain, np.linspace(*ends, len(chain))


def _chain(points: Array, basis: str, degree: int) -> Array:
    """Cubic Bezier points of a whole curve, shape (3 S + 1, 3)."""
    step = 1 if basis == "bspline" else degree
    starts = np.arange(0, len(points) - degree, step)
    segments = points[starts[:, None] + np.arange(degree + 1)]
    if basis == "bspline":
        segments = _OF_BSPLINE[degree] @ segments
    if degree == 2:
        segments = _RAISED @ segments
    return np.concatenate([segments[:, :3].reshape(-1, 3), segments[-1:, 3]])
