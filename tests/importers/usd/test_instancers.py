"""Point instancers against USD's own transforms, and by hand."""

from __future__ import annotations

import pickle
import resource
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pxr import Gf, Sdf, Usd, UsdGeom, Vt

import daguerre as dg
from daguerre.files.notes import Notes
from daguerre.importers.usd.instancers import read_copies
from daguerre.importers.usd.values import Clock
from tests.support.formats import stages
from tests.support.pictures.blur import blurred, case, disagreement, frozen, mean_of_stills

_RATE = 24.0
#: USD does not scale quaternions to length 1; those of half precision are that wrong.
_HALF = 5e-3
_COUNT = 7


def _quaternions(rng: np.random.Generator) -> np.ndarray:
    rows = rng.normal(size=(_COUNT, 4))
    return rows / np.linalg.norm(rows, axis=1, keepdims=True)


def _crowd(seed: int, **samples: Any) -> Usd.Stage:
    """Copies whose attributes have samples at the given time codes; () is a default value."""
    rng = np.random.default_rng(seed)
    stage = Usd.Stage.CreateInMemory()
    stage.SetTimeCodesPerSecond(_RATE)
    made = stages.instancer(stage, "/crowd", rng.normal(size=(_COUNT, 3)))
    made.GetPositionsAttr().Clear()
    for name, codes in samples.items():
        attribute = made.GetPrim().GetAttribute(name)
        for code in codes or (None,):
            if name == "orientations":
                value = stages.quaternions(_quaternions(rng))
            elif name == "orientationsf":
                value = stages.quaternions(_quaternions(rng), Vt.QuatfArray)
            else:
                value = stages.vectors(rng.normal(size=(_COUNT, 3)) * (90 if "ang" in name else 1))
            attribute.Set(value, *(() if code is None else (code,)))
    return stage


def _of(stage: Usd.Stage) -> UsdGeom.PointInstancer:
    return UsdGeom.PointInstancer.Get(stage, "/crowd")


def _ours(stage: Usd.Stage, code: float, loaded: float = 2.0) -> np.ndarray:
    (copies,) = read_copies(_of(stage).GetPrim(), Clock("f", _RATE, loaded / _RATE), Notes())
    if copies.moving is None:
        return copies.transforms
    assert np.allclose(copies.transforms, copies.moving.at(loaded / _RATE))
    return copies.moving.at(code / _RATE)


def _theirs(stage: Usd.Stage, code: float) -> np.ndarray:
    found = _of(stage).ComputeInstanceTransformsAtTime(
        *(Usd.TimeCode(code), Usd.TimeCode(code)),
        *(UsdGeom.PointInstancer.ExcludeProtoXform, UsdGeom.PointInstancer.IgnoreMask),
    )
    return np.array(found).transpose(0, 2, 1)


_ANY = {
    "at rest": {"positions": (), "orientations": (), "scales": ()},
    "positions alone": {"positions": ()},
    "fine turns": {"positions": (), "orientationsf": (), "scales": ()},
    "positions": {"positions": (1, 4, 9), "orientations": (), "scales": ()},
    "turns": {"positions": (), "orientations": (1, 4, 9)},
    "both turns": {"positions": (), "orientations": (), "orientationsf": ()},
    "fine turns over time": {"positions": (3,), "orientationsf": (1, 4, 9)},
    "all, at other times": {
        "positions": (0, 8),
        "orientations": (2, 3, 10),
        "scales": (-1, 5, 6),
    },
}
_FLYING = {
    "velocities": {"positions": (0, 4, 8), "velocities": (0, 4, 8), "scales": ()},
    "one sample": {"positions": (0,), "velocities": (0,)},
    "accelerations": {"positions": (0, 6), "velocities": (0, 6), "accelerations": (0, 6)},
    "spins": {"positions": (), "orientationsf": (0, 6), "angularVelocities": (0, 6)},
    "both": {
        **{"positions": (0, 6), "velocities": (0, 6), "accelerations": (0, 6)},
        **{"orientationsf": (0, 6), "angularVelocities": (0, 6), "scales": ()},
    },
    "both, at other times": {
        **{"positions": (0, 6), "velocities": (0, 6), "accelerations": (0, 6)},
        **{"orientationsf": (1, 4), "angularVelocities": (1, 4)},
    },
}


