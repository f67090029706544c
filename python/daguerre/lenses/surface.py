"""One surface of a lens as in its file, and its conversion for the core. Lengths in mm."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import daguerre._core as _core
from daguerre.argument_checks import guarded

from .dispersion_rule import DispersionRule
from .medium import Medium

#: Values that ``kind`` may have.
KINDS = ("spherical", "stop", "aspheric", "cyl-x", "cyl-y", "biconic", "toroid")
#: Kinds with different curvatures in their two sections.
TWO_SECTIONS = ("biconic", "toroid")

Triple = tuple[float, float, float]


@guarded(init=True)
@dataclass(frozen=True)
class LensSurface:
    """One surface and the medium that follows. Lengths in mm, z along the axis toward the film.

    Attributes:
        kind: One of ``KINDS``. ``cyl-x``: a cylinder with its axis along x.
        radius: Signed radius of curvature, positive when the centre lies toward the film; None: a
            plane. For a cylinder: of its curved section. For a biconic or toroid: in the y-z plane.
        thickness: Distance to the next vertex; for the last surface to the film, None or 0 if
            unknown.
        semi_diameter: Clear semi-diameter; None: unknown, the surface stops no light.
        glass: Name or nd/Vd of the glass that follows; empty: air.
        stop: Whether the iris lies at this surface.
        medium: Medium that follows.
        conic: Conic constant k; 0: sphere, -1: paraboloid.
        asphere: Coefficients added to the sag, by power of r = hypot(x, y).
        radius_x: Radius in the x-z plane of a biconic or toroid.
        conic_x: Conic constant in the x-z plane of a biconic.
        inner_semi_diameter: Semi-diameter of a central obstruction; 0: none.
        semi_diameter_after: Clear semi-diameter of the medium that follows, where elements differ;
            None: the same.
        decenter: Shift of the vertex; later surfaces do not move with it.
        tilt: Rotations about x, then the turned y, then the turned z, at the vertex, degrees.
        coating: Name of the coating; empty: the lens's.
        ripple: Grooves left by grinding: RMS height (nm), period (um), seed; height 0: none.
        derived: Whether the semi-diameter was derived by tracing rays, not given by the source.
        dispersion: Rule that gave the glass that follows its dispersion; None: air, or unknown.
        widened_from: Semi-diameter in the source, which blocks a corner's light even stopped down;
            None: the semi-diameter is the source's.
        fitted: Whether it is a mount, a plane in air, fitted to the product's measured vignetting.
    """

    kind: str
    radius: float | None
    thickness: float | None
    semi_diameter: float | None
    glass: str
    stop: bool
    medium: Medium = field(repr=False)
    conic: float = 0.0
    asphere: dict[int, float] = field(default_factory=dict)
    radius_x: float | None = None
    conic_x: float = 0.0
    inner_semi_diameter: float = 0.0
    semi_diameter_after: float | None = None
    decenter: Triple = (0.0, 0.0, 0.0)
    tilt: Triple = (0.0, 0.0, 0.0)
    coating: str = ""
    ripple: tuple[float, float, int] = (0.0, 0.0, 0)
    derived: bool = False
    dispersion: DispersionRule | None = None
    widened_from: float | None = None
    fitted: bool = False

    def replaced(self, **changes: object) -> LensSurface:
        """Returns a copy with some fields changed."""
        return dataclasses.replace(self, **dict[str, Any](changes))

    @property
    def core_glass(self) -> _core.Glass:
        """Returns the medium that follows as the core's glass."""
        return self.medium.core

    def core(self) -> _core.Surface:
        """Returns the surface for the core."""
        clear = math.inf if self.semi_diameter is None else self.semi_diameter
        return _core.Surface(
            _curvature(self.radius),
            self.thickness or 0.0,
            clear,
            self.medium.core,
            self.stop,
            self.kind,
            conic=self.conic,
            asphere=self.asphere,
            curvature_x=_curvature(self.radius_x),
            conic_x=self.conic_x,
            inner_semi_diameter=self.inner_semi_diameter,
            semi_diameter_after=self.semi_diameter_after or 0.0,
            decenter=self.decenter,
            tilt=self.tilt,
            coating=self.coating,
            ripple=self.ripple,
        )


def stop_of(surfaces: Sequence[LensSurface]) -> int:
    """Index of the stop."""
    return next(i for i, surface in enumerate(surfaces) if surface.stop)


def bounding(surfaces: Sequence[LensSurface]) -> list[int]:
    """Indices of surfaces that bound an element or an air gap: all but planes within air."""
    before = [True, *(not s.glass for s in surfaces)]
    return [
        i
        for i, s in enumerate(surfaces)
        if s.glass or not (s.kind == "stop" or _apart(s, before[i]))
    ]


def _apart(surface: LensSurface, behind_air: bool) -> bool:
    """Whether a surface with air behind it is a plane, as of a mount, with air before it."""
    return (
        behind_air
        and surface.radius is None
        and not surface.asphere
        and surface.kind == "spherical"
    )


def _curvature(radius: float | None) -> float:
    return 0.0 if radius is None else 1 / radius
