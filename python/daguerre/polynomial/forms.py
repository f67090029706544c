"""Forms of surfaces. A radius is positive when the centre lies ahead, in the direction of light."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

import daguerre._core as _core
from daguerre.checks import number, short, whole
from daguerre.errors import UsageError
from daguerre.lenses.surface_reader import MAX_POWER


@dataclass(frozen=True, eq=False)
class Form:
    """Form of a surface about its vertex.

    Attributes:
        name: Name of the form.
        surface: Surface in the core.
    """

    name: str
    surface: _core.Surface

    def __repr__(self) -> str:
        return self.name


def plane() -> Form:
    """Returns a plane normal to the axis."""
    return _form("plane()", "spherical")


def sphere(radius: float) -> Form:
    """Returns a sphere of a radius, mm."""
    radius = _length(radius)
    return _form(f"sphere({radius:g})", "spherical", curvature=1 / radius)


def conic(radius: float, k: float) -> Form:
    """Returns a conic of revolution: vertex radius, mm, and conic constant (-1: paraboloid)."""
    radius, k = _length(radius), number(k, "conic: k")
    return _form(f"conic({radius:g}, {k:g})", "aspheric", curvature=1 / radius, conic=k)


def asphere(radius: float, terms: Mapping[int, float], k: float = 0.0) -> Form:
    """Returns an asphere: a conic of revolution plus powers of the distance from the axis.

    Args:
        radius: Radius at the vertex, mm; infinity: a plane.
        terms: Coefficients by power of r, r in mm. Odd powers have no expansion at the vertex.
        k: Conic constant.
    """
    if not isinstance(terms, Mapping):
        raise UsageError(
            f"asphere: terms: wanted a dict of coefficients by power of r, got {short(terms)}"
        )
    powers = {
        whole(p, "asphere: power of r", 1, MAX_POWER): number(a, f"asphere: coefficient of r^{p}")
        for p, a in terms.items()
    }
    radius, k = _length(radius), number(k, "asphere: k")
    name = f"asphere({radius:g}, {powers}, {k:g})"
    return _form(name, "aspheric", curvature=1 / radius, conic=k, asphere=powers)


def cylinder(radius: float, axis: Literal["x", "y"] = "x", k: float = 0.0) -> Form:
    """Returns a cylinder with its axis along x or y; it has power across its axis.

    Args:
        radius: Radius, mm.
        axis: Direction of the axis, ``x`` or ``y``.
        k: Conic constant of the curved section.
    """
    if str(axis) not in ("x", "y"):
        raise UsageError(f"cylinder: axis: wanted 'x' or 'y', got {short(axis)}")
    radius, k = _length(radius), number(k, "cylinder: k")
    return _form(f"cylinder({radius:g}, {axis!r})", f"cyl-{axis}", curvature=1 / radius, conic=k)


def biconic(radius_x: float, radius_y: float, k_x: float = 0.0, k_y: float = 0.0) -> Form:
    """Returns a biconic: radius (mm) and conic constant for the sections x-z and y-z."""
    return _two("biconic", radius_x, radius_y, k_x, k_y)


def toroid(radius_x: float, radius_y: float, k_y: float = 0.0) -> Form:
    """Returns a toroid: the y-z section turned about an axis along y at radius_x, mm."""
    return _two("toroid", radius_x, radius_y, 0.0, k_y)


def _two(
    kind: Literal["biconic", "toroid"], radius_x: float, radius_y: float, k_x: float, k_y: float
) -> Form:
    x, y = _length(radius_x), _length(radius_y)
    return _form(
        f"{kind}({x:g}, {y:g})",
        kind,
        curvature=1 / y,
        curvature_x=1 / x,
        conic=number(k_y, f"{kind}: k_y"),
        conic_x=number(k_x, f"{kind}: k_x"),
    )


def _length(radius: float) -> float:
    """Checks a radius; plus or minus infinity is a plane."""
    given: Any = radius  # of any type yet
    endless = isinstance(given, float) and math.isinf(given)
    given = radius if endless else number(radius, "radius in mm")
    if not given or math.isinf(1 / given):
        raise UsageError(f"radius: wanted a length in mm other than 0, got {radius!r}")
    return float(given)


def _form(name: str, kind: str, *, curvature: float = 0.0, **more: Any) -> Form:
    air = _core.Glass.constant(1.0)
    return Form(name, _core.Surface(curvature, 0.0, math.inf, air, False, kind, **more))
