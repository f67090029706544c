"""Points that move, and points as spheres."""

from __future__ import annotations

import pickle
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pxr import Usd, UsdGeom, Vt

import daguerre as dg
from daguerre.files.notes import Notes
from daguerre.importers.usd.points import read_points
from daguerre.importers.usd.values import Clock
from daguerre.motion.values import at as value_at
from tests.support.formats import stages

_RATE = 24.0
_SPOTS = [(0, 0, 0), (1, 0, 0), (0, 2, 0)]


def _moving(seed: int, **samples: Any) -> Usd.Stage:
    rng = np.random.default_rng(seed)
    stage = Usd.Stage.CreateInMemory()
    stage.SetTimeCodesPerSecond(_RATE)
    prim = UsdGeom.Points.Define(stage, "/p").GetPrim()
    for name, codes in samples.items():
        for code in codes:
            prim.GetAttribute(name).Set(stages.vectors(rng.normal(size=(6, 3))), code)
    return stage


def _read(stage: Usd.Stage, code: float = 0.0, notes: Notes | None = None) -> Any:
    clock = Clock("f.usda", _RATE, code / _RATE)
    return read_points(UsdGeom.Points.Get(stage, "/p"), clock, notes or Notes())


@pytest.mark.parametrize(
    "samples",
    [
        {"points": (0, 3, 8)},
        {"points": (0, 3, 8), "velocities": (0, 3, 8)},
        {"points": (2,), "velocities": (2,)},
        {"points": (0, 3), "velocities": (0, 3), "accelerations": (0, 3)},
    ],
)
def test_points_move_as_usd_moves_them(samples: Any) -> None:
    stage = _moving(1, **samples)
    moving, schema = _read(stage), UsdGeom.Points.Get(stage, "/p")
    for code in (-1.0, 0.0, 1.5, 2.0, 2.99, 3.0, 6.0, 8.0, 9.5):
        wanted = schema.ComputePointsAtTime(Usd.TimeCode(code), Usd.TimeCode(code))
        assert np.allclose(moving.at(code / _RATE), wanted, atol=2e-6), code
    assert pickle.loads(pickle.dumps(moving)) == moving


def test_velocities_at_other_times_do_not_count() -> None:
    stage = _moving(2, points=(0, 4), velocities=(0, 3))
    first, last = (UsdGeom.Points.Get(stage, "/p").GetPointsAttr().Get(c) for c in (0, 4))
    assert np.allclose(_read(stage).at(1 / _RATE), 0.75 * np.array(first) + 0.25 * np.array(last))


def test_points_whose_number_changes_rest_or_fly() -> None:
    stage = _moving(3, points=(0, 4, 8))
    prim = stage.GetPrimAtPath("/p")
    points = prim.GetAttribute("points")
    points.Set(stages.vectors(np.ones((2, 3))), 4)
    found = _read(stage, 5.0, notes := Notes())
    assert np.array_equal(found, np.ones((2, 3)))
    assert any("number changes" in sentence for sentence in notes.sentences())
    speeds = prim.GetAttribute("velocities")
    for code in (0, 4, 8):
        speeds.Set(stages.vectors(np.full((len(points.Get(code)), 3), 24.0)), code)
    found = _read(stage, 5.0)
    assert np.allclose(value_at(found, 6 / _RATE), 3.0)


def test_points_that_are_not_finite_are_refused() -> None:
    stage = _moving(4, points=(0, 4))
    points = stage.GetPrimAtPath("/p").GetAttribute("points")
    points.Set(stages.vectors(np.full((6, 3), np.nan)), 4)
    with pytest.raises(dg.InputError, match=r"f\.usda: /p\.points: points must be finite"):
        _read(stage)


# Spheres ----------------------------------------------------------------------------------------


@pytest.fixture
def stage(tmp_path: Path) -> Usd.Stage:
    return stages.new_stage(tmp_path / "x.usda")


def _points(stage: Usd.Stage) -> UsdGeom.Points:
    made = UsdGeom.Points.Define(stage, "/p")
    made.CreatePointsAttr(stages.vectors(_SPOTS))
    return made


def _load(made: UsdGeom.Points, **options: Any) -> dg.Scene:
    return dg.load(stages.save(made.GetPrim().GetStage()), **options)


def _radii(scene: dg.Scene) -> list[float]:
    return [round(float(np.linalg.norm(one.transform[:3, 0])), 6) for one in scene.instances]


