"""The drawing of a lens, small enough for a page with more than a hundred of them."""

from __future__ import annotations

from xml.sax.saxutils import escape

import numpy as np
from numpy.typing import NDArray

from daguerre.plots.lens_section import Drawing, Line, Polygon

WIDE, HIGH = 3000, 2000  # the picture fits into this, tenths of a pixel
TOLERANCE = 1.2  # of a curve, in the same unit


def small(drawing: Drawing) -> str:
    """The drawing in whole tenths of a pixel, with the points alone that are seen."""
    span = drawing.right - drawing.left
    scale = min(WIDE / span, HIGH / (2 * drawing.top))
    size = [round(scale * span), round(scale * 2 * drawing.top)]
    body = "\n".join(_shape(shape, drawing.left, drawing.top, scale) for shape in drawing.shapes)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{size[0] / 10:.0f}" '
        f'height="{size[1] / 10:.0f}" viewBox="0 0 {size[0]} {size[1]}">\n'
        "<style>path{fill:none;stroke-linejoin:round}</style>\n"
        f"<title>{escape(drawing.title)}</title>\n{body}\n</svg>\n"
    )


def _shape(shape: Line | Polygon, left: float, top: float, scale: float) -> str:
    points = np.array([((z - left) * scale, (top - y) * scale) for z, y in shape.points])
    path = _path(points[_seen(points)], closed=isinstance(shape, Polygon))
    if isinstance(shape, Polygon):
        return (
            f'<path d="{path}" style="fill:{shape.fill};fill-opacity:.45" '
            f'stroke="{shape.stroke}" stroke-width="7"/>'
        )
    dash = " ".join(f"{10 * float(d):.0f}" for d in shape.dash.split())
    dashes = f' stroke-dasharray="{dash}"' if dash else ""
    return (
        f'<path d="{path}" stroke="{shape.stroke}" stroke-width="{8 * shape.width:.0f}"{dashes}/>'
    )


def _path(points: NDArray[np.float64], closed: bool) -> str:
    """SVG's path: a place, then steps."""
    whole = np.rint(points).astype(int)
    steps = np.diff(whole, axis=0)
    steps = steps[np.any(steps != 0, axis=1)]
    moves = "".join(f" {x} {y}" for x, y in steps)
    return f"M{whole[0, 0]} {whole[0, 1]}l{moves[1:]}".replace(" -", "-") + ("z" if closed else "")


def _seen(points: NDArray[np.float64]) -> list[int]:
    """Indices of the points that a polyline needs (Ramer 1972; Douglas and Peucker 1973)."""
    kept, open_parts = {0, len(points) - 1}, [(0, len(points) - 1)]
    while open_parts:
        first, last = open_parts.pop()
        if last - first < 2:
            continue
        a, way = points[first], points[last] - points[first]
        rest = points[first + 1 : last] - a
        length = float(np.hypot(*way))
        off = (
            np.abs(way[0] * rest[:, 1] - way[1] * rest[:, 0]) / length
            if length > 0
            else np.hypot(rest[:, 0], rest[:, 1])
        )
        k = int(off.argmax())
        if off[k] > TOLERANCE:
            middle = first + 1 + k
            kept.add(middle)
            open_parts += [(first, middle), (middle, last)]
    return sorted(kept)
