"""BasisCurves: their widths, and counts that do not fit."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pxr import Usd, UsdGeom

import daguerre as dg
from tests.support.formats import stages

_COUNTS = (2, 3)
_POINTS = [(0, 0, 0), (0, 1, 0), (1, 0, 0), (1, 1, 0), (1, 2, 1)]
_NO_WIDTHS = "curves without widths have a width of 1 (1 use)"


@pytest.fixture
def stage(tmp_path: Path) -> Usd.Stage:
    return stages.new_stage(tmp_path / "x.usda")


def _curves(
    stage: Usd.Stage, points: Any = _POINTS, counts: Any = _COUNTS, basis: str = "linear"
) -> UsdGeom.BasisCurves:
    made = UsdGeom.BasisCurves.Define(stage, "/hair")
    made.CreatePointsAttr(stages.vectors(points))
    made.CreateCurveVertexCountsAttr(list(counts))
    made.CreateTypeAttr("linear" if basis == "linear" else "cubic")
    if basis != "linear":
        made.CreateBasisAttr(basis)
    return made


def _noted(scene: dg.Scene) -> list[str]:
    return [note for note in scene.warnings if "width" in note]


@pytest.mark.parametrize("interpolation", ["constant", "uniform", "vertex", "varying"])
def test_one_width_is_that_of_all_curves(stage: Usd.Stage, interpolation: str) -> None:
    made = _curves(stage)
    made.CreateWidthsAttr([0.4])
    made.SetWidthsInterpolation(interpolation)
    scene = stages.read(stage)
    assert np.allclose(scene.meshes[0].radii, 0.2)
    assert _noted(scene) == []


@pytest.mark.parametrize(
    ("interpolation", "widths", "radii"),
    [
        ("uniform", [0.2, 0.4], [0.1, 0.1, 0.2, 0.2, 0.2]),
        ("vertex", [0.2, 0.4, 0.6, 0.8, 1], [0.1, 0.2, 0.3, 0.4, 0.5]),
        ("varying", [0.2, 0.4, 0.6, 0.8, 1], [0.1, 0.2, 0.3, 0.4, 0.5]),
    ],
)
def test_widths_of_curves_and_of_points(
    stage: Usd.Stage, interpolation: str, widths: list[float], radii: list[float]
) -> None:
    made = _curves(stage)
    made.CreateWidthsAttr(widths)
    made.SetWidthsInterpolation(interpolation)
    scene = stages.read(stage)
    assert np.allclose(scene.meshes[0].radii, radii)
    assert _noted(scene) == []


@pytest.mark.parametrize("basis", ["linear", "bspline", "bezier", "catmullRom"])
def test_curves_without_widths_have_a_width_of_1(stage: Usd.Stage, basis: str) -> None:
    """Several curves, so that one default is not one for each curve by chance."""
    points = np.random.default_rng(0).normal(size=(12, 3))
    _curves(stage, points, (4, 4, 4), basis)
    scene = stages.read(stage)
    assert np.allclose(scene.meshes[0].radii, 0.5)
    assert _noted(scene) == [_NO_WIDTHS]


@pytest.mark.parametrize("interpolation", ["constant", "uniform", "vertex", "varying"])
@pytest.mark.parametrize("count", [3, 7])
def test_widths_of_another_number_are_noted(
    stage: Usd.Stage, interpolation: str, count: int
) -> None:
    made = _curves(stage)
    made.CreateWidthsAttr([0.1] * count)
    made.SetWidthsInterpolation(interpolation)
    scene = stages.read(stage)
    assert np.allclose(scene.meshes[0].radii, 0.5)
    (length, default) = _noted(scene)
    assert length.startswith("primvar 'widths' has the wrong number of values for its mesh")
    assert default == _NO_WIDTHS


def test_varying_widths_stand_at_the_ends_of_segments(stage: Usd.Stage) -> None:
    points = [(x, 0, 0) for x in range(7)]
    made = _curves(stage, points, (7,), "bezier")
    made.CreateWidthsAttr([0.2, 0.8, 0.2])
    made.SetWidthsInterpolation("varying")
    scene = stages.read(stage)
    assert np.allclose(scene.meshes[0].radii, [0.1, 0.2, 0.3, 0.4, 0.3, 0.2, 0.1])


_CUT = "a curve with a number of points that does not fit its basis is shortened or left out"


@pytest.mark.parametrize(
    ("basis", "wrap", "counts", "kept", "cut"),
    [
        ("bezier", "nonperiodic", (8, 4, 3), (7, 4), 2),
        ("bezier", "periodic", (4, 6, 2), (3, 6), 2),
        ("bspline", "pinned", (1, 2, 5), (2, 5), 1),
        ("catmullRom", "nonperiodic", (3, 4), (4,), 1),
        ("linear", "nonperiodic", (0, 3, 1), (3,), 2),
    ],
)
@pytest.mark.parametrize("each", ["curve", "point"])
def test_points_that_a_basis_cannot_use_are_left_out(
    tmp_path: Path, basis: str, wrap: str, counts: Any, kept: Any, cut: int, each: str
) -> None:
    rng = np.random.default_rng(5)
    fits = {8: 7, 4: 4, 3: 0} if wrap == "nonperiodic" else {4: 3, 6: 6, 2: 0}
    if basis in ("bspline", "catmullRom", "linear"):
        fits = {count: count if count in kept else 0 for count in counts}
    points = [rng.normal(size=(count, 3)) for count in counts]
    size = [1 if each == "curve" else count for count in counts]
    widths = [rng.uniform(0.1, 1, n) for n in size]
    kind = "uniform" if each == "curve" else "vertex"

    def read(name: str, points: Any, counts: Any, widths: Any) -> dg.Scene:
        stage = stages.new_stage(tmp_path / name)
        made = _curves(stage, np.concatenate(points), counts, basis)
        made.CreateWrapAttr(wrap)
        made.CreateWidthsAttr(np.concatenate(widths).astype(np.float32).tolist())
        made.SetWidthsInterpolation(kind)
        return stages.read(stage)

    scene = read("x.usda", points, counts, widths)
    left = [(p[:fit], w[:fit]) for p, w, c in zip(points, widths, counts, strict=True)
            if (fit := fits[c])]  # fmt: skip
    wanted = read("y.usda", [p for p, _ in left], kept, [w for _, w in left])
    assert scene.meshes[0].positions.tolist() == wanted.meshes[0].positions.tolist()
    assert np.allclose(scene.meshes[0].radii, wanted.meshes[0].radii)
    assert [note for note in scene.warnings if "basis" in note] == [
        f"{_CUT} ({cut} use{'s' * (cut > 1)})"
    ]


def test_moving_points_that_a_basis_cannot_use_are_left_out(stage: Usd.Stage) -> None:
    made = _curves(stage, np.zeros((5, 3)), (5,), "bezier")
    for code, x in ((0.0, 0.0), (24.0, 1.0)):
        made.GetPointsAttr().Set(stages.vectors([(x, k, 0) for k in range(5)]), code)
    scene = stages.read(stage)
    moved = scene.at(0.5).meshes[0]
    assert np.allclose(moved.positions, [(0.5, k, 0) for k in range(4)])


def test_curves_of_which_none_has_enough_points_are_left_out(stage: Usd.Stage) -> None:
    _curves(stage, _POINTS, _COUNTS, "bspline")
    scene = stages.read(stage)
    assert not scene.instances
    assert f"{_CUT} (2 uses)" in scene.warnings


def test_a_sum_of_counts_that_is_not_the_number_of_points_is_an_error(stage: Usd.Stage) -> None:
    _curves(stage, counts=(2, 4))
    with pytest.raises(dg.InputError, match=r"/hair\.curveVertexCounts: wanted a sum of 5"):
        stages.read(stage)