@pytest.mark.parametrize("name", _ANY)
def test_copies_are_where_usd_puts_them(name: str) -> None:
    stage = _crowd(1, **_ANY[name])
    for code in (-2.0, 0.0, 1.0, 2.6, 4.0, 5.5, 8.9, 20.0):
        close = _HALF if "orientations" in _ANY[name] else 2e-6
        assert np.allclose(_ours(stage, code), _theirs(stage, code), atol=close), code


@pytest.mark.parametrize("name", _FLYING)
def test_copies_fly_and_spin_as_usd_has_them(name: str) -> None:
    stage = _crowd(2, **_FLYING[name])
    for code in (-1.0, 0.0, 1.0, 2.6, 3.99, 4.0, 5.5, 7.0, 9.25, 12.0):
        assert np.allclose(_ours(stage, code), _theirs(stage, code), atol=2e-5), code


def test_a_stage_that_holds_values_holds_copies() -> None:
    stage = _crowd(3, positions=(0, 8), orientations=(0, 8))
    stage.SetInterpolationType(Usd.InterpolationTypeHeld)
    clock = Clock("f", _RATE, 0.0, holds=True)
    (copies,) = read_copies(_of(stage).GetPrim(), clock, Notes())
    assert copies.moving is not None
    for code in (0.0, 7.9, 8.0, 9.0):
        assert np.allclose(copies.moving.at(code / _RATE), _theirs(stage, code), atol=_HALF)


def test_velocities_and_accelerations_at_other_times_do_not_count() -> None:
    stage = _crowd(5, positions=(0, 8), velocities=(0, 7))
    rows = np.array([_of(stage).GetPositionsAttr().Get(code) for code in (0, 8)], np.float64)
    assert np.allclose(_ours(stage, 2.0)[:, :3, 3], 0.75 * rows[0] + 0.25 * rows[1])
    stage = _crowd(5, positions=(0, 8), velocities=(0, 8), accelerations=(0,))
    prim = _of(stage).GetPrim()
    places, speeds = (
        np.array(prim.GetAttribute(name).Get(0), np.float64) for name in ("positions", "velocities")
    )
    assert np.allclose(_ours(stage, 2.0)[:, :3, 3], places + speeds * 2 / _RATE)


def test_copies_whose_number_changes_fly_from_the_sample_before() -> None:
    stage = _crowd(4)
    made, prim = _of(stage), _of(stage).GetPrim()
    rng = np.random.default_rng(0)
    for code, count in ((0, 3), (4, 5), (8, 2)):
        made.GetProtoIndicesAttr().Set(Vt.IntArray([0] * count), code)
        for name in ("positions", "velocities"):
            prim.GetAttribute(name).Set(stages.vectors(rng.normal(size=(count, 3))), code)
    (copies,) = read_copies(prim, Clock("f", _RATE, 5 / _RATE), notes := Notes())
    assert copies.moving is not None
    assert np.allclose(copies.moving.at(6 / _RATE), _theirs(stage, 6), atol=2e-6)
    assert notes.sentences() == []
    prim.GetAttribute("velocities").Clear()
    (copies,) = read_copies(prim, Clock("f", _RATE, 5 / _RATE), notes)
    assert copies.moving is None
    assert np.allclose(copies.transforms, _theirs(stage, 5), atol=2e-6)
    assert any("number changes" in sentence for sentence in notes.sentences())


def test_moving_copies_are_values_that_travel() -> None:
    stage = _crowd(2, **_FLYING["both"])
    (copies,) = read_copies(_of(stage).GetPrim(), Clock("f", _RATE, 0), Notes())
    assert copies.moving is not None
    one = copies.moving.each()[3]
    again = pickle.loads(pickle.dumps(one))
    assert again == one
    assert np.array_equal(again.at(0.1), copies.moving.at(0.1)[3])
    assert one.breaks(-1, 1) == [0.0, 0.25]


