"""Curves from arrays: every basis is the curve that it says, and what is wrong is named."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.interpolate import BSpline

import daguerre as dg
from daguerre.labels.boxes import box_of
from daguerre.scene.framing import bounds
from daguerre.scene.parts import Curves
from daguerre.setup import scene as setup
from daguerre.setup.content_hash import content_hash
from tests.support.scene import scenes

Array = NDArray[np.float64]
RANDOM = np.random.default_rng(5)
POINTS = RANDOM.normal(size=(7, 3))


def added(points: Any = POINTS, counts: Any = None, widths: Any = 0.1, **keywords: Any) -> Curves:
    """The record of curves, one of all points if no counts are given."""
    scene = dg.Scene()
    scene.add_curves(points, [len(points)] if counts is None else counts, widths, **keywords)
    (made,) = scene.meshes
    assert isinstance(made, Curves)
    return made


def on_segments(made: Curves, u: float, rows: Any = None) -> Array:
    """Points of all segments at u, by De Casteljau's algorithm."""
    values = np.asarray(made.positions if rows is None else rows, np.float64)
    step = 3 if made.cubic else 1
    points = [values[made.starts.astype(int) + k] for k in range(step + 1)]
    while len(points) > 1:
        points = [a * (1 - u) + b * u for a, b in pairwise(points)]
    return np.asarray(points[0])


def de_boor(points: Array, u: float) -> Array:
    """Points of all segments of the uniform cubic B-spline."""
    spline = BSpline(np.arange(len(points) + 4.0), points, 3)
    return np.asarray(spline(3 + np.arange(len(points) - 3) + u))


def catmull_rom(points: Array, u: float) -> Array:
    """Points of all segments, by the pyramid of Barry and Goldman (1988) on even knots."""
    out = []
    for p in (points[i : i + 4] for i in range(len(points) - 3)):
        t = 1 + u
        a = [p[i] * (i + 1 - t) + p[i + 1] * (t - i) for i in range(3)]
        b = [a[i] * (i + 2 - t) / 2 + a[i + 1] * (t - i) / 2 for i in range(2)]
        out.append(b[0] * (2 - t) + b[1] * (t - 1))
    return np.array(out)


def mirrored(points: Array) -> Array:
    """Points with the one that a pinned curve adds at either end."""
    return np.array([2 * points[0] - points[1], *points, 2 * points[-1] - points[-2]])


@pytest.mark.parametrize("u", [0.0, 0.3, 0.75, 1.0])
@pytest.mark.parametrize("curve", [("bspline", de_boor), ("catmull-rom", catmull_rom)])
def test_splines_are_those_of_their_own_algorithms(
    curve: tuple[str, Callable[[Array, float], Array]], u: float
) -> None:
    basis, evaluated = curve
    around = np.array([*POINTS, *POINTS[:3]])
    for wrap, points in {
        "nonperiodic": POINTS,
        "periodic": around,
        "pinned": mirrored(POINTS),
    }.items():
        made = added(basis=basis, wrap=wrap)
        np.testing.assert_allclose(on_segments(made, u), evaluated(points, u), atol=1e-5)


def test_pinned_splines_reach_their_ends_and_closed_ones_close() -> None:
    for basis in ("bspline", "catmull-rom"):
        pinned = added(basis=basis, wrap="pinned")
        np.testing.assert_allclose(pinned.positions[[0, -1]], POINTS[[0, -1]], atol=1e-6)
    for basis in ("bspline", "catmull-rom", "bezier", "linear"):
        closed = added(POINTS[:6], basis=basis, wrap="periodic")
        np.testing.assert_array_equal(closed.positions[0], closed.positions[-1])
        assert closed.closed


def test_bezier_and_linear_points_are_kept_and_two_points_make_a_pinned_line() -> None:
    for basis in ("bezier", "linear"):
        for wrap in ("nonperiodic", "pinned"):
            made = added(basis=basis, wrap=wrap)
            np.testing.assert_array_equal(made.positions, POINTS.astype(np.float32))
            assert len(made.starts) == (2 if basis == "bezier" else 6)
    line = added(POINTS[:2], basis="bspline", wrap="pinned")
    for u in (0.0, 0.4, 1.0):
        np.testing.assert_allclose(
            on_segments(line, u), [POINTS[0] * (1 - u) + POINTS[1] * u], atol=1e-6
        )


