"""Plan of a fitted lens: the numbers that code in any language is made from."""

from __future__ import annotations

from dataclasses import dataclass

from .horner import Terms

Pair = tuple[float, float]


@dataclass(frozen=True)
class Vector:
    """Two components as polynomials.

    With axial symmetry the vector is f A + q B, with A and B (``first``, ``second``) in s = f.q,
    2 |q|^2 - 1, U (|f|^2, its range mapped to [-1, 1]) and l. Without, they are its x and y in q.x,
    q.y, f.x, f.y and l.
    """

    first: Terms
    second: Terms


@dataclass(frozen=True)
class Mount:
    """Surface with a rim that cuts rays: the point where rays meet it, and its clear radii, mm."""

    surface: int
    point: Vector
    clear_mm: float
    inner_mm: float = 0.0


@dataclass(frozen=True)
class Segment:
    """A lens's polynomials for film points with u_low <= |f|^2 < u_high.

    Attributes:
        bend: Vector added to q for the direction; None: nothing.
        direction: theta (dx, dy) / sin(theta) of the ray toward the scene, rad.
        offset_mm: Vector from the centre of the entrance pupil to the ray, perpendicular to it.
        iris_mm: Point where the ray crosses the iris.
        transmittance: Transmittance of the glass in the same variables (symmetric: the form A).
        mounts: Rims that can cut rays.
    """

    u_low: float
    u_high: float
    direction: Vector
    offset_mm: Vector
    iris_mm: Vector
    transmittance: Terms
    mounts: tuple[Mount, ...]
    bend: Vector | None = None


@dataclass(frozen=True)
class Blades:
    """An iris with edges, straight or arcs, in units of the iris radius (core/optics/lens/stop.h).

    Attributes:
        edges: Unit vectors to the middles of the edges.
        apothem: Distance of straight edges.
        bend: 1: arcs bent outward; -1: inward; 0: straight.
        center: Distance of the arcs' centres, along the vectors.
        arc_radius: Radius of the arcs.
        outer: Radius of the circle around the opening.
    """

    edges: tuple[Pair, ...]
    apothem: float
    bend: int = 0
    center: float = 0.0
    arc_radius: float = 0.0
    outer: float = 1.0


@dataclass(frozen=True)
class Aim:
    """Film slope m(f, a) that reaches iris point a, in units of ``radius_mm``.

    It only chooses slopes; the polynomials of `Segment` trace the rays.
    """

    slope: Vector
    radius_mm: float
    enlargement: float
    orientation: float = 1.0  # sign of det dm/da, where m does not fold back


@dataclass(frozen=True)
class LensPlan:
    """A lens at one focus distance; it can be stopped down.

    Lens frame: mm, +z from the scene to the film, z = 0 at the first vertex.

    Attributes:
        symmetric: Whether vectors have the form for axial symmetry.
        film_center_mm: f = (film point - center) / half.
        film_half_mm: Half size of the covered film; with axial symmetry its radius, in both.
        q_by_film: q = by_film f + by_slope m + shift, m the ray's slope dx/dz, dy/dz, each by x
            and y; the clear pupil fills |q| <= 1.
        wavelength: l = wavelength[0] + wavelength[1] / (wavelength in um)^2.
        front_z_mm: Vertex of the sphere on which rays start; a ray that misses it starts at its
            point nearest to the centre of the entrance pupil.
        front_curvature: Curvature of that sphere, 1/mm.
        f_stop: F-stop wide open.
        iris_radius_mm: Radius of a circle with the area of the iris at that f-stop.
        blades: Edges of the iris; None: round.
        exposure: Divisor of weights, so that a white world of luminance 1 is 1 on the axis:
            coefficients of o^2, o^4, ..., with o the share of the iris radius that is open.
    """

    name: str
    film_z_mm: float
    symmetric: bool
    film_center_mm: Pair
    film_half_mm: Pair
    q_by_film: Pair
    q_by_slope: Pair
    q_shift: Pair
    wavelength: Pair
    pupil_z_mm: float
    front_z_mm: float
    front_curvature: float
    f_stop: float
    iris_radius_mm: float
    blades: Blades | None
    segments: tuple[Segment, ...]
    aim: Aim | None = None
    exposure: tuple[float, ...] = (1.0,)