@pytest.mark.parametrize(
    ("widths", "interpolation", "radii"),
    [
        ([0.2, 0.4, 0.6], "vertex", [0.1, 0.2, 0.3]),
        ([0.2, 0.4, 0.6], "varying", [0.1, 0.2, 0.3]),
        ([0.8], "constant", [0.4] * 3),
        ([0.8], "vertex", [0.4] * 3),
        ([0.2, 0.4], "vertex", [0.5] * 3),
        ([0.2, 0.4], "varying", [0.5] * 3),
        ([], "vertex", [0.5] * 3),
        ([0.2, 0.0, 0.6], "vertex", [0.1, 0.3]),
    ],
)
def test_widths_of_all_interpolations(
    stage: Usd.Stage, widths: list[float], interpolation: str, radii: list[float]
) -> None:
    made = _points(stage)
    made.CreateWidthsAttr(widths)
    made.SetWidthsInterpolation(interpolation)
    scene = _load(made)
    assert _radii(scene) == radii
    assert len(scene.meshes) == 1
    spheres = scene.meshes[0].positions
    assert np.allclose(np.linalg.norm(spheres, axis=1), 1, atol=1e-5)


def test_a_primvar_of_widths_goes_first_and_may_be_indexed(stage: Usd.Stage) -> None:
    made = _points(stage)
    made.CreateWidthsAttr([1.0])
    stages.primvar(made, "widths", [0.2, 0.6], "vertex", [1, 0, 1])
    assert _radii(_load(made)) == [0.3, 0.1, 0.3]


def test_points_without_widths_are_noted(stage: Usd.Stage) -> None:
    scene = _load(_points(stage))
    assert _radii(scene) == [0.5] * 3
    assert any("points without widths" in note for note in scene.warnings)
    assert [tuple(one.transform[:3, 3]) for one in scene.instances] == _SPOTS


def test_each_sphere_has_its_colour(stage: Usd.Stage) -> None:
    made = _points(stage)
    made.CreateWidthsAttr([1.0])
    stages.primvar(made, "displayColor", [(1, 0, 0), (0, 0, 1), (1, 0, 0)], "vertex")
    scene = _load(made)
    where = {tuple(one.transform[:3, 3]): one.material for one in scene.instances}
    assert where[0, 0, 0] == where[0, 2, 0] != where[1, 0, 0]
    assert len(scene.materials) == 2


def test_spheres_fly_and_ride_on_their_prim(stage: Usd.Stage) -> None:
    made = _points(stage)
    made.GetPointsAttr().Clear()
    made.CreatePointsAttr().Set(stages.vectors(_SPOTS), 0)
    made.CreateVelocitiesAttr().Set(stages.vectors([(0, 0, 1), (0, 0, 2), (0, 0, 3)]), 0)
    made.CreateWidthsAttr([0.2, 0.4, 0.0])
    op = made.AddTranslateXOp()
    op.Set(0.0, 0)
    op.Set(5.0, 24)
    scene = _load(made, time=0.0)
    moved = scene.at(0.5)
    assert [tuple(one.transform[:3, 3]) for one in moved.instances] == [(2.5, 0, 0.5), (3.5, 0, 1)]
    assert _radii(moved) == [0.1, 0.2]
    assert pickle.loads(pickle.dumps(scene)) == scene


def test_many_moving_spheres_are_asked_fast(stage: Usd.Stage) -> None:
    made = _points(stage)
    made.GetPointsAttr().Clear()
    for code in (0, 24):
        made.CreatePointsAttr().Set(stages.vectors(np.full((20_000, 3), code)), code)
    made.CreateWidthsAttr([0.2])
    scene = _load(made)
    begin = time.perf_counter()
    assert np.allclose(scene.at(0.5).instances[-1].transform[:3, 3], 12)
    assert time.perf_counter() - begin < 8  # 1 s; were each to move all, minutes


def test_spheres_of_an_instancer(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    made = UsdGeom.Points.Define(stage, "/i/p")
    made.CreatePointsAttr(stages.vectors(_SPOTS))
    made.CreateWidthsAttr(Vt.FloatArray([0.2]))
    stages.instancer(stage, "/i", [(0, 0, 10), (0, 0, 20)], None, ("/i/p",))
    scene = dg.load(stages.save(stage))
    found = sorted(tuple(one.transform[:3, 3]) for one in scene.instances)
    assert found == sorted((x, y, z) for x, y, _ in _SPOTS for z in (10, 20))
    assert scene.nodes["i"] == list(range(6))