def test_many_curves_are_each_by_itself() -> None:
    counts = [4, 7, 5]
    points = RANDOM.normal(size=(16, 3))
    widths = RANDOM.uniform(0.1, 1, 16)
    made = added(points, counts, widths, basis="catmull-rom")
    first = 0
    for k, count in enumerate(counts):
        part = slice(first, first + count)
        alone = added(points[part], [count], widths[part], basis="catmull-rom")
        begin = int(made.ends[k - 1]) if k else 0
        where = slice(int(made.starts[begin]), int(made.starts[made.ends[k] - 1]) + 4)
        np.testing.assert_array_equal(made.positions[where], alone.positions)
        np.testing.assert_array_equal(made.radii[where], alone.radii)
        first += count


def test_widths_are_diameters_of_all_of_a_curve_or_of_a_point() -> None:
    points, counts = RANDOM.normal(size=(8, 3)), [4, 4]
    assert set(added(points, counts, 0.5).radii) == {np.float32(0.25)}
    each = added(points, counts, [0.5, 1.0]).radii
    np.testing.assert_allclose(each, [0.25] * 4 + [0.5] * 4, rtol=1e-6)
    widths = RANDOM.uniform(0.2, 1, 8)
    per_point = added(points, counts, widths, basis="bspline")
    wanted = [de_boor(widths[k : k + 4, None], 0.3)[0] / 2 for k in (0, 4)]
    found = on_segments(per_point, 0.3, per_point.radii[:, None])
    np.testing.assert_allclose(found, wanted, rtol=1e-5)
    swings = added(POINTS, None, [1, 0, 1, 0, 1, 0, 1], basis="catmull-rom")
    assert (swings.radii >= 0).all()


def test_values_per_curve_stay_and_values_per_point_follow_the_curve() -> None:
    points, counts = RANDOM.normal(size=(8, 3)), [4, 4]
    made = added(points, counts, colors=[(1, 0, 0), (0, 1, 0)], uv=[(0.1, 0.2), (0.3, 0.4)])
    np.testing.assert_array_equal(made.colors, [(1, 0, 0, 1), (0, 1, 0, 1)])
    assert made.uv is not None
    assert made.uv.shape == (2, 2)
    uv = RANDOM.uniform(size=(8, 2))
    made = added(points, counts, uv=uv, basis="bspline")
    wanted = [de_boor(uv[k : k + 4], 0.6)[0] for k in (0, 4)]
    np.testing.assert_allclose(on_segments(made, 0.6, made.uv), wanted, rtol=1e-5)


# In the core ------------------------------------------------------------------------------------


@pytest.mark.parametrize("basis", ["bspline", "bezier", "catmull-rom", "linear"])
def test_rays_meet_the_curve_around_its_axis(basis: str) -> None:
    width = 0.02
    points = np.cumsum(RANDOM.uniform(0.2, 0.6, size=(7, 3)), axis=0)
    made = added(points, widths=width, basis=basis)
    scene = dg.Scene()
    scene.add_instance(scene.add_curves(points, [7], width, basis=basis))
    core = setup.build(scene)
    for u in (0.1, 0.5, 0.8):
        for segment, target in enumerate(on_segments(made, u)):
            along = (on_segments(made, u + 1e-4) - on_segments(made, u - 1e-4))[segment]
            across = np.cross(along, RANDOM.normal(size=3))
            across /= np.linalg.norm(across)
            hit = core.first_hit(tuple(target + 0.1 * across), tuple(-across))
            assert hit is not None
            assert hit[0] == pytest.approx(0.1 - width / 2, rel=2e-4)


