"""Stacks of operations against USD's own products."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pytest
from pxr import Gf, Usd, UsdGeom

import daguerre as dg
from daguerre.files.notes import Notes
from daguerre.importers.usd.transforms import joined, local
from daguerre.importers.usd.values import Clock
from daguerre.motion.values import at as value_at
from tests.support.formats import stages

_RATE = 24.0
_VALUES = {
    "Translate": lambda r: Gf.Vec3d(*r.normal(size=3)),
    "Scale": lambda r: Gf.Vec3f(*r.uniform(0.5, 2, 3)),
    "Orient": lambda r: Gf.Quatf(*r.normal(size=4)).GetNormalized(),
    "Transform": lambda r: Gf.Matrix4d(1).SetRotate(
        Gf.Rotation(Gf.Vec3d(1, 2, 3), r.uniform(0, 90))
    ),
    **{f"Rotate{axis}": lambda r: float(r.uniform(-180, 180)) for axis in "XYZ"},
    **{
        f"Rotate{axes}": lambda r: Gf.Vec3f(*r.uniform(-180, 180, 3))
        for axes in ("XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX")
    },
    **{f"Translate{axis}": lambda r: float(r.normal()) for axis in "XYZ"},
    **{f"Scale{axis}": lambda r: float(r.uniform(0.5, 2)) for axis in "XYZ"},
}


def _clock(time: float = 0.0) -> Clock:
    return Clock("f.usda", _RATE, time)


def _world(prim: Usd.Prim, time: float) -> np.ndarray:
    ops, _ = local(prim, _clock(time), Notes())
    return np.asarray(value_at(joined(np.eye(4), ops), time))


def _theirs(prim: Usd.Prim, time: float) -> np.ndarray:
    found = UsdGeom.Xformable(prim).GetLocalTransformation(Usd.TimeCode(time * _RATE))
    return np.array(found).T


@pytest.mark.parametrize("seed", range(12))
def test_any_stack_is_the_product_that_usd_makes(seed: int) -> None:
    rng = np.random.default_rng(seed)
    stage = Usd.Stage.CreateInMemory()
    xform = UsdGeom.Xform.Define(stage, "/x")
    for i, name in enumerate(rng.permutation(list(_VALUES))[:6]):
        op = getattr(xform, f"Add{name}Op")(opSuffix=f"n{i}")
        make = _VALUES[name]
        if rng.uniform() < 0.6:
            for code in (1, 5, 12):
                op.Set(make(rng), code)
        else:
            op.Set(make(rng))
        if rng.uniform() < 0.4:
            getattr(xform, f"Add{name}Op")(opSuffix=f"n{i}", isInverseOp=True)
    for time in (-1.0, 1 / _RATE, 2.3 / _RATE, 5 / _RATE, 11.9 / _RATE, 3.0):
        assert np.allclose(_world(xform.GetPrim(), time), _theirs(xform.GetPrim(), time), atol=2e-5)


def test_a_moving_stack_is_pure_and_travels() -> None:
    stage = Usd.Stage.CreateInMemory()
    xform = UsdGeom.Xform.Define(stage, "/x")
    op = xform.AddRotateZOp()
    op.Set(0.0, 0)
    op.Set(180.0, 24)
    moving = joined(np.eye(4), local(xform.GetPrim(), _clock(), Notes())[0])
    assert moving.breaks(-1, 2) == [0.0, 1.0]
    again = pickle.loads(pickle.dumps(moving))
    assert again == moving
    assert np.allclose(again.at(0.5)[:2, :2], [[0, -1], [1, 0]], atol=1e-7)


def test_units_axes_and_nested_scales_do_not_change_a_picture(tmp_path: Path) -> None:
    def written(name: str, metres: float, up: str) -> Path:
        stage = stages.new_stage(tmp_path / name, metres=metres, up=up)
        top = UsdGeom.Xform.Define(stage, "/Top")
        k = 1 / metres
        stages.place(top, scale=(2, 2, 2), turn=(90, 0, 0) if up == "Z" else (0, 0, 0))
        inner = UsdGeom.Xform.Define(stage, "/Top/Inner")
        stages.place(inner, scale=(0.5, 0.5, 0.5))
        card = stages.mesh(stage, "/Top/Inner/card", np.array(stages.SQUARE) * k)
        stages.place(card, at=(0.2 * k, 0.1 * k, -3 * k), turn=(10, 20, 30))
        camera = UsdGeom.Camera.Define(stage, "/Top/Inner/Cam")
        camera.CreateFocalLengthAttr(50 / (100 * metres))
        camera.CreateHorizontalApertureAttr(36 / (100 * metres))
        camera.CreateVerticalApertureAttr(24 / (100 * metres))
        return stages.save(stage)

    plain = dg.load(written("m.usda", 1.0, "Y"))
    other = dg.load(written("cm.usda", 0.01, "Z"))
    for scene in (plain, other):
        scene.set_environment(color=(1, 1, 1))
    first, second = (dg.render(s, resolution=(48, 32), spp=4, aovs=True) for s in (plain, other))
    assert np.ptp(first.rgb) > 0.3
    assert np.allclose(first.rgb, second.rgb, atol=2e-3)
    assert np.allclose(first.aovs["depth.Z"], second.aovs["depth.Z"], rtol=1e-5)


def test_a_prim_may_ignore_its_parents(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda", metres=0.01)
    stages.place(UsdGeom.Xform.Define(stage, "/A"), at=(100, 0, 0))
    inner = UsdGeom.Xform.Define(stage, "/A/B")
    stages.place(inner, at=(0, 50, 0))
    inner.SetResetXformStack(True)
    scene = dg.load(stages.save(stage))
    assert np.allclose(scene.node_positions["A"], (1, 0, 0))
    assert np.allclose(scene.node_positions["A/B"], (0, 0.5, 0))


def test_numbers_that_are_not_finite_are_refused(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    UsdGeom.Xform.Define(stage, "/A").AddTranslateOp().Set(Gf.Vec3d(0, float("nan"), 0))
    with pytest.raises(dg.InputError, match=r"/A\.xformOp:translate: wanted finite numbers"):
        dg.load(stages.save(stage))


def test_an_operation_without_an_inverse_is_refused(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    xform = UsdGeom.Xform.Define(stage, "/A")
    xform.AddScaleOp(opSuffix="p").Set(Gf.Vec3f(0, 1, 1))
    xform.AddScaleOp(opSuffix="p", isInverseOp=True)
    with pytest.raises(dg.InputError, match=r"the inverted operation has no inverse"):
        dg.load(stages.save(stage))


# --- Matrices that are not affine ------------------------------------------------------------

_BENT = "a transform whose last column is not 0, 0, 0, 1 is made affine"


def _matrix(rng: np.random.Generator, last: tuple[float, float, float, float]) -> Gf.Matrix4d:
    rows = rng.normal(size=(4, 4))
    rows[:, 3] = last
    return Gf.Matrix4d(rows.tolist())


def _read_matrix(samples: dict[float, Gf.Matrix4d], time: float = 0.0) -> tuple[np.ndarray, Notes]:
    stage = Usd.Stage.CreateInMemory()
    op = UsdGeom.Xform.Define(stage, "/x").AddTransformOp()
    for code, matrix in samples.items():
        op.Set(matrix, code)
    ops, _ = local(stage.GetPrimAtPath("/x"), _clock(time), notes := Notes())
    return np.asarray(value_at(joined(np.eye(4), ops), time)), notes


@pytest.mark.parametrize("w", [2.0, 0.04, -3.0])
def test_a_last_number_divides_points_as_in_usd(w: float) -> None:
    rng = np.random.default_rng(1)
    theirs = _matrix(rng, (0, 0, 0, w))
    ours, notes = _read_matrix({0.0: theirs})
    points = rng.normal(size=(20, 3))
    wanted = [theirs.Transform(Gf.Vec3d(*point)) for point in points]
    assert np.allclose(points @ ours[:3, :3].T + ours[:3, 3], wanted)
    assert ours[3].tolist() == [0, 0, 0, 1]
    (note,) = notes.sentences()
    assert note.startswith(_BENT)
    assert note.endswith("(1 use)")


def test_a_last_number_over_time_divides_too() -> None:
    rng = np.random.default_rng(2)
    first, last = (_matrix(rng, (0, 0, 0, 4)) for _ in range(2))
    ours, notes = _read_matrix({0.0: first, 24.0: last}, 0.25)
    wanted = (0.75 * first + 0.25 * last).Transform(Gf.Vec3d(1, 2, 3))
    assert np.allclose(ours[:3] @ (1, 2, 3, 1), wanted)
    assert len(notes.sentences()) == 1
    assert notes.sentences()[0].endswith("(1 use)")


def test_perspective_is_dropped_and_the_origin_stays() -> None:
    theirs = _matrix(np.random.default_rng(3), (0.5, -1, 0.25, 2))
    ours, notes = _read_matrix({0.0: theirs})
    assert np.allclose(ours[:3, 3], theirs.Transform(Gf.Vec3d(0, 0, 0)))
    assert np.allclose(ours[:3, :3], np.array(theirs)[:3, :3].T / 2)
    assert ours[3].tolist() == [0, 0, 0, 1]
    assert notes.sentences()[0].startswith(_BENT)


def test_rounding_of_a_last_column_is_no_note() -> None:
    affine = _matrix(np.random.default_rng(4), (1e-9, 0, 0, 1 - 1e-9))
    assert _read_matrix({0.0: affine})[1].sentences() == []


def test_a_scene_with_such_a_matrix_is_drawn_with_one_note(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    for name in ("/a", "/b"):
        stages.mesh(stage, name).AddTransformOp().Set(Gf.Matrix4d(2))
    scene = dg.load(stages.save(stage))
    assert [note for note in scene.warnings if "last column" in note] == [
        "a transform whose last column is not 0, 0, 0, 1 is made affine: divided by its last "
        "number, without perspective (2 uses)"
    ]
    assert all(np.array_equal(one.transform, np.eye(4)) for one in scene.instances)


@pytest.mark.parametrize(
    ("place", "value", "wanted"),
    [
        ((3, 3), 0.0, "the last number must not be 0"),
        ((3, 3), float("nan"), "wanted finite numbers"),
        ((0, 3), float("inf"), "wanted finite numbers"),
        ((3, 3), 1e-320, "wanted finite numbers"),
    ],
)
@pytest.mark.parametrize("codes", [(0.0,), (0.0, 5.0)])
def test_matrices_that_have_no_meaning_are_refused(
    tmp_path: Path, place: tuple[int, int], value: float, wanted: str, codes: tuple[float, ...]
) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    op = UsdGeom.Xform.Define(stage, "/A").AddTransformOp()
    for code in codes:
        matrix = Gf.Matrix4d(1)
        if code == codes[-1]:
            matrix[place] = value
        op.Set(matrix, code)
    with pytest.raises(dg.InputError, match=rf"/A\.xformOp:transform: .*{wanted}"):
        dg.load(stages.save(stage))
