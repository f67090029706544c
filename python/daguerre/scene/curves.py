"""Round curves from arrays, with checks, and the keywords of ``Scene.add_curves``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, TypedDict

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daguerre.checks import MAX_NUMBERS, array, freeze_in_place, short, to_numbers
from daguerre.errors import InputError
from daguerre.files.value import Value
from daguerre.motion.values import Dynamic
from daguerre.parameters.parameter import Parameter
from daguerre.parameters.table import Table

from .limits import check_coordinates
from .mesh import with_alpha
from .motion import Vertices
from .parts import Curves, vertices_of

if TYPE_CHECKING:
    from .curve_bases import BezierForm, Layout

FloatArray = NDArray[np.float32]
BASES = ("bspline", "bezier", "catmull-rom", "linear")
WRAPS = ("nonperiodic", "periodic", "pinned")
_BALLS_PER_SEGMENT = 9


class CurveKeywords(TypedDict, total=False):
    """Keywords of ``Scene.add_curves``."""

    basis: str
    wrap: str
    uv: ArrayLike | None
    colors: ArrayLike | None
    steps: Dynamic | tuple[ArrayLike, ArrayLike] | None
    name: str


# fmt: off
CURVES = Table(
    Parameter(
        "basis", "Meaning of the control points", kind="choice", default="bspline", choices=BASES,
    ),
    Parameter(
        "wrap", "Ends of the curves: ``periodic`` closes them, ``pinned`` lets B-splines and "
        "Catmull-Rom splines reach their first and last points", kind="choice",
        default="nonperiodic", choices=WRAPS,
    ),
    Parameter(
        "uv", "Texture coordinates, set 0, one per curve or one per control point, shape (C, 2) or "
        "(N, 2); default, and set 1 in any case: along the curve and around it", kind="value",
    ),
    Parameter(
        "colors", "Linear RGB or RGBA, one per curve or one per control point, shape (C, 3) to "
        "(N, 4)", kind="value",
    ),
    Parameter(
        "steps", "Points over time: (times (S,) in s, points (S, N, 3)) or a value over time; "
        "``points`` then are those at one time", kind="value",
    ),
    Parameter("name", "For messages", default="", kind="text"),
)
# fmt: on


@dataclass(frozen=True, eq=False)
class MovingCurves(Value):
    """Control points of curves over time, as the vertices of their segments.

    Attributes:
        points: Control points over time, shape (N, 3), m.
        layout: Counts, basis and wrap.
        rest: Vertices of one moment.
        where: Owner, for messages.
    """

    points: Dynamic
    layout: Layout
    rest: Vertices
    where: str

    def at(self, time_s: float) -> Vertices:
        """Returns the vertices at a time, s."""
        count = int(self.layout.counts.sum())
        points = _rows(self.points.at(time_s), self.where, "points", 3, count)
        return replace(self.rest, positions=_positions(self.layout.form, points, self.where))

    def breaks(self, begin: float, end: float) -> Sequence[float]:
        """Breaks of the points, s."""
        return [float(t) for t in self.points.breaks(begin, end)]


def curves_of(
    points: ArrayLike, counts: object, widths: object, given: Mapping[str, Any], where: str
) -> tuple[Curves, Layout]:
    """Makes curves from arrays.

    Returns:
        The curves, and the layout of their segments.

    Raises:
        InputError: A shape, a count or a number is wrong; the message names it.
    """
    basis, wrap = given["basis"], given["wrap"]
    control = array(points, where, "points", 3)
    each = _counts(counts, where, basis, wrap)
    if each.sum() != len(control):
        raise InputError(
            f"{where}: counts: wanted a sum of {len(control)}, the number of points, "
            f"got {each.sum()}"
        )
    layout = _layout(each, basis, wrap)
    form = layout.form
    size = len(each), len(control)
    colors = with_alpha(given["colors"], where)
    made = Curves(
        _positions(form, control, where),
        np.zeros((0, 3), np.uint32),
        uv=_values(given["uv"], where, "uv", 2, size, form),
        colors=_values(colors, where, "colors", 4, size, form),
        name=given["name"],
        radii=_radii(widths, where, each, form),
        starts=freeze_in_place(form.starts),
        ends=freeze_in_place(form.ends),
        cubic=basis != "linear",
        closed=wrap == "periodic",
    )
    return made, layout


def moving_curves(path: Dynamic, curves: Curves, layout: Layout) -> MovingCurves:
    """Makes the vertices over time of curves with control points that follow a path."""
    return MovingCurves(path, layout, vertices_of(curves), f"curves {curves.name!r}")


def layout_of(counts: object, basis: str, wrap: str, where: str) -> Layout:
    """Checks counts, basis and wrap of curves; makes the layout of their segments.

    Raises:
        InputError: No such basis or wrap, or a count that is wrong.
    """
    for value, names, what in ((basis, BASES, "basis"), (wrap, WRAPS, "wrap")):
        if value not in names:
            raise InputError(f"{where}: {what}: wanted {', '.join(names)}, got {short(value)}")
    return _layout(_counts(counts, where, basis, wrap), basis, wrap)


def balls_along(curves: Curves) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Computes balls that touch the surface along curves: centres (B, 3) and radii (B, 1), m."""
    rows = np.column_stack([curves.points, curves.radii])
    starts = curves.starts.astype(np.int64)
    if not curves.cubic:
        return rows[:, :3], rows[:, 3:]
    u = np.linspace(0, 1, _BALLS_PER_SEGMENT)[:, None]
    v = 1 - u
    weights = np.hstack([v**3, 3 * u * v**2, 3 * u**2 * v, u**3])
    balls = np.einsum("uk,skc->suc", weights, rows[starts[:, None] + np.arange(4)]).reshape(-1, 4)
    return balls[:, :3], balls[:, 3:]


