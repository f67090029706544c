"""Guided rays against brute force: every lens, stop, place and wavelength exposes as it should."""

from __future__ import annotations

import math
import zlib
from dataclasses import dataclass
from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray

import daguerre as dg
from daguerre import _core
from daguerre.lenses import library

Array = NDArray[np.float64]
NM = (420.0, 550.0, 700.0)


@dataclass(frozen=True)
class Case:
    """A lens, and what is done to it."""

    name: str
    zoom_mm: float | None = None
    tilt: tuple[float, float] = (0.0, 0.0)
    decentered: bool = False
    half_mm: float = 20.0


FAST = (
    Case("double-gauss-50mm-f2"),
    Case("double-gauss-50mm-f2", tilt=(3.0, -6.0)),
    Case("double-gauss-50mm-f2", decentered=True),
    Case("schneider-anamorphic-60mm", half_mm=12.0),
    Case("nikon-ai-80-200mm-f4"),
    Case("nikon-fisheye-6mm-f5.6", half_mm=4.5),
)


@cache
def prescription(case: Case) -> tuple[_core.Prescription, float, float]:
    """The lens focused at 3 m or 60 focal lengths, z of its film, and its rear semi-diameter."""
    lens = dg.lenses.load(case.name)
    if case.decentered:
        lens = lens.decentered((0, 3), (0.4, -0.3), (0.2, 0.5))
    distance = max(3.0, 0.06 * abs(lens.first_order().efl))
    focused = lens.focused(distance)
    # Glass before the film may have no mount of its own: what comes through the others to the film.
    mounts = [s.semi_diameter for s in lens.surfaces if math.isfinite(s.semi_diameter)]
    last = lens.surfaces[-1]
    rear = min(last.semi_diameter, max(mounts) + case.half_mm)
    # From the rim of a strongly curved surface light goes on outward to the plane of its vertex.
    rear += rear**2 / abs(last.radius) if last.radius else 0
    return focused.lens.prescription, focused.film_z_mm, rear


class BruteForce:
    """E / L at a film point in double, through the reference tracer; nothing is aimed.

    Points behind the rear vertex; G = cos cos / d^2 with the film's own normal.
    """

    def __init__(
        self, lens: _core.Prescription, exact: _core.ExactLens, film: Array, nm: float
    ) -> None:
        self.lens, self.exact, self.nm = lens, exact, nm
        center, x, y = (np.array(v) for v in exact.film_plane())
        self.origin = center - film[0] * x - film[1] * y
        self.normal = np.cross(x, y)

    def through(self, rear: Array) -> Array:
        """T G for points (N, 2) on the plane of the rear vertex."""
        n = len(rear)
        target = np.column_stack([rear, np.full(n, self.lens.vertices()[-1])])
        way = target - self.origin
        distance = np.linalg.norm(way, axis=1)
        way /= distance[:, None]
        origins = np.tile(self.origin, (n, 1))
        *_, iris, _, transmittance, stopped = self.lens.rays(
            origins, way, np.full(n, self.nm), True, False
        )
        opened = np.hypot(iris[:, 0], iris[:, 1]) <= self.exact.iris_radius_mm
        geometry = (way @ self.normal) * way[:, 2] / distance**2
        return np.where((stopped < 0) & opened, transmittance * geometry, 0)

    def lit_box(self, radius: float) -> tuple[Array, Array]:
        """Corners of a box around what a grid finds at the rear; equal ones: nothing."""
        # Where the glass ends close to the film, light crosses its rear close to the film point.
        reach = 2.5 * abs(self.lens.vertices()[-1] - self.origin[2])
        corner = np.maximum(self.origin[:2] - reach, -radius)
        size = np.minimum(self.origin[:2] + reach, radius) - corner
        for side in (128, 512):
            grid = corner + size * midpoints(side)
            lit = grid[self.through(grid) > 0]
            if len(lit):
                return lit.min(0) - 3 * size / side, lit.max(0) + 3 * size / side
        return corner, corner

    def estimate(self, radius: float, count: int, seed: int) -> tuple[float, float]:
        """Mean and its variance, from points uniform over the box."""
        low, high = self.lit_box(radius)
        random = np.random.default_rng(seed)
        e = self.through(low + (high - low) * random.random((count, 2))) * np.prod(high - low)
        return float(e.mean()), float(e.var() / count)

    def quadrature(self, radius: float) -> float:
        """The mean by midpoints of the box."""
        low, high = self.lit_box(radius)
        e = self.through(low + (high - low) * midpoints(320)) * np.prod(high - low)
        return float(e.mean())