def test_curves_are_where_their_instances_are_and_move_with_them() -> None:
    scene = dg.Scene()
    rod = scene.add_curves([(-1, 0, 0), (1, 0, 0)], [2], 0.2, basis="linear")
    scale = np.diag([1.0, 3.0, 0.5, 1.0])
    scene.add_instance(rod, transform=scenes.at(0, 0, -5) @ scale)
    scene.add_instance(rod, motion=dg.keys([(0, scenes.at(0, 2, 0)), (1, scenes.at(0, 4, 0))]))
    core = setup.build(scene, (0.0, 1.0))
    assert core.first_hit((0, 0, 0), (0, 0, -1)) == (pytest.approx(4.95), 0)
    assert core.first_hit((0, 0.29, 0), (0, 0, -1)) is not None
    assert core.first_hit((0, 0.31, 0), (0, 0, -1)) is None
    assert core.first_hit((0, 3, 5), (0, 0, -1)) == (pytest.approx(4.9), 1)
    low, high = core.bounds
    assert low == pytest.approx((-1.1, -0.3, -5.05), abs=1e-3)
    assert high == pytest.approx((1.1, 4.1, 0.1), abs=1e-3)


def test_points_over_time_are_those_of_the_moment() -> None:
    later = POINTS + np.array((0, 1, 0))
    for keywords in ({"steps": ([0.0, 2.0], [POINTS, later])}, {}):
        points = POINTS if keywords else dg.keys([(0.0, POINTS), (2.0, later)])
        scene = dg.Scene()
        scene.add_instance(scene.add_curves(points, [7], 0.1, **keywords))
        half = scene.at(1.0).meshes[0]
        assert isinstance(half, Curves)
        wanted = added(POINTS + np.array((0, 0.5, 0))).positions
        np.testing.assert_allclose(half.positions, wanted, atol=1e-6)
        core = setup.build(scene, (0.0, 2.0))
        assert core.bounds[1][1] == pytest.approx(
            float(added(later).positions[:, 1].max()) + 0.05, abs=1e-3
        )


# Everything that asks for meshes ----------------------------------------------------------------


def test_curves_pickle_compare_and_print() -> None:
    scene = dg.Scene()
    scene.add_instance(scene.add_curves(POINTS, [7], 0.1, name="wire"), name="wire")
    again = pickle.loads(pickle.dumps(scene))
    assert again == scene
    assert again.meshes[0] != added(POINTS, widths=0.2, name="wire")
    assert repr(scene.meshes[0]) == "<Curves 'wire': 1 curves, 4 segments>"
    assert "curves" in scene._repr_html_()
    assert content_hash(again) == content_hash(scene)
    thick = dg.Scene()
    thick.add_instance(thick.add_curves(POINTS, [7], 0.2, name="wire"), name="wire")
    assert content_hash(thick) != content_hash(scene)


def test_boxes_hold_the_thickness() -> None:
    scene = dg.Scene()
    rod = scene.add_curves([(0, 0, 0), (0, 2, 0)], [2], 0.4, basis="linear")
    scene.add_instance(rod, transform=scenes.at(1, 0, 0) @ np.diag([2.0, 1.0, 1.0, 1.0]))
    corners = bounds(scene)
    assert corners is not None
    np.testing.assert_allclose(corners, [(0.6, -0.2, -0.2), (1.4, 2.2, 0.2)], atol=1e-6)
    box = box_of(scene, [0])
    np.testing.assert_allclose(box.center, (1, 1, 0), atol=1e-6)
    np.testing.assert_allclose(box.size, (0.8, 2.4, 0.4), atol=1e-6)


def test_the_box_of_a_bent_curve_is_tight() -> None:
    bent = [(0, 0, 0), (0, 4, 0), (4, 4, 0), (4, 0, 0)]  # reaches y = 3
    scene = dg.Scene()
    scene.add_instance(scene.add_curves(bent, [4], 0.2, basis="bezier"))
    assert box_of(scene, [0]).size == pytest.approx((4.2, 3.2, 0.2), abs=1e-6)


# Bad input --------------------------------------------------------------------------------------

