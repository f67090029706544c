"""A lens as a plain SVG: elements, stop, film and a few rays."""

from __future__ import annotations

import math
from xml.sax.saxutils import escape

import numpy as np
from numpy.typing import NDArray

from .lens import DESIGN_WAVELENGTH_NM, Lens, LensSurface

WIDTH = 760.0  # px
AXIAL, OBLIQUE = "#c0392b", "#2471a3"


def draw(lens: Lens) -> str:
    """The meridional section, object on the left."""
    heights = _heights(lens)
    z = lens.vertices
    image_z = lens.image_z
    paths = [*_elements(lens, z, heights), *_stop(lens, z, heights)]
    rays, low_z = _rays(lens, image_z)
    top = 1.15 * max(heights)
    left = min(low_z, -0.25 * top)
    right = image_z + 0.1 * top
    film = min(top, 21.6)
    paths.append(_line([(image_z, -film), (image_z, film)], "#333", 1.5))
    paths.insert(0, _line([(left, 0), (right, 0)], "#999", 0.6, "4 3"))
    height = 2 * top * WIDTH / (right - left)
    title = f"{escape(lens.name)} ({lens.first_order().efl:.1f} mm)"
    body = "\n".join([*rays, *paths])
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH:.0f}" height="{height:.0f}" '
        f'viewBox="{left:.3f} {-top:.3f} {right - left:.3f} {2 * top:.3f}">\n'
        f"<title>{title}</title>\n{body}\n</svg>\n"
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


def _profile(surface: LensSurface, z: float, height: float) -> list[tuple[float, float]]:
    """Points (z, y) from bottom to top."""
    y = np.linspace(-height, height, 41)
    c = 0.0 if surface.radius is None else 1 / surface.radius
    sag = c * y**2 / (1 + np.sqrt(np.maximum(0.0, 1 - (c * y) ** 2)))
    return list(zip((z + sag).tolist(), y.tolist(), strict=True))


def _elements(lens: Lens, z: NDArray[np.float64], heights: list[float]) -> list[str]:
    out = []
    for i in range(len(lens.surfaces) - 1):
        if lens.surfaces[i].core_glass.index(DESIGN_WAVELENGTH_NM) == 1:
            continue
        front = _profile(lens.surfaces[i], float(z[i]), heights[i])
        back = _profile(lens.surfaces[i + 1], float(z[i + 1]), heights[i + 1])
        points = " ".join(f"{a:.3f},{-b:.3f}" for a, b in [*front, *reversed(back)])
        out.append(
            f'<polygon points="{points}" fill="#7fb3d5" fill-opacity="0.35" stroke="#1b4f72" '
            'stroke-width="1" vector-effect="non-scaling-stroke" stroke-linejoin="round"/>'
        )
    return out


def _stop(lens: Lens, z: NDArray[np.float64], heights: list[float]) -> list[str]:
    i = next(k for k, s in enumerate(lens.surfaces) if s.stop)
    edge, outer = heights[i], 1.08 * max(heights)
    at = float(z[i])
    return [_line([(at, side * edge), (at, side * outer)], "#000", 2.5) for side in (-1, 1)]


def _rays(lens: Lens, image_z: float) -> tuple[list[str], float]:
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
            out.append(_line([(float(p[2]), float(p[1])) for p in points], colour, 0.8))
    return out, start


def _line(points: list[tuple[float, float]], colour: str, width: float, dash: str = "") -> str:
    text = " ".join(f"{a:.3f},{-b:.3f}" for a, b in points)
    dashes = f' stroke-dasharray="{dash}"' if dash else ""
    return (
        f'<polyline points="{text}" fill="none" stroke="{colour}" stroke-width="{width}"'
        f'{dashes} vector-effect="non-scaling-stroke"/>'
    )