def midpoints(side: int) -> Array:
    """Midpoints of side x side squares that fill the unit square: (N, 2)."""
    line = (np.arange(side) + 0.5) / side
    return np.stack(np.meshgrid(line, line), 2).reshape(-1, 2)


def guided(
    exact: _core.ExactLens, film: Array, nm: float, count: int, seed: int
) -> tuple[float, float]:
    """The same by the renderer's own rays."""
    random = np.random.default_rng(seed)
    points = np.broadcast_to(film, (count, 2)).astype(np.float32)
    u_lens = random.random((count, 2)).astype(np.float32)
    weight = exact.generate(points, u_lens, np.full(count, nm, np.float32))[2] * exact.h0
    return float(weight.mean()), float(weight.var() / count)


Comparison = tuple[float, float, float, float]  # drawn, its variance, brute force, its variance


DRAWN = {"guided": _core.PupilDraw.aimed, "boxes": _core.PupilDraw.slope_boxes}


def comparisons(case: Case, rays: int) -> dict[str, list[Comparison]]:
    """At 5 film radii x 3 stops, wavelengths in turn."""
    lens, film_z, rear = prescription(case)
    widest = lens.first_order(587.5618).f_number
    found: dict[str, list[Comparison]] = {"guided": [], "boxes": []}
    seed = zlib.crc32(repr(case).encode()) % 10**6
    for stop, f_stop in enumerate((widest, 2 * widest, 4 * widest)):
        exact = {
            kind: _core.ExactLens(
                lens,
                _core.ExactLensSettings(
                    f_stop=f_stop,
                    half_diagonal_mm=case.half_mm,
                    draw=DRAWN[kind],
                    film_z_mm=film_z,
                    tilt_deg=case.tilt,
                ),
            )
            for kind in found
        }
        for i in range(5):
            seed += 1
            radius, angle = case.half_mm * i / 4.2, 2.4 * i + stop
            film = radius * np.array([math.cos(angle), math.sin(angle)])
            nm = NM[seed % 3]
            brute_force = BruteForce(lens, exact["guided"], film, nm)
            e, variance = brute_force.estimate(1.3 * rear, rays, seed)
            for kind in found:
                drawn, v = guided(exact[kind], film, nm, 8192, seed + 10**6 * (kind == "boxes"))
                if e > 0 or drawn > 0:
                    found[kind].append((drawn, v, e, variance))
    return found


def scores(found: list[Comparison], fault: float = 1.0) -> list[float]:
    """z scores; with a fault, those of a density that is off by that factor."""
    return [(fault * a - b) / math.sqrt(fault**2 * v + w) for a, v, b, w in found]


def accepted(values: list[float], alpha: float = 1e-3) -> bool:
    """Family-wise: the largest by Sidak's correction, and the sum of squares."""
    n = len(values)
    worst = math.erfc(max(abs(v) for v in values) / math.sqrt(2))
    squares = sum(v * v for v in values)
    # Wilson and Hilferty's cube root makes chi-square nearly normal.
    normal = ((squares / n) ** (1 / 3) - (1 - 2 / (9 * n))) / math.sqrt(2 / (9 * n))
    return worst > 1 - (1 - alpha) ** (1 / n) and 0.5 * math.erfc(normal / math.sqrt(2)) > alpha


def test_guided_is_boxes_is_brute_force() -> None:
    found: dict[str, list[Comparison]] = {"guided": [], "boxes": []}
    for case in FAST:
        for kind, values in comparisons(case, 1 << 13).items():
            found[kind] += values
    assert len(found["guided"]) > 75
    for values in found.values():
        assert accepted(scores(values)), max(scores(values), key=abs)
    # A density that is off by three percent is caught.
    assert not accepted(scores(found["guided"], 1.03))


