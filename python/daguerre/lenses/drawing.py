"""A lens in section: elements, stop, film and a few rays, as plain SVG."""

from __future__ import annotations

import math
from dataclasses import dataclass
from xml.sax.saxutils import escape

import numpy as np
from numpy.typing import NDArray

from .lens import DESIGN_WAVELENGTH_NM, Lens
from .surface import LensSurface

WIDTH = 760.0  # px
AXIAL, OBLIQUE = "#c0392b", "#2471a3"

Points = list[tuple[float, float]]


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
    """What is drawn, from back to front, and the window: left to right, -top to top, mm."""

    title: str
    left: float
    right: float
    top: float
    shapes: list[Line | Polygon]


def draw(lens: Lens) -> str:
    """The meridional section as SVG, object on the left."""
    return to_svg(section(lens))


def section(lens: Lens) -> Drawing:
    """The meridional section: elements, stop, film and rays."""
    heights = _heights(lens)
    z = lens.vertices
    image_z = lens.image_z
    rays, low_z = _rays(lens, image_z)
    top = 1.15 * max(heights)
    left = min(low_z, -0.25 * top)
    right = image_z + 0.1 * top
    film = min(top, 21.6)
    shapes: list[Line | Polygon] = [
        *rays,
        Line([(left, 0), (right, 0)], "#999999", 0.6, "4 3"),
        *_elements(lens, z, heights),
        *_stop(lens, z, heights),
        Line([(image_z, -film), (image_z, film)], "#333333", 1.5),
    ]
    title = f"{lens.name} ({lens.first_order().efl:.1f} mm)"
    return Drawing(title, left, right, top, shapes)


def to_svg(drawing: Drawing) -> str:
    """The drawing as an SVG document."""
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
            f'<polygon points="{text}" fill="{shape.fill}" fill-opacity="0.35" '
            f'stroke="{shape.stroke}" stroke-width="1" vector-effect="non-scaling-stroke" '
            'stroke-linejoin="round"/>'
        )
    dashes = f' stroke-dasharray="{shape.dash}"' if shape.dash else ""
    return (
        f'<polyline points="{text}" fill="none" stroke="{shape.stroke}" '
        f'stroke-width="{shape.width}"{dashes} vector-effect="non-scaling-stroke"/>'
    )


def _heights(lens: Lens) -> list[float]:
    known = [s.semi_diameter for s in lens.surfaces if s.semi_diameter is not None]
    pupil = 0.5 * lens.first_order().entrance_pupil.diameter
    fallback = max(known) if known else (pupil if math.isfinite(pupil) else 10.0)
    out = []
    for s in lens.surfaces:
        height = fallback if s.semi_diameter is None else s.semi_diameter
        out.append(min(height, 0.999 * abs(s.radius)) if s.radius is not None else height)
    return out


def _profile(surface: LensSurface, z: float, height: float) -> Points:
    """Points (z, y) from bottom to top."""
    y = np.linspace(-height, height, 41)
    c = 0.0 if surface.radius is None else 1 / surface.radius
    sag = c * y**2 / (1 + np.sqrt(np.maximum(0.0, 1 - (c * y) ** 2)))
    return list(zip((z + sag).tolist(), y.tolist(), strict=True))


def _elements(lens: Lens, z: NDArray[np.float64], heights: list[float]) -> list[Polygon]:
    out = []
    for i in range(len(lens.surfaces) - 1):
        if lens.surfaces[i].core_glass.index(DESIGN_WAVELENGTH_NM) == 1:
            continue
        front = _profile(lens.surfaces[i], float(z[i]), heights[i])
        back = _profile(lens.surfaces[i + 1], float(z[i + 1]), heights[i + 1])
        out.append(Polygon([*front, *reversed(back)]))
    return out


def _stop(lens: Lens, z: NDArray[np.float64], heights: list[float]) -> list[Line]:
    i = next(k for k, s in enumerate(lens.surfaces) if s.stop)
    edge, outer = heights[i], 1.08 * max(heights)
    at = float(z[i])
    return [Line([(at, side * edge), (at, side * outer)], "#000000", 2.5) for side in (-1, 1)]


def _rays(lens: Lens, image_z: float) -> tuple[list[Line], float]:
    """Parallel fans on the axis and under half of the field, through the entrance pupil."""
    order = lens.first_order()
    pupil, radius = order.entrance_pupil.z, 0.5 * order.entrance_pupil.diameter
    start = -0.35 * max(_heights(lens))
    if not (math.isfinite(pupil) and math.isfinite(radius)):
        return [], start
    field = math.atan(0.6 * 21.6 / abs(order.efl))
    out = []
    for angle, colour in ((0.0, AXIAL), (min(field, math.radians(35)), OBLIQUE)):
        direction = np.array([[0.0, math.sin(angle), math.cos(angle)]])
        for share in (-0.9, -0.45, 0.0, 0.45, 0.9):
            at_pupil = np.array([[0.0, share * radius, pupil]])
            origin = at_pupil + direction * ((start - pupil) / direction[0, 2])
            path = lens.prescription.path(origin, direction, DESIGN_WAVELENGTH_NM, True)
            if len(path) == 0:
                continue
            end = lens.trace(origin, direction, image_z=image_z)
            points = [origin[0], *path, end[0]]
            out.append(Line([(float(p[2]), float(p[1])) for p in points], colour, 0.8))
    return out, start