def test_copies_that_are_hidden_are_not_drawn(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    made = stages.instancer(stage, "/i", [(x, 0, 0) for x in range(5)])
    made.CreateIdsAttr([10, 11, 12, 13, 14])
    made.CreateInvisibleIdsAttr([11])
    made.DeactivateId(13)
    scene = dg.load(stages.save(stage))
    assert [one.transform[0, 3] for one in scene.instances] == [0, 2, 4]
    assert scene.nodes["i"] == [0, 1, 2]
    assert len(scene.meshes) == 1


def test_prototypes_have_several_prims_and_transforms_of_their_own(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    UsdGeom.Scope.Define(stage, "/Outside")
    stages.place(UsdGeom.Xform.Define(stage, "/Outside/pair"), at=(0, 1, 0), turn=(0, 0, 90))
    stages.place(stages.mesh(stage, "/Outside/pair/a"), at=(1, 0, 0))
    stages.cube(stage, "/Outside/pair/b")
    made = stages.instancer(
        stage, "/i", [(0, 0, 5), (0, 0, 9), (2, 0, 0)], [0, 0, 1], ("/Outside/pair", "/i/own")
    )
    stages.place(stages.mesh(stage, "/i/own"), at=(0, 7, 0))
    half_turn = (0, 0, 1, 0)
    made.CreateOrientationsAttr(stages.quaternions([(0, 0, 0, 1), (0, 0, 0, 1), half_turn]))
    stages.place(made, at=(100, 0, 0))
    scene = dg.load(stages.save(stage))
    spots = {
        name: sorted(tuple(np.round(scene.instances[i].transform[:3, 3], 6)) for i in numbers)
        for name, numbers in scene.nodes.items()
    }
    assert spots["i"] == sorted([(100, 2, 5), (100, 2, 9), (100, 1, 5), (100, 1, 9), (102, -7, 0)])
    assert len(spots["Outside/pair"]) == 2  # the prims outside are drawn themselves, too
    assert len(scene.meshes) == 3


def test_instancers_in_instancers_multiply(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    stages.instancer(stage, "/o/in", [(0, y, 0) for y in range(3)])
    stages.place(UsdGeom.PointInstancer.Get(stage, "/o/in"), at=(0, 10, 0))
    stages.instancer(stage, "/o", [(x, 0, 0) for x in range(4)], None, ("/o/in",))
    scene = dg.load(stages.save(stage))
    found = sorted(tuple(one.transform[:2, 3]) for one in scene.instances)
    assert found == [(x, 10 + y) for x in range(4) for y in range(3)]


def test_a_moving_instancer_of_moving_copies_of_moving_prototypes(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    made = stages.instancer(stage, "/i", [(0, 0, 0)])
    made.GetPositionsAttr().Set(stages.vectors([(0, 1, 0)]), 0)
    made.GetPositionsAttr().Set(stages.vectors([(0, 3, 0)]), 24)
    for prim, to in ((made, (4, 0, 0)), (UsdGeom.Xformable.Get(stage, "/i/card"), (0, 0, 8))):
        op = UsdGeom.Xformable(prim).AddTranslateOp()
        op.Set(Gf.Vec3d(0, 0, 0), 0)
        op.Set(Gf.Vec3d(*to), 24)
    scene = dg.load(stages.save(stage))
    moved = scene.at(0.25)
    assert np.allclose(moved.instances[0].transform[:3, 3], (1, 1.5, 2))
    assert scene.motion.instances[0].breaks(-1, 2) == [0.0, 1.0]


@pytest.mark.parametrize(
    ("change", "place"),
    [
        (lambda i: i.GetProtoIndicesAttr().Set([0, 1, 0]), r"/i\.protoIndices: wanted 0 \.\. 0"),
        (lambda i: i.GetProtoIndicesAttr().Set([0, -1, 0]), r"/i\.protoIndices: wanted 0 \.\. 0"),
        (lambda i: i.GetPositionsAttr().Set([(0, 0, 0)] * 2), r"/i\.positions: wanted 3, .*got 2"),
        (lambda i: i.CreateScalesAttr([(1, 1, 1)] * 2), r"/i\.scales: wanted 3, .*got 2"),
        (
            lambda i: i.CreateOrientationsAttr(Vt.QuathArray([Gf.Quath(1)] * 2)),
            r"/i\.orientations: wanted 3, .*got 2",
        ),
        (
            lambda i: i.GetPositionsAttr().Set([(0, 0, 0), (0, float("nan"), 0), (0, 0, 0)]),
            r"/i\.positions: numbers must be finite",
        ),
        (lambda i: i.GetPrototypesRel().SetTargets(["/i"]), "or contain themselves"),
    ],
)
def test_what_does_not_fit_is_one_error(tmp_path: Path, change: Any, place: str) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    change(stages.instancer(stage, "/i", np.zeros((3, 3))))
    with pytest.raises(dg.InputError, match=place) as caught:
        dg.load(stages.save(stage))
    assert str(caught.value).startswith(f"{tmp_path / 'x.usda'}: ")


def test_values_beyond_the_copies_do_not_count(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    made = stages.instancer(stage, "/i", [(1, 0, 0), (2, 0, 0), (3, 0, 0)], [0, 0])
    made.CreateScalesAttr(stages.vectors([(2, 2, 2)] * 4))
    made.CreateOrientationsAttr(Vt.QuathArray([Gf.Quath(1)] * 3))
    scene = dg.load(stages.save(stage))
    assert [one.transform[0, 3] for one in scene.instances] == [1, 2]
    assert all(one.transform[0, 0] == 2 for one in scene.instances)
    assert [note for note in scene.warnings if "instancer" in note] == [
        f"{name} of a point instancer has more elements than copies: only the first ones are "
        f"used (1 use)"
        for name in ("positions", "orientations", "scales")
    ]
    assert not any("changes over time" in note for note in scene.warnings)


@pytest.mark.parametrize(
    ("change", "what"),
    [
        (lambda i: i.GetPrototypesRel().ClearTargets(False), "prototypes"),
        (lambda i: i.GetPositionsAttr().Clear(), "positions"),
        (lambda i: i.GetProtoIndicesAttr().Clear(), "protoIndices"),
        (lambda i: i.GetPositionsAttr().Set([]), "positions"),
    ],
)
def test_an_instancer_that_has_nothing_to_place_is_left_out(
    tmp_path: Path, change: Any, what: str
) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    change(stages.instancer(stage, "/i", np.zeros((3, 3))))
    stages.mesh(stage, "/card")
    scene = dg.load(stages.save(stage))
    assert len(scene.instances) == 1
    assert f"a point instancer without {what} is left out (1 use)" in scene.warnings


def test_a_missing_prototype_is_a_note(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    stages.instancer(stage, "/i", np.zeros((3, 3)), None, ("/nowhere",))
    scene = dg.load(stages.save(stage))
    assert not scene.instances
    assert "a prototype of a point instancer is missing (1 use)" in scene.warnings


def _nested(path: Path, levels: int, count: int) -> Path:
    stage = stages.new_stage(path)
    name = "/i" * levels
    for depth in range(levels, 0, -1):
        name = "/i" * depth
        below = ("/i" * (depth + 1),) if depth < levels else ()
        stages.instancer(stage, name, np.zeros((count, 3)), None, below)
    return stages.save(stage)


@pytest.mark.parametrize(("levels", "count"), [(3, 1000), (30, 2)])
def test_a_thousand_million_copies_are_refused_at_once(
    tmp_path: Path, levels: int, count: int
) -> None:
    path = _nested(tmp_path / "x.usda", levels, count)
    before, begin = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, time.perf_counter()
    with pytest.raises(dg.InputError, match=r"/i: too many instances: the limit is 20000000"):
        dg.load(path)
    assert time.perf_counter() - begin < 2
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 60_000  # kB


def test_instancers_nested_too_deep_are_refused(tmp_path: Path) -> None:
    with pytest.raises(dg.InputError, match="point instancers are nested more than 32 deep"):
        dg.load(_nested(tmp_path / "x.usda", 40, 1))


@pytest.mark.parametrize("moving", [False, True])
@pytest.mark.in_process
def test_many_copies_load_fast(tmp_path: Path, moving: bool) -> None:
    count = 100_000
    stage = stages.new_stage(tmp_path / "x.usdc")
    made = stages.instancer(stage, "/i", np.random.default_rng(0).normal(size=(count, 3)))
    made.CreateOrientationsAttr(Vt.QuathArray([Gf.Quath(0.6, 0, 0.8, 0)] * count))
    made.CreateScalesAttr(Vt.Vec3fArray([Gf.Vec3f(0.01)] * count))
    if moving:
        made.GetPositionsAttr().Set(made.GetPositionsAttr().Get(), 0)
        made.GetPositionsAttr().Set(Vt.Vec3fArray([Gf.Vec3f(1)] * count), 24)
    path = stages.save(stage)
    begin = time.perf_counter()
    scene = dg.load(path, time=0.5)
    assert time.perf_counter() - begin < 6  # 1.5 s on a machine that does nothing else
    assert len(scene.instances) == count
    assert len(scene.motion.instances) == count * moving
    for i in (0, 777, count - 1) if moving else ():
        shown = scene.instances[i].transform
        assert np.allclose(shown, scene.motion.instances[i].at(0.5), rtol=0, atol=1e-12)
    assert scene.nodes["i"] == list(range(count))


def test_the_blur_of_copies_is_the_mean_of_stills(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda", rate=10.0)
    made = stages.instancer(stage, "/i", np.zeros((2, 3)))
    card = UsdGeom.Mesh.Get(stage, "/i/card")
    card.GetPointsAttr().Set(stages.vectors(np.array(stages.SQUARE) * 0.4))
    stages.primvar(card, "displayColor", [(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1)], "vertex")
    prim = made.GetPrim()
    for code, x in ((8.0, -1.0), (10.5, 0.4)):
        prim.GetAttribute("positions").Set(stages.vectors([(x, 0.5, -3), (-x, -0.4, -3)]), code)
        prim.GetAttribute("velocities").Set(stages.vectors([(5, 0, 0), (-4, 1, 0)]), code)
        turns = stages.quaternions([(0, 0, 0, 1)] * 2)
        prim.GetAttribute("orientations").Set(turns, code)
        spins = stages.vectors([(0, 0, 400), (0, 200, 0)])
        prim.GetAttribute("angularVelocities").Set(spins, code)
    scene = dg.load(stages.save(stage), time=1.0)
    scene.set_environment(color=(1, 1, 1))
    made_case = case(scene, dg.Camera(lens="pinhole", focal_length=35.0), 0.3)
    wanted = mean_of_stills(made_case, 6, 12, 12)
    assert disagreement(blurred(made_case, 6, 144), wanted) == []
    assert disagreement(frozen(made_case, 6, 144), wanted) != []


def test_an_instance_of_a_stage_may_hold_an_instancer(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    UsdGeom.Xform.Define(stage, "/Thing")
    stages.instancer(stage, "/Thing/i", [(0, 0, 0), (1, 0, 0)])
    for name, x in (("/A", 10), ("/B", 20)):
        one = UsdGeom.Xform.Define(stage, name)
        stages.place(one, at=(x, 0, 0))
        one.GetPrim().GetReferences().AddInternalReference("/Thing")
        one.GetPrim().SetInstanceable(True)
    stage.GetPrimAtPath("/Thing").SetSpecifier(Sdf.SpecifierClass)
    scene = dg.load(stages.save(stage))
    assert sorted(one.transform[0, 3] for one in scene.instances) == [10, 11, 20, 21]
    assert scene.nodes["A/i"] == [0, 1]
    assert len(scene.meshes) == 1
