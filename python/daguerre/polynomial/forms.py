"""Forms of surfaces. A radius is positive when the centre lies ahead, as the light goes."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

import daguerre._core as _core
from daguerre.errors import UsageError


@dataclass(frozen=True, eq=False)
class Form:
    """The form of a surface about its vertex.

    Attributes:
        name: What it is.
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
    return _form(f"sphere({radius:g})", "spherical", curvature=_curvature(radius))


def conic(radius: float, k: float) -> Form:
    """A conic of revolution: radius at the vertex, mm, and conic constant (-1: paraboloid)."""
    return _form(f"conic({radius:g}, {k:g})", "aspheric", curvature=_curvature(radius), conic=k)


def asphere(radius: float, terms: Mapping[int, float], k: float = 0.0) -> Form:
    """A conic of revolution, to which powers of the distance from the axis are added.

    Args:
        radius: At the vertex, mm; infinity for none.
        terms: Power of r to its coefficient, r in mm. Odd powers have no expansion at the vertex.
        k: Conic constant.
    """
    if not all(int(p) == p and p >= 1 for p in terms):
        raise UsageError(f"asphere: powers of r: wanted whole numbers from 1, got {list(terms)}")
    return _form(
        f"asphere({radius:g}, {dict(terms)}, {k:g})",
        "aspheric",
        curvature=_curvature(radius),
        conic=k,
        asphere=dict(terms),
    )


def cylinder(radius: float, axis: Literal["x", "y"] = "x", k: float = 0.0) -> Form:
    """A cylinder whose axis lies along x or y, so that it bends light across that."""
    if axis not in ("x", "y"):
        raise UsageError(f"cylinder: axis: wanted 'x' or 'y', got {axis!r}")
    name = f"cylinder({radius:g}, {axis!r})"
    return _form(name, f"cyl-{axis}", curvature=_curvature(radius), conic=k)


def biconic(radius_x: float, radius_y: float, k_x: float = 0.0, k_y: float = 0.0) -> Form:
    """A radius and a conic constant for each of the sections x-z and y-z."""
    return _form(
        f"biconic({radius_x:g}, {radius_y:g})", "biconic", **_two(radius_x, radius_y, k_x, k_y)
    )


def toroid(radius_x: float, radius_y: float, k_y: float = 0.0) -> Form:
    """The section y-z turned about an axis along y through the centre of the section x-z."""
    return _form(
        f"toroid({radius_x:g}, {radius_y:g})", "toroid", **_two(radius_x, radius_y, 0.0, k_y)
    )


def _two(radius_x: float, radius_y: float, k_x: float, k_y: float) -> dict[str, float]:
    return {
        "curvature": _curvature(radius_y),
        "curvature_x": _curvature(radius_x),
        "conic": k_y,
        "conic_x": k_x,
    }


def _curvature(radius: float) -> float:
    if math.isnan(radius) or radius == 0:
        raise UsageError(f"radius: wanted a length in mm other than 0, got {radius!r}")
    return 1 / radius


def _form(name: str, kind: str, *, curvature: float = 0.0, **more: Any) -> Form:
    if not all(math.isfinite(v) for v in more.values() if isinstance(v, float)):
        raise UsageError(f"{name}: wanted finite numbers")
    air = _core.Glass.constant(1.0)
    return Form(name, _core.Surface(curvature, 0.0, math.inf, air, False, kind, **more))