BAD: list[tuple[str, dict[str, Any], str]] = [
    ("shape", {"points": [[1, 2]]}, r"points: wanted shape \(N, 3\)"),
    ("nan", {"points": [(np.nan, 0, 0)] * 7}, r"points\[0\]: wanted finite"),
    ("huge", {"points": POINTS * 3e38}, "finite"),
    ("sum", {"counts": [4]}, "counts: wanted a sum of 7, the number of points, got 4"),
    ("few", {"counts": [4, 3]}, r"counts\[1\]: wanted at least 4 points \(bspline, nonperiodic\)"),
    ("negative", {"counts": [8, -1]}, r"counts\[1\]: wanted at least 4 .* got -1"),
    ("many", {"counts": [2**62, 7]}, r"counts\[0\]"),
    ("overflow", {"counts": np.array([2**64 - 1, 8], np.uint64)}, r"counts\[0\]"),
    ("fraction", {"counts": [7.0]}, "counts: wanted whole numbers"),
    ("nested", {"counts": [[7]]}, "counts: wanted whole numbers"),
    ("bezier", {"basis": "bezier", "counts": [5, 2]}, r"counts\[0\]: wanted 4, 7, 10, ... points"),
    ("ring", {"basis": "bezier", "wrap": "periodic"}, "wanted 3, 6, 9, ... points"),
    ("pinned", {"counts": [6, 1], "wrap": "pinned"}, r"counts\[1\]: wanted at least 2"),
    ("width", {"widths": -0.1}, r"widths\[0\]: wanted at least 0 m, got -0.1"),
    ("widths", {"widths": [0.1, 0.2]}, r"widths: wanted 1, 1 \(one per curve\) or 7"),
    ("matrix", {"widths": [[0.1]]}, "widths: wanted a width"),
    ("endless", {"widths": np.inf}, "widths.*wanted finite"),
    ("uv", {"uv": [(0, 0)] * 3}, r"uv: wanted 1 \(one per curve\) or 7 \(one per point\), got 3"),
    ("colors", {"colors": [(1, 1)]}, "colors: wanted shape"),
    ("steps", {"steps": [1]}, "steps: vertices per time step"),
    ("step", {"steps": ([0.0, 1.0], np.zeros((2, 5, 3)))}, "points: wanted 7 elements, got 5"),
]


@pytest.mark.parametrize(("values", "message"), [b[1:] for b in BAD], ids=[b[0] for b in BAD])
def test_what_is_wrong_is_named_and_nothing_is_added(values: dict[str, Any], message: str) -> None:
    scene = dg.Scene()
    given = {"points": POINTS, "counts": [7], "widths": 0.1, "name": "wire"} | values
    with pytest.raises(dg.InputError, match="curves 'wire': .*" + message):
        scene.add_curves(**given)
    assert not scene.meshes
    assert not scene.motion


def test_a_basis_that_is_none_is_refused() -> None:
    with pytest.raises(dg.UsageError, match="basis"):
        dg.Scene().add_curves(POINTS, [7], 0.1, basis="hermite")
    with pytest.raises(dg.UsageError, match="wrap"):
        dg.Scene().add_curves(POINTS, [7], 0.1, wrap="open")


@pytest.mark.parametrize("basis", ["bspline", "linear"])
@pytest.mark.parametrize("size", [1e-35, 1e-20, 1e-9, 1e-4, 1e6, 1e9])
def test_curves_of_any_size_are_met_or_not_and_end_nothing(size: float, basis: str) -> None:
    scene = dg.Scene()
    rod = scene.add_curves(
        np.array([(-1, 0, 0), (1, 0, 0)]) * size, [2], 0.2 * size, basis=basis, wrap="pinned"
    )
    scene.add_instance(rod)
    scene.add_instance(rod, transform=np.diag([1e8, 1e-8, 1e8, 1.0]))
    hit = setup.build(scene).first_hit((0, 0, min(3 * size, 1e17)), (0, 0, -1))
    if 1e-9 <= size <= 1e6:
        assert hit is not None


def test_points_that_are_nothing_beside_the_width_end_nothing() -> None:
    scene = dg.Scene()
    scene.add_instance(scene.add_curves(POINTS * 1e-30, [7], 1e17, basis="catmull-rom"))
    setup.build(scene).first_hit((0, 0, 3), (0, 0, -1))


def test_no_curves_and_points_at_one_place_are_nothing_to_see() -> None:
    scene = dg.Scene()
    scene.add_instance(scene.add_curves(np.zeros((0, 3)), np.zeros(0, int), 0.1))
    scene.add_instance(scene.add_curves(np.zeros((4, 3)), [4], 0.1))
    scene.add_instance(scene.add_curves(np.zeros((4, 3)), [4], 0))
    core = setup.build(scene)
    core.first_hit((0, 0, 3), (0, 0, -1))
    assert bounds(scene) is not None
