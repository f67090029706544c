"""Reads hair curves: Catmull-Rom splines and polylines, open or closed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from daguerre.files.notes import Notes
from daguerre.scene.limits import check_size
from daguerre.scene.scene import Scene

from .arrays import attribute, points_of, read
from .meshes import Materials, Parts, Steps, slots_of

if TYPE_CHECKING:
    import bpy


#: Radius of curves without an attribute of it, units of the scene.
RADIUS = 0.01
#: Basis and fewest points by Blender's number of a type of curve.
_BASES = {0: ("catmull-rom", 2), 1: ("linear", 2)}
_FEWEST_CLOSED = 3


class Hair:
    """Hair curves of a scene, each added once for all copies.

    Args:
        scene: Receives the curves.
        materials: Materials by slot; curves have the first.
        notes: Receives notes on curves that are left out.
    """

    def __init__(self, scene: Scene, materials: Materials, notes: Notes) -> None:
        self._scene = scene
        self._materials = materials
        self._notes = notes
        self._made: dict[tuple[int, int], Parts] = {}

    def index(self, thing: bpy.types.Object, steps: Steps | None = None) -> Parts:
        """Pairs (mesh, material) of an evaluated object of type CURVES.

        Args:
            thing: ``bpy.types.Object``, evaluated.
            steps: Control points over time.
        """
        material = slots_of(thing)[0]
        key = (thing.data.as_pointer(), 0 if material is None else material.as_pointer())
        if key not in self._made:
            made = self._add(thing.data, steps)
            index = self._materials.index(material) if made else 0
            self._made[key] = [(mesh, index) for mesh in made]
        return self._made[key]

    def _add(self, curves: bpy.types.Curves, steps: Steps | None) -> list[int]:
        """Adds the curves of each type."""
        counts = np.diff(read(curves.curve_offset_data, "value", 1, np.int32))
        types = _per_curve(curves, "curve_type", len(counts))
        closed = _per_curve(curves, "cyclic", len(counts)).astype(bool)
        made = []
        for number, (basis, fewest) in _BASES.items():
            for wraps in (False, True):
                mine = (types == number) & (closed == wraps)
                enough = mine & (counts >= (_FEWEST_CLOSED if wraps else fewest))
                self._left_out("hair curves with too few points", mine & ~enough)
                if enough.any():
                    wrap = _wrap(basis, wraps)
                    made.append(self._group(curves, counts, enough, (basis, wrap), steps))
        self._left_out("Bezier and NURBS hair curves", ~np.isin(types, list(_BASES)))
        return made

    def _left_out(self, kind: str, which: NDArray[np.bool_]) -> None:
        if which.any():
            self._notes.add(f"{kind} are left out", int(which.sum()))

    def _group(
        self,
        curves: bpy.types.Curves,
        counts: NDArray[np.int32],
        chosen: NDArray[np.bool_],
        kind: tuple[str, str],
        steps: Steps | None,
    ) -> int:
        """Adds some curves of one basis and wrap."""
        points, rows = points_of(curves), np.flatnonzero(np.repeat(chosen, counts))
        check_size(points, f"curves {curves.name_full!r}: positions")
        radius = attribute(curves, "radius")
        roots = attribute(curves, "surface_uv_coordinate")
        uv = None
        if roots is not None and len(roots) == len(counts):
            uv = roots[chosen]
            np.subtract(1, uv[:, 1], out=uv[:, 1])
        return self._scene.add_curves(
            points[rows],
            counts[chosen],
            2 * RADIUS if radius is None else 2 * np.maximum(radius[rows], 0),
            basis=kind[0],
            wrap=kind[1],
            uv=uv,
            steps=None if steps is None else steps.of(rows),
            name=curves.name_full,
        )


def _wrap(basis: str, closed: bool) -> str:
    """Ends of curves: Catmull-Rom splines reach their first and last points."""
    if closed:
        return "periodic"
    return "nonperiodic" if basis == "linear" else "pinned"


def _per_curve(curves: bpy.types.Curves, name: str, count: int) -> NDArray[Any]:
    """Values of an attribute of curves, shape (count,); zeros if it is missing."""
    found = attribute(curves, name)
    return np.zeros(count, np.int32) if found is None or len(found) != count else found