@pytest.mark.parametrize("case", [FAST[0], FAST[4], FAST[5]], ids=lambda c: c.name)
def test_nothing_is_lost_or_gained_at_the_corner(case: Case) -> None:
    """Both sides by quadrature, where a fault in a part of the iris would drown in noise."""
    lens, film_z, rear = prescription(case)
    f_stop = 1.4 * lens.first_order(587.5618).f_number
    settings = _core.ExactLensSettings(
        f_stop=f_stop, half_diagonal_mm=case.half_mm, film_z_mm=film_z
    )
    exact = _core.ExactLens(lens, settings)
    film = 0.95 * case.half_mm * np.array([0.8, 0.6])
    side = 480
    u_lens = midpoints(side).astype(np.float32)
    points = np.broadcast_to(film, (side * side, 2)).astype(np.float32)
    nm = np.full(side * side, 550, np.float32)
    drawn = exact.generate(points, u_lens, nm)[2].mean() * exact.h0
    e = BruteForce(lens, exact, film, 550.0).quadrature(rear)
    assert drawn == pytest.approx(e, rel=4e-3)


@pytest.mark.slow
@pytest.mark.parametrize("name", library.names())
def test_every_lens_of_the_library(name: str) -> None:
    lens = dg.lenses.load(name)
    order = lens.first_order()
    circle = lens.nominal.image_circle_mm or 0.4 * abs(order.efl)
    found = comparisons(Case(name, half_mm=circle / 2), 1 << 14)
    # One family: all lenses, guided and boxes.
    alpha = 1e-3 / (2 * len(library.names()))
    for values in found.values():
        assert accepted(scores(values), alpha), max(scores(values), key=abs)


@pytest.mark.parametrize("curvature", [0.0, -0.5], ids=["pentagon", "star"])
def test_exposure_is_the_same_at_every_azimuth(curvature: float) -> None:
    lens = dg.lenses.load("double-gauss-50mm-f2").prescription
    iris = _core.Iris.polygon(5, 7.0, curvature)
    exact = _core.ExactLens(lens, _core.ExactLensSettings(f_stop=5.6, iris=iris))
    side = 256
    u_lens = midpoints(side).astype(np.float32)
    nm = np.full(side * side, 550, np.float32)
    e = []
    for angle in np.arange(15) * 2 * math.pi / 15:
        film = 12 * np.array([[math.cos(angle), math.sin(angle)]], np.float32)
        e.append(exact.generate(np.repeat(film, side * side, 0), u_lens, nm)[2].mean())
    assert max(e) / min(e) - 1 < 1.5e-3


def test_light_on_the_film_is_light_into_the_pupil() -> None:
    """Etendue: the sum of E dA is the flux from the front that lands there, times T."""
    lens = dg.lenses.load("double-gauss-50mm-f2").prescription
    exact = _core.ExactLens(lens, _core.ExactLensSettings(f_stop=2.8, half_diagonal_mm=15.0))
    random = np.random.default_rng(5)
    n = 1 << 17
    radius, angle = 14.0 * np.sqrt(random.random(n)), 2 * math.pi * random.random(n)
    film = np.stack([radius * np.cos(angle), radius * np.sin(angle)], 1).astype(np.float32)
    u_lens = random.random((n, 2)).astype(np.float32)
    weight = exact.generate(film, u_lens, np.full(n, 550, np.float32))[2] * exact.h0
    on_film, film_error = (math.pi * 14.0**2 * f(weight) for f in (np.mean, np.std))
    # From the front: a disc before the first vertex, directions within a cone.
    m, disc, half_angle = 1 << 19, 28.0, math.radians(22)
    r, phi = disc * np.sqrt(random.random(m)), 2 * math.pi * random.random(m)
    start = np.stack([r * np.cos(phi), r * np.sin(phi), np.full(m, -4.0)], 1)
    cosine = 1 - random.random(m) * (1 - math.cos(half_angle))
    sine, turn = np.sqrt(1 - cosine**2), 2 * math.pi * random.random(m)
    way = np.stack([sine * np.cos(turn), sine * np.sin(turn), cosine], 1)
    p, d, iris, _, transmittance, stopped = lens.rays(start, way, np.full(m, 550.0), True)
    passed = (stopped < 0) & (np.hypot(iris[:, 0], iris[:, 1]) <= exact.iris_radius_mm)
    hit = p + d * ((exact.film_z_mm - p[:, 2]) / d[:, 2])[:, None]
    passed &= np.hypot(hit[:, 0], hit[:, 1]) <= 14.0
    flux = np.where(passed, transmittance * cosine, 0)
    space = math.pi * disc**2 * 2 * math.pi * (1 - math.cos(half_angle))
    into_lens, lens_error = (space * f(flux) for f in (np.mean, np.std))
    sigma = math.hypot(film_error / math.sqrt(n), lens_error / math.sqrt(m))
    assert sigma < 0.01 * on_film
    assert abs(on_film - into_lens) < 4 * sigma
