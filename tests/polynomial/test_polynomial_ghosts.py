"""Ghosts as polynomials against exact rays: matrices, falling errors, planted faults, reports."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import pytest

import daguerre as dg
import daguerre.polynomial as po
from daguerre import analysis
from daguerre.analysis.bench import Bench
from daguerre.analysis.ghost_trace import GhostRays, ghost_rays, stop_index, trace_ghost
from daguerre.analysis.ghosts import Ghosts, splat
from daguerre.errors import InputError, UsageError
from daguerre.polynomial import ghosts as module

BIOTAR = "zeiss-biotar-50mm-f1.4"


@pytest.fixture(scope="module")
def bench() -> Bench:
    return analysis.set_up(dg.lenses.load(BIOTAR), f_stop=8)


@pytest.fixture(scope="module")
def ghosts(bench: Bench) -> Ghosts:
    return Ghosts(bench, 5.0)


def slanted(angle_deg: float) -> tuple[float, float, float]:
    angle = math.radians(angle_deg)
    return 0.0, math.sin(angle), math.cos(angle)


def abcd(bench: Bench, far: int, near: int) -> tuple[float, float]:
    """A and B of a ghost from the first vertex to the film, by paraxial matrices, d-line."""
    surfaces, n = bench.lens.surfaces, [1.0]
    n += [s.core_glass.index(587.5618) for s in surfaces]

    def gap(k: int) -> np.ndarray:
        return np.array([[1, surfaces[k].thickness or 0.0], [0, 1]])

    def bend(k: int, back: bool) -> np.ndarray:
        curvature = 1 / surfaces[k].radius if surfaces[k].radius else 0.0
        before, behind = (n[k + 1], n[k]) if back else (n[k], n[k + 1])
        power = (behind - before) * (-curvature if back else curvature) / behind
        return np.array([[1, 0], [-power, before / behind]])

    def mirror(k: int, back: bool) -> np.ndarray:
        curvature = 1 / surfaces[k].radius
        return np.array([[1, 0], [2 * (-curvature if back else curvature), 1]])

    way = np.eye(2)
    for k in range(far):
        way = gap(k) @ bend(k, False) @ way
    way = mirror(far, False) @ way
    for k in range(far - 1, near, -1):
        way = bend(k, True) @ gap(k) @ way
    way = mirror(near, True) @ gap(near) @ way
    for k in range(near + 1, len(surfaces)):
        way = bend(k, False) @ gap(k - 1) @ way
    last = sum(s.thickness or 0.0 for s in surfaces[:-1])
    way = np.array([[1, bench.film_z - last], [0, 1]]) @ way
    return way[0, 0], way[0, 1]


@pytest.mark.parametrize("pair", [(2, 0), (8, 6), (10, 1), (6, 4)])
def test_degree_one_about_the_axis_is_the_matrix_of_the_ghost(
    bench: Bench, pair: tuple[int, int]
) -> None:
    light = ghost_rays(bench, pair, slanted(3), rays=100)
    places = light.rays[:, :2]
    found = po.expand_ghost(light, 1, about="axis").points(places, to_iris=False)
    a, b = abcd(bench, *pair)
    wanted = a * places + b * np.array(slanted(3)[:2])
    np.testing.assert_allclose(found, wanted, atol=1e-9 * np.abs(wanted).max())


@pytest.mark.parametrize("pair", [(2, 0), (8, 6), (10, 4)])
@pytest.mark.parametrize("degree", [1, 3, 5])
def test_the_error_falls_with_the_angle_as_the_degree_says(
    bench: Bench, pair: tuple[int, int], degree: int
) -> None:
    """About the axis, with the angle and the places both halved: by 2 to the degree + 2."""
    errors = []
    for share in (1.0, 0.5):
        angle = 2.0 * share
        light = ghost_rays(bench, pair, slanted(angle), rays=64)
        u = np.linspace(-share, share, 7)
        x, y = np.meshgrid(u, u)
        rays = np.stack([x, y, 0 * x, 0 * x + math.sin(math.radians(angle))], -1).reshape(-1, 4)
        light = dataclasses.replace(light, rays=rays)
        found = po.expand_ghost(light, degree, about="axis").points(rays[:, :2], to_iris=False)
        errors.append(np.hypot(*(found - light.points).T).max())
    assert np.log2(errors[0] / errors[1]) == pytest.approx(degree + 2, abs=0.4)


def test_the_error_falls_with_the_degree(ghosts: Ghosts) -> None:
    medians = [po.PolynomialGhosts(ghosts, degree, rays=400).median_error for degree in (1, 3, 5)]
    assert medians[0] > 10 * medians[1] > 100 * medians[2]
    assert medians[2] < 1e-4


def test_parallel_light_has_the_points_of_the_whole_polynomial(bench: Bench) -> None:
    light = ghost_rays(bench, (8, 6), slanted(5), rays=100)
    polynomial = po.expand_ghost(light, 7)
    found = polynomial.points(light.rays[:, :2], to_iris=False)
    np.testing.assert_allclose(found, polynomial.film(light.rays)[:, :2], atol=1e-10)


def test_exact_rays_are_those_of_the_list_of_ghosts(bench: Bench, ghosts: Ghosts) -> None:
    """Centre and radius of the light, which the list has from single precision and six colours."""
    for ghost in ghosts.all[:6]:
        points = ghost_rays(bench, ghost.surfaces[:2], slanted(5)).points
        points = points[np.isfinite(points[:, 0])]
        half = np.array(ghosts.film) / 2
        points = points[(np.abs(points) <= half).all(axis=1)]
        middle = points.mean(axis=0)
        assert middle == pytest.approx(ghost.center, abs=0.1)
        radius = math.sqrt(((points - middle) ** 2).sum(axis=1).mean())
        assert radius == pytest.approx(ghost.radius, rel=0.05)


def test_the_iris_stops_rays_at_each_crossing(bench: Bench) -> None:
    """Polynomials and exact rays agree where only the iris stops light."""
    k = stop_index(bench)
    pairs = [(8, 6), (10, 4), (2, 0)]
    assert [sum(min(p) < k < max(p) for _ in "x") for p in pairs] == [0, 1, 0]
    small = bench.stopped(16)
    for pair in pairs:
        light = ghost_rays(small, pair, slanted(2))
        polynomial = po.expand_ghost(light, 7)
        assert len(polynomial.iris) == (3 if min(pair) < k < max(pair) else 1)
        passed = np.isfinite(polynomial.points(light.rays[:, :2])[:, 0])
        assert 0.2 < light.passed.mean() < 0.95
        assert (passed != light.passed).mean() < 0.02


def test_the_window_holds_all_light(bench: Bench) -> None:
    """A window over the whole front finds no light outside the one that was searched."""
    light = ghost_rays(bench, (8, 6), slanted(5))
    low, high = light.rays[:, :2].min(axis=0), light.rays[:, :2].max(axis=0)
    front = bench.lens.surfaces[0].semi_diameter
    assert front is not None
    u = np.linspace(-front, front, 101)
    x, y = np.meshgrid(u, u)
    rays = np.stack([x, y, 0 * x, 0 * x + slanted(5)[1]], -1).reshape(-1, 4)
    passed = np.isfinite(trace_ghost(bench, (8, 6), rays)[:, 0])
    assert passed.sum() > 50
    assert ((rays[passed, :2] > low) & (rays[passed, :2] < high)).all()
    assert light.passed.mean() > 0.25


def test_swapped_surfaces_are_caught(ghosts: Ghosts, monkeypatch: pytest.MonkeyPatch) -> None:
    """A polynomial of another pair of surfaces is off by the size of its ghost."""
    right = po.PolynomialGhosts(ghosts, 5, rays=400)
    assert max(e.error for e in right.all[:8]) < 0.05
    reflecting, expand = ghosts.core.reflecting, module.from_lens

    def wrong(*arguments: Any, ghost: tuple[int, int], **keywords: Any) -> po.System:
        far, near = max(ghost), min(ghost)
        other = next(k for k in reflecting if k not in ghost and (k < stop) == (near < stop))
        return expand(*arguments, ghost=(far, other), **keywords)

    stop = stop_index(ghosts.bench)
    monkeypatch.setattr(module, "from_lens", wrong)
    found = po.PolynomialGhosts(ghosts, 5, rays=400)
    assert np.median([e.error for e in found.all[:8]]) > 1


def test_an_expansion_beyond_its_range_is_said_to_diverge() -> None:
    """The pupil of a Tessar is wide for the ghost of its outermost surfaces."""
    ghosts = Ghosts(analysis.set_up(dg.lenses.load("tessar-50mm-f2.8")), 10.0)
    steps = {
        degree: {e.ghost.surfaces: e for e in po.PolynomialGhosts(ghosts, degree, rays=900).all}
        for degree in (5, 7)
    }
    assert 0 < len([e for e in steps[7].values() if e.diverges]) < len(steps[7])
    for surfaces, error in steps[7].items():
        assert error.diverges == (error.error_mm > steps[5][surfaces].error_mm)


def test_numbers_of_the_whole(ghosts: Ghosts) -> None:
    found = po.PolynomialGhosts(ghosts, 3, rays=400)
    lit = [g for g in ghosts.all if g.light > 0]
    assert [e.ghost for e in found.all] == lit
    facts = found.facts()
    assert facts["median_error"] == np.median([e.error for e in found.all])
    assert facts["rays"] == 400 * sum(np.isfinite(e.exact).any() for e in found.all)
    assert min(facts["setup_s"], facts["exact_s"]) > 0
    for error in found.all:
        assert error.shift_mm <= error.error_mm
        assert error.error == pytest.approx(error.error_mm / error.radius_mm)


def test_pictures_of_both_hold_the_same_light(ghosts: Ghosts) -> None:
    found = po.PolynomialGhosts(ghosts, 7)
    exact, drawn = found.picture(36, exact=True), found.picture(36)
    assert exact.shape == (24, 36)
    assert drawn.sum() == pytest.approx(exact.sum(), rel=0.1)
    assert exact.sum() == pytest.approx(sum(g.light for g in ghosts.all), rel=0.1)  # 1 mm2 a pixel


def test_a_point_of_light_is_drawn_upright() -> None:
    """The film has right and left, up and down changed; light beside it is not drawn."""
    points = np.array([[-3.0, 2.0], [40.0, 0.0]])
    picture = splat(points, np.array([2.0, 5.0]), (20.0, 10.0), (100, 200))
    assert picture.sum() == 2
    assert np.argwhere(picture)[0].tolist() == [70, 130]


def test_a_ghost_without_light_has_no_middle(bench: Bench) -> None:
    dark = GhostRays(bench, (8, 6), 587.5618, np.array([[0.0, 0.0, 0.9, 0.0]]))
    with pytest.raises(InputError, match=r"ghost 8-6: no light of 587\.562 nm passes"):
        po.expand_ghost(dark, 3)


def test_a_surface_without_expansion_is_named(bench: Bench) -> None:
    """Odd powers of r have no Taylor series where the axis meets the vertex."""
    surfaces = list(bench.lens.surfaces)
    surfaces[3] = surfaces[3].replaced(kind="aspheric", asphere={5: 1e-8})
    odd = dataclasses.replace(bench, lens=bench.lens.rebuilt(surfaces))
    with pytest.raises(InputError, match=r"surface 3: Taylor expansion"):
        po.PolynomialGhosts(Ghosts(odd, 0.0), 3, rays=400)


@pytest.mark.parametrize(
    ("degree", "about", "message"),
    [(0, "light", "1 to 15"), (16, "light", "1 to 15"), (3, "rim", "wanted light or axis")],
)
def test_bad_arguments(bench: Bench, degree: int, about: str, message: str) -> None:
    light = ghost_rays(bench, (8, 6), slanted(5), rays=100)
    with pytest.raises(UsageError, match=message):
        po.expand_ghost(light, degree, about=about)  # type: ignore[arg-type]


def test_reflections_of_the_body_have_no_polynomials(bench: Bench) -> None:
    from daguerre._core import SensorStack

    with pytest.raises(UsageError, match="wanted the ghosts of a lens alone"):
        po.PolynomialGhosts(Ghosts(bench, 5.0, stack=SensorStack(reflectance=0.1)), 3)


def test_light_comes_toward_the_film(bench: Bench) -> None:
    with pytest.raises(UsageError, match="wanted z > 0"):
        ghost_rays(bench, (8, 6), (0, 0.1, -1))


def test_surfaces_that_do_not_exist_are_named(bench: Bench) -> None:
    with pytest.raises(InputError, match=r"ghost: wanted surfaces of 0 \.\. "):
        trace_ghost(bench, (-8, 2), np.zeros((1, 4)))
