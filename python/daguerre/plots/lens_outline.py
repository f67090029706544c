"""Outlines of a lens in a section: exact sags, clear diameters, flat edges.

Points are (z, y) or (z, x), mm.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daguerre.lenses.lens import DESIGN_WAVELENGTH_NM, Lens
from daguerre.lenses.surface import LensSurface

FloatArray = NDArray[np.float64]
Points = list[tuple[float, float]]
Section = Literal["x", "y"]

FLAT_KINDS = {"cyl-y": "y", "cyl-x": "x"}  # section in which a cylinder is straight


def sag(surface: LensSurface, height: ArrayLike, section: Section = "y") -> FloatArray:
    """Sag of a surface behind its vertex in a section, mm; NaN where the surface ends.

    z = c h^2 / (1 + sqrt(1 - (1 + k) c^2 h^2)) + sum a_p |h|^p

    Args:
        surface: The surface.
        height: Distance from the axis, mm, any shape.
        section: ``"y"``: the y-z section; ``"x"``: the x-z section.
    """
    h = np.asarray(height, np.float64)
    radius, conic, asphere = surface.radius, surface.conic, surface.asphere
    if FLAT_KINDS.get(surface.kind) == section:
        radius = None
    elif section == "x" and surface.kind in ("biconic", "toroid"):
        radius, conic = surface.radius_x, surface.conic_x
        asphere = {} if surface.kind == "toroid" else asphere
    c = 0.0 if radius is None else 1 / radius
    with np.errstate(invalid="ignore"):
        z = c * h**2 / (1 + np.sqrt(1 - (1 + conic) * (c * h) ** 2))
    for power, coefficient in asphere.items():
        z = z + coefficient * np.abs(h) ** int(power)
    return np.asarray(z)


def clear_heights(lens: Lens) -> list[tuple[float, float]]:
    """Clear semi-diameters of each surface on the side before and behind it, mm.

    Surfaces without a semi-diameter have the largest known, else the entrance pupil's, else 10 mm.
    """
    known = [s.semi_diameter for s in lens.surfaces if s.semi_diameter is not None]
    pupil = 0.5 * lens.first_order().entrance_pupil.diameter
    fallback = max(known) if known else (pupil if math.isfinite(pupil) else 10.0)
    out = []
    for s in lens.surfaces:
        before = fallback if s.semi_diameter is None else s.semi_diameter
        out.append((_within(s, before), _within(s, s.semi_diameter_after or before)))
    return out


def element_outlines(lens: Lens, section: Section = "y") -> list[tuple[Points, float]]:
    """Closed outline of each element, and its refractive index at 587.56 nm."""
    z, heights = lens.vertices, clear_heights(lens)
    out = []
    for i, surface in enumerate(lens.surfaces[:-1]):
        n = surface.core_glass.index(DESIGN_WAVELENGTH_NM)
        if n < 1.01 or (i > 0 and _inside_glass(lens, i)):
            continue
        j = i + 1
        while _inside_glass(lens, j):
            j += 1
        front = _Placed(surface, float(z[i]), heights[i][1])
        back = _Placed(lens.surfaces[j], float(z[j]), heights[j][0])
        outline = _element(front, back, section)
        out.append((outline, n))
    return out


def _inside_glass(lens: Lens, i: int) -> bool:
    """Whether a surface is a plane stop inside one glass, which does not divide it."""
    before, here = lens.surfaces[i - 1].core_glass, lens.surfaces[i]
    if not here.stop or here.radius is not None or i + 1 == len(lens.surfaces):
        return False
    return all(before.index(nm) == here.core_glass.index(nm) > 1.01 for nm in (486.1, 656.3))


@dataclass(frozen=True)
class _Placed:
    """A surface of an element.

    Attributes:
        surface: The surface.
        z: Position of its vertex, mm.
        height: Clear height, mm.
    """

    surface: LensSurface
    z: float
    height: float

    def profile(self, section: Section) -> Points:
        """Points (z, y) from bottom to top."""
        y = np.linspace(-self.height, self.height, 49)
        z = self.z + sag(self.surface, y, section)
        return list(zip(z.tolist(), y.tolist(), strict=True))


def _element(front: _Placed, back: _Placed, section: Section) -> Points:
    """Outline of both surfaces; a flat ring widens the smaller one if the edge has thickness."""
    first, last = front.profile(section), back.profile(section)
    outer = max(front.height, back.height)
    (zf, _), (zb, _) = first[-1], last[-1]
    if zb > zf:  # positive edge thickness: flat rings up to the larger diameter
        first, last = _widened(first, outer), _widened(last, outer)
    return [*first, *reversed(last)]


def _widened(profile: Points, outer: float) -> Points:
    z, y = profile[-1]
    return [(z, -outer), *profile, (z, outer)] if y < outer * (1 - 1e-9) else profile


def _within(surface: LensSurface, height: float) -> float:
    """Limits a height to the extent of the surface."""
    heights = np.linspace(0, height, 200)
    real = np.isfinite(sag(surface, heights)) & np.isfinite(sag(surface, heights, "x"))
    return float(heights[real].max())
