"""Curves in text files: a control point and its radius a line, and an empty line between curves.

Source: Mitsuba 3, documentation of ``bsplinecurve`` and ``linearcurve``.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import InputError

from .context import Context
from .node import Node

CURVES = {"bsplinecurve": "bspline", "linearcurve": "linear"}
#: Least control points of a curve.
_LEAST = {"bspline": 4, "linear": 2}


def add_curves(node: Node, context: Context) -> int | None:
    """Adds the curves of a shape to the scene, as one mesh; ``to_world`` does not scale radii.

    Returns:
        Index of the mesh, in the space of the scene; None, and a note: the file is missing.

    Raises:
        InputError: The file is wrong; the message names its line.
    """
    basis = CURVES[node.plugin]
    node.skip("silhouette_sampling_weight")
    name = node.text("filename")
    data = context.document.files_of(node).read(name, node.entry)
    place = context.world @ node.transform()
    if data is None:
        context.notes.add("curves whose file is missing are left out", name=name)
        return None
    where = str(node.entry.about(name))
    rows, counts = _rows(data, where)
    short = [count for count in counts if count < _LEAST[basis]]
    if not counts or short:
        got = f"{short[0]}" if short else "none"
        raise InputError(f"{where}: wanted curves of at least {_LEAST[basis]} points, got {got}")
    points = rows[:, :3] @ place[:3, :3].T + place[:3, 3]
    widths = 2 * context.unit_m * rows[:, 3]
    return context.scene.add_curves(points, counts, widths, basis=basis, name=node.id)


def _rows(data: bytes, where: str) -> tuple[NDArray[np.float64], list[int]]:
    """Control points with radii, shape (N, 4), and the points of each curve."""
    numbers: list[float] = []
    counts, count = [], 0
    for line, words in enumerate((text.split() for text in data.split(b"\n")), 1):
        if not words:
            counts += [count] if count else []
            count = 0
            continue
        try:
            found = [float(word) for word in words]
        except ValueError:
            found = []
        if len(found) != 4 or not np.isfinite(found).all() or found[3] < 0:
            raise InputError(f"{where}: line {line}: wanted four numbers: x y z radius")
        numbers += found
        count += 1
    counts += [count] if count else []
    return np.reshape(numbers, (-1, 4)), counts