def _layout(counts: NDArray[np.int64], basis: str, wrap: str) -> Layout:
    from .curve_bases import Layout

    return Layout(freeze_in_place(counts), basis, wrap)


def _counts(counts: object, where: str, basis: str, wrap: str) -> NDArray[np.int64]:
    from .curve_bases import are_counts, wanted_count

    numbers = to_numbers(counts, where, "counts", "shape (C,)")
    if numbers.ndim != 1 or (numbers.size and numbers.dtype.kind not in "iu"):
        raise InputError(
            f"{where}: counts: wanted whole numbers, shape (C,), "
            f"got {numbers.dtype} of shape {numbers.shape}"
        )
    bad = np.flatnonzero((numbers > MAX_NUMBERS) | ~are_counts(numbers, basis, wrap))
    if bad.size:
        raise InputError(
            f"{where}: counts[{bad[0]}]: wanted {wanted_count(basis, wrap)} points "
            f"({basis}, {wrap}), got {numbers[bad[0]]} ({bad.size} such curves)"
        )
    return numbers.astype(np.int64)


def _positions(form: BezierForm, points: FloatArray, where: str) -> FloatArray:
    with np.errstate(over="ignore"):
        made = form.of(points).astype(np.float32)
    placed = array(made, where, "points of segments", 3)
    check_coordinates(placed, where, "points of segments")
    return freeze_in_place(placed)


def _radii(widths: object, where: str, counts: NDArray[np.int64], form: BezierForm) -> FloatArray:
    """Half of the widths at the points of the segments, shape (P,)."""
    wanted = "a width, or shape (C,) or (N,)"
    numbers = to_numbers(widths, where, "widths", wanted)
    if numbers.ndim > 1:
        raise InputError(f"{where}: widths: wanted {wanted}, got shape {numbers.shape}")
    flat = array(np.atleast_1d(numbers)[:, None], where, "widths", 1)
    check_coordinates(flat, where, "widths")
    if (flat < 0).any():
        bad = int(np.flatnonzero(flat < 0)[0])
        raise InputError(f"{where}: widths[{bad}]: wanted at least 0 m, got {flat[bad, 0]:g}")
    if len(flat) == 1:
        flat = np.broadcast_to(flat, (len(counts), 1))
    total = int(counts.sum())
    if len(flat) not in (len(counts), total):
        raise InputError(
            f"{where}: widths: wanted 1, {len(counts)} (one per curve) or {total} (one per point), "
            f"got {len(flat)}"
        )
    if len(flat) == len(counts):
        flat = np.repeat(flat, counts, axis=0)
    radii = 0.5 * np.maximum(form.of(flat), 0)  # splines through points may swing below 0
    return freeze_in_place(radii[:, 0].astype(np.float32))


def _values(
    values: ArrayLike | None,
    where: str,
    what: str,
    columns: int,
    size: tuple[int, int],
    form: BezierForm,
) -> FloatArray | None:
    """Values per curve as they are, or per control point as values per position."""
    if values is None:
        return None
    rows = array(values, where, what, columns)
    curves, points = size
    if len(rows) == curves:
        return rows
    if len(rows) != points:
        raise InputError(
            f"{where}: {what}: wanted {curves} (one per curve) or {points} (one per point), "
            f"got {len(rows)}"
        )
    made = form.of(rows)
    return freeze_in_place((np.maximum(made, 0) if what == "colors" else made).astype(np.float32))


def _rows(values: ArrayLike, where: str, what: str, columns: int, count: int) -> FloatArray:
    rows = array(values, where, what, columns)
    if len(rows) != count:
        raise InputError(f"{where}: {what}: wanted {count} elements, got {len(rows)}")
    return rows
