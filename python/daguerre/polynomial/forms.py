"""Forms of surfaces. A radius is positive when the centre lies ahead, as the light goes."""

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
    """The form of a surface about its vertex.

    Attributes:
        name: Name of the form.
        surface: The core's version.
    """

    name: str
    surface: _core.Surface

    def __repr__(self) -> str:
        return self.name


def plane() -> Form:
    """A plane across the axis."""
    return _form("plane()", "spherical")


def sphere(radius: float) -> Form:
    """A sphere of a radius, mm."""
    radius = _length(radius)
    return _form(f"sphere({radius:g})", "spherical", curvature=1 / radius)


def conic(radius: float, k: float) -> Form:
    """A conic of revolution: radius at the vertex, mm, and conic constant (-1: paraboloid)."""
    radius, k = _length(radius), number(k, "conic: k")
    return _form(f"conic({radius:g}, {k:g})", "aspheric", curvature=1 / radius, conic=k)


def asphere(radius: float, terms: Mapping[int, float], k: float = 0.0) -> Form:
    """A conic of revolution, to which powers of the distance from the axis are added.

    Args:
        radius: At the vertex, mm; infinity for none.
        terms: Power of r to its coefficient, r in mm. Odd powers have no expansion at the vertex.
        k: Conic constant.
    """
    if not isinstance(terms, Mapping):
        raise UsageError(f"asphere: wanted powers of r and their factors, got {short(terms)}")
    powers = {
        whole(p, "asphere: powers of r", 1, MAX_POWER): number(a, f"asphere: factor of r^{p}")
        for p, a in terms.items()
    }
    radius, k = _length(radius), number(k, "asphere: k")
    name = f"asphere({radius:g}, {powers}, {k:g})"
    return _form(name, "aspheric", curvature=1 / radius, conic=k, asphere=powers)


def cylinder(radius: float, axis: Literal["x", "y"] = "x", k: float = 0.0) -> Form:
    """A cylinder whose axis lies along x or y, so that it bends light across that."""
    if str(axis) not in ("x", "y"):
        raise UsageError(f"cylinder: axis: wanted 'x' or 'y', got {short(axis)}")
    radius, k = _length(radius), number(k, "cylinder: k")
    return _form(f"cylinder({radius:g}, {axis!r})", f"cyl-{axis}", curvature=1 / radius, conic=k)


def biconic(radius_x: float, radius_y: float, k_x: float = 0.0, k_y: float = 0.0) -> Form:
    """A radius and a conic constant for each of the sections x-z and y-z."""
    return _two("biconic", radius_x, radius_y, k_x, k_y)


def toroid(radius_x: float, radius_y: float, k_y: float = 0.0) -> Form:
    """The section y-z turned about an axis along y through the centre of the section x-z."""
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
    """A radius; either infinity is that of a plane."""
    given: Any = radius  # of any type yet
    endless = isinstance(given, float) and math.isinf(given)
    given = radius if endless else number(radius, "radius in mm")
    if not given or math.isinf(1 / given):
        raise UsageError(f"radius: wanted a length in mm other than 0, got {radius!r}")
    return float(given)


def _form(name: str, kind: str, *, curvature: float = 0.0, **more: Any) -> Form:
    air = _core.Glass.constant(1.0)
    return Form(name, _core.Surface(curvature, 0.0, math.inf, air, False, kind, **more))
