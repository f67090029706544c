"""Draws the section of a lens as plain SVG: elements, stop, film and rays of three fields."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING
from xml.sax.saxutils import escape

import numpy as np

from daguerre.lenses.image_circle import half_image as stated_half
from daguerre.lenses.lens import DESIGN_WAVELENGTH_NM, Lens
from daguerre.lenses.surface import stop_of

from .lens_outline import Points, clear_heights, element_outlines

if TYPE_CHECKING:
    from daguerre.analysis.pencils import Pencil

WIDTH = 760.0  # px
RAYS = 5  # rays in each fan
#: Colours on the axis, at 0.7 of the field, and at its edge.
COLORS = ("#c0392b", "#1e8449", "#2471a3")
FIELDS = (0.0, 0.7, 1.0)
#: Line width of rays, px.
RAY_WIDTH = 0.7


@dataclass(frozen=True)
class Line:
    """A polyline through points (z, y), mm; width and dashes in px."""

    points: Points
    stroke: str
    width: float
    dash: str = ""


@dataclass(frozen=True)
class Polygon:
    """A closed, filled outline of points (z, y), mm."""

    points: Points
    fill: str = "#7fb3d5"
    stroke: str = "#1b4f72"


@dataclass(frozen=True)
class Drawing:
    """Shapes of a drawing, from back to front, and its window: left to right, -top to top, mm."""

    title: str
    left: float
    right: float
    top: float
    shapes: list[Line | Polygon]


def draw(lens: Lens) -> str:
    """Draws the meridional section as SVG, with the object on the left."""
    return to_svg(section(lens))


def section(
    lens: Lens,
    film_z: float | None = None,
    half_image: float | None = None,
    light: Sequence[Pencil] | None = None,
) -> Drawing:
    """Draws the meridional section: elements, stop, film and rays.

    Args:
        lens: The lens, with the gaps of its zoom and focus.
        film_z: Position of the film, mm; default: the prescription's.
        half_image: Radius of the image circle, mm; default: the lens's, else for 36 x 24 mm.
        light: Light of up to three points of the meridional plane; default: of three fields.
    """
    heights = [max(pair) for pair in clear_heights(lens)]
    order = lens.first_order()
    image_z = lens.image_z if film_z is None else film_z
    half = half_image or stated_half(lens, order)
    top = 1.08 * max(max(heights), half)
    length = image_z - min(0.0, float(lens.vertices[0]))
    left, right = -0.3 * length, image_z + 0.04 * length
    glass = [Polygon(points, _fill(n)) for points, n in element_outlines(lens)]
    left = min(left, 1.1 * min((z for g in glass for z, _ in g.points), default=0.0))
    shapes: list[Line | Polygon] = [
        Line([(left, 0), (right, 0)], "#999999", 0.6, "8 3 2 3"),
        *glass,
        *_rays(_fields(lens, image_z, half) if light is None else light, left, top),
        *_stop(lens, heights),
        Line([(image_z, -half), (image_z, half)], "#333333", 1.8),
    ]
    return Drawing(f"{lens.name} ({order.efl:.1f} mm)", left, right, top, shapes)


def to_svg(drawing: Drawing) -> str:
    """Encodes a drawing as an SVG document."""
    left, top, span = drawing.left, drawing.top, drawing.right - drawing.left
    body = "\n".join(_svg_shape(shape) for shape in drawing.shapes)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH:.0f}" '
        f'height="{2 * top * WIDTH / span:.0f}" '
        f'viewBox="{left:.3f} {-top:.3f} {span:.3f} {2 * top:.3f}">\n'
        f"<title>{escape(drawing.title)}</title>\n{body}\n</svg>\n"
    )


def _svg_shape(shape: Line | Polygon) -> str:
    text = " ".join(f"{z:.3f},{-y:.3f}" for z, y in shape.points)
    if isinstance(shape, Polygon):
        return (
            f'<polygon points="{text}" fill="{shape.fill}" fill-opacity="0.45" '
            f'stroke="{shape.stroke}" stroke-width="1" vector-effect="non-scaling-stroke" '
            'stroke-linejoin="round"/>'
        )
    dashes = f' stroke-dasharray="{shape.dash}"' if shape.dash else ""
    return (
        f'<polyline points="{text}" fill="none" stroke="{shape.stroke}" '
        f'stroke-width="{shape.width}"{dashes} vector-effect="non-scaling-stroke"/>'
    )


def _fill(n: float) -> str:
    """Fill colour of glass: blue, darker for a higher index."""
    share = min(max((n - 1.43) / 0.6, 0.0), 1.0)
    light, deep = (205, 228, 243), (86, 145, 189)
    return "#" + "".join(
        f"{round(a + share * (b - a)):02x}" for a, b in zip(light, deep, strict=True)
    )


def _stop(lens: Lens, heights: list[float]) -> list[Line]:
    i = stop_of(lens.surfaces)
    edge, at = heights[i], float(lens.vertices[i])
    outer = max(edge + 0.12 * max(heights), min(1.08 * max(heights), 1.6 * edge))
    return [Line([(at, side * edge), (at, side * outer)], "#000000", 2.5) for side in (-1, 1)]


def _fields(lens: Lens, film_z: float, half: float) -> list[Pencil | None]:
    """Light of the axis, and of two points off it."""
    from daguerre.analysis.bench import at_film
    from daguerre.analysis.pencils import pencil

    bench = at_film(lens, film_z, half)
    return [pencil(bench, -share * bench.field_mm) for share in FIELDS]


def _rays(pencils: Sequence[Pencil | None], left: float, top: float) -> list[Line]:
    """Fans of rays, from edge to edge of the light that passes."""
    out = []
    for light, color in zip(pencils, COLORS, strict=False):
        if light is None:
            continue
        scan = np.linspace(light.low[1], light.high[1], 161)
        lit = scan[light.trace(np.column_stack([0 * scan, scan])).passed]
        for y in np.linspace(lit[0], lit[-1], RAYS) if len(lit) else []:
            out.extend(_ray(light, float(y), left, top, color))
    return out


def _ray(light: Pencil, y: float, left: float, top: float, color: str) -> list[Line]:
    through = light.center + y * light.tangential
    direction = light.direction if light.source is None else through - light.source
    direction = direction / np.linalg.norm(direction)
    start = through - 1e3 * direction
    lens, film_z = light.bench.lens, light.bench.film_z
    path = lens.prescription.path(start[None], direction[None], DESIGN_WAVELENGTH_NM, False)
    if len(path) == 0:
        return []
    # Extend the ray back to the edge of the drawing.
    first = path[0]
    to_left = (first[2] - left) / direction[2] if direction[2] > 1e-6 else math.inf
    side = math.copysign(top, -direction[1])
    to_side = (first[1] - side) / direction[1] if abs(direction[1]) > 1e-6 else math.inf
    begin = first - max(0.0, min(to_left, to_side)) * direction
    end = lens.trace(start, direction, image_z=film_z)[0]
    return [Line([(float(p[2]), float(p[1])) for p in (begin, *path, end)], color, RAY_WIDTH)]
