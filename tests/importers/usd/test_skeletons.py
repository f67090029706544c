"""Skins and blend shapes against UsdSkel's own, and by hand."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pxr import Gf, Sdf, Usd, UsdGeom, UsdSkel, Vt

import daguerre as dg
from daguerre.files.notes import Notes
from daguerre.importers.usd.skeletons import Skeletons
from daguerre.importers.usd.values import Clock
from daguerre.motion.values import at as value_at
from daguerre.motion.values import keys
from tests.support.formats import stages
from tests.support.pictures.blur import blurred, case, disagreement, frozen, mean_of_stills

_RATE = 24.0
_JOINTS = ("a", "a/b", "a/b/c", "a/d", "e")
_POINTS = 40


def _matrix(rng: np.random.Generator) -> Gf.Matrix4d:
    q = Gf.Quatd(*rng.normal(size=4)).GetNormalized()
    turn = Gf.Matrix4d(1).SetRotate(q)
    scale = Gf.Matrix4d(1).SetScale(Gf.Vec3d(*rng.uniform(0.6, 1.5, 3)))
    return scale * turn * Gf.Matrix4d(1).SetTranslate(Gf.Vec3d(*rng.normal(size=3)))


def _animate(
    made: UsdSkel.Animation, rng: np.random.Generator, joints: Any, stretched: bool = False
) -> None:
    """Keys of translations, rotations and scales at different times."""
    count = len(joints)
    made.CreateJointsAttr(list(joints))
    for code in (0, 5, 12):
        made.CreateTranslationsAttr().Set(stages.vectors(rng.normal(size=(count, 3))), code)
    for code in (2, 5, 9):
        turns = rng.normal(size=(count, 4))
        turns /= np.linalg.norm(turns, axis=1, keepdims=True)
        made.CreateRotationsAttr().Set(stages.quaternions(turns, Vt.QuatfArray), code)
    for code in (0, 12) if stretched else (0,):
        scales = rng.uniform(0.5, 1.5, (count, 3)).astype(np.float16)
        made.CreateScalesAttr().Set(Vt.Vec3hArray.FromNumpy(scales), code)


def _skin(
    stage: Usd.Stage,
    seed: int = 0,
    *,
    animated: Any = ("e", "a/b", "a"),
    own: Any = None,
    rigid: bool = False,
    stretched: bool = False,
) -> UsdGeom.Mesh:
    """A skinned mesh below /Root, with a skeleton, and an animation of some joints."""
    rng = np.random.default_rng(seed)
    UsdSkel.Root.Define(stage, "/Root")
    skeleton = UsdSkel.Skeleton.Define(stage, "/Root/skeleton")
    skeleton.CreateJointsAttr(list(_JOINTS))
    skeleton.CreateBindTransformsAttr([_matrix(rng) for _ in _JOINTS])
    skeleton.CreateRestTransformsAttr([_matrix(rng) for _ in _JOINTS])
    _animate(UsdSkel.Animation.Define(stage, "/Root/animation"), rng, animated, stretched)
    UsdSkel.BindingAPI.Apply(skeleton.GetPrim()).CreateAnimationSourceRel().AddTarget(
        "/Root/animation"
    )
    corners = rng.integers(0, _POINTS, 60)
    mesh = stages.mesh(stage, "/Root/mesh", rng.normal(size=(_POINTS, 3)), [3] * 20, corners)
    binding = UsdSkel.BindingAPI.Apply(mesh.GetPrim())
    binding.CreateSkeletonRel().AddTarget("/Root/skeleton")
    binding.CreateGeomBindTransformAttr(_matrix(rng))
    joints = own or _JOINTS
    if own:
        binding.CreateJointsAttr(list(own))
    influences = min(3, len(joints))
    rows = 1 if rigid else _POINTS
    weights = rng.uniform(0.1, 1, (rows, influences))
    weights /= weights.sum(axis=1, keepdims=True)
    numbers = np.array([rng.permutation(len(joints))[:influences] for _ in range(rows)])
    binding.CreateJointIndicesPrimvar(rigid, influences).Set(numbers.ravel().tolist())
    binding.CreateJointWeightsPrimvar(rigid, influences).Set(weights.ravel().tolist())
    return mesh


def _ours(stage: Usd.Stage, time: float = 0.0) -> Any:
    skeletons = Skeletons(Clock("f.usda", _RATE, time), Notes())
    skeletons.add_root(stage.GetPrimAtPath("/Root"))
    mesh = UsdGeom.Mesh.Get(stage, "/Root/mesh")
    return skeletons.skinned(mesh.GetPrim(), np.array(mesh.GetPointsAttr().Get(), np.float32))


def _theirs(stage: Usd.Stage, code: float) -> np.ndarray:
    cache, root = UsdSkel.Cache(), UsdSkel.Root.Get(stage, "/Root")
    cache.Populate(root, Usd.PrimDefaultPredicate)
    query = cache.GetSkelQuery(UsdSkel.Skeleton.Get(stage, "/Root/skeleton"))
    target = cache.GetSkinningQuery(stage.GetPrimAtPath("/Root/mesh"))
    points = UsdGeom.Mesh.Get(stage, "/Root/mesh").GetPointsAttr().Get()
    transforms = query.ComputeSkinningTransforms(Usd.TimeCode(code))
    assert target.ComputeSkinnedPoints(transforms, points, Usd.TimeCode(code))
    return np.array(points)


_KINDS: dict[str, dict[str, Any]] = {
    "some joints move": {},
    "all joints move": {"animated": ("a/d", "e", "a", "a/b/c", "a/b")},
    "an unknown joint moves": {"animated": ("a/x", "a/b", "y")},
    "own order of joints": {"own": ("e", "a/b/c", "a", "a/d")},
    "one influence": {"own": ("a/b/c",)},
    "scales move": {"stretched": True},
    "rigid": {"rigid": True},
    "rigid, own order": {"rigid": True, "own": ("a/d", "a/b", "e", "a")},
}


@pytest.mark.parametrize("name", _KINDS)
@pytest.mark.parametrize("seed", range(3))
def test_skinned_points_are_those_of_usd(name: str, seed: int) -> None:
    stage = Usd.Stage.CreateInMemory()
    _skin(stage, seed, **_KINDS[name])
    skinned = _ours(stage)
    for code in (-3.0, 0.0, 1.0, 2.0, 3.7, 5.0, 8.2, 9.0, 11.0, 30.0):
        got, wanted = skinned.at(code / _RATE), _theirs(stage, code)
        close = 5e-3 if "scales" in name else 3e-5  # USD rounds them to half precision
        assert np.allclose(got, wanted, atol=close, rtol=close), code
    assert skinned.breaks(-1, 1) == pytest.approx([c / _RATE for c in (0, 2, 5, 9, 12)])


def test_a_skin_without_animation_rests() -> None:
    stage = Usd.Stage.CreateInMemory()
    _skin(stage)
    skeleton = stage.GetPrimAtPath("/Root/skeleton")
    UsdSkel.BindingAPI(skeleton).GetAnimationSourceRel().ClearTargets(True)
    found = _ours(stage)
    assert isinstance(found, np.ndarray)
    assert np.allclose(found, _theirs(stage, 0), atol=3e-5)


def test_a_skin_is_a_pure_value_that_travels() -> None:
    stage = Usd.Stage.CreateInMemory()
    _skin(stage)
    skinned = _ours(stage)
    again = pickle.loads(pickle.dumps(skinned))
    assert again == skinned == _ours(stage)
    first = skinned.at(0.1)
    skinned.at(0.3)
    assert np.array_equal(first, again.at(0.1))


def test_points_that_move_are_skinned_as_they_move() -> None:
    stage = Usd.Stage.CreateInMemory()
    mesh = _skin(stage)
    rest = np.array(mesh.GetPointsAttr().Get(), np.float32)
    skeletons = Skeletons(Clock("f.usda", _RATE, 0.0), Notes())
    skeletons.add_root(stage.GetPrimAtPath("/Root"))
    points = keys([(0.0, rest), (1.0, rest + 1)])
    skinned = skeletons.skinned(mesh.GetPrim(), points)
    mesh.GetPointsAttr().Set(stages.vectors(rest + 0.25))
    assert np.allclose(value_at(skinned, 0.25), _theirs(stage, 6), atol=3e-5)


def test_the_skeleton_places_the_skin(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda", metres=0.1)
    mesh = _skin(stage)
    stages.place(UsdGeom.Xform.Get(stage, "/Root"), at=(5, 0, 0), turn=(0, 30, 0))
    stages.place(UsdSkel.Skeleton.Get(stage, "/Root/skeleton"), at=(0, 2, 0))
    stages.place(mesh, at=(0, 0, 70))  # of no account
    path = stages.save(stage)
    scene = dg.load(path, time=4 / _RATE)
    (instance,) = scene.instances
    world = UsdGeom.XformCache(4).GetLocalToWorldTransform(stage.GetPrimAtPath("/Root/skeleton"))
    assert np.allclose(
        instance.transform, np.diag([0.1, 0.1, 0.1, 1]) @ np.array(world).T, atol=1e-6
    )
    points = scene.meshes[instance.mesh].positions
    corners = np.array(mesh.GetFaceVertexIndicesAttr().Get())
    wanted = _theirs(stage, 4)[np.unique(corners)]
    nearest = np.abs(points[:, None] - wanted).max(axis=2).min(axis=1)
    assert len(points) == len(wanted)
    assert nearest.max() < 1e-4


def test_instances_bend_each_by_its_own_animation(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    _skin(stage)
    skeleton = stage.GetPrimAtPath("/Root/skeleton")
    UsdSkel.BindingAPI(skeleton).GetAnimationSourceRel().ClearTargets(True)
    for i in range(3):
        path = f"/animation{min(i, 1)}"
        if i < 2:
            made = UsdSkel.Animation.Define(stage, path)
            _animate(made, np.random.default_rng(10 + i), _JOINTS)
        one = UsdSkel.Root.Define(stage, f"/One{i}")
        one.GetPrim().GetReferences().AddInternalReference("/Root")
        one.GetPrim().SetInstanceable(True)
        UsdSkel.BindingAPI.Apply(one.GetPrim()).CreateAnimationSourceRel().AddTarget(path)
        stages.place(one, at=(10 * i, 0, 0))
    stage.GetPrimAtPath("/Root").SetSpecifier(Sdf.SpecifierClass)
    scene = dg.load(stages.save(stage), time=3 / _RATE)
    assert [one.transform[0, 3] for one in scene.instances] == [0, 10, 20]
    a, b, c = (scene.meshes[one.mesh].positions for one in scene.instances)
    assert not np.allclose(a, b)
    assert np.array_equal(b, c)
    assert len(scene.meshes) == 2  # those with one animation share a mesh
    assert sorted(scene.motion.meshes) == [0, 1]


def _bad(change: Any) -> Any:
    def made(stage: Usd.Stage) -> None:
        change(
            UsdSkel.Skeleton.Get(stage, "/Root/skeleton"),
            UsdSkel.BindingAPI(stage.GetPrimAtPath("/Root/mesh")),
            UsdSkel.Animation.Get(stage, "/Root/animation"),
        )

    return made


_FAULTS = {
    "no bind": (lambda s, b, a: s.GetBindTransformsAttr().Clear(), "bindTransforms: wanted 5"),
    "few bind": (
        lambda s, b, a: s.GetBindTransformsAttr().Set([Gf.Matrix4d(1)] * 3),
        "bindTransforms: wanted 5, got",
    ),
    "flat bind": (
        lambda s, b, a: s.GetBindTransformsAttr().Set([Gf.Matrix4d(0)] * 5),
        "bindTransforms: every matrix needs an inverse",
    ),
    "no rest": (lambda s, b, a: s.GetRestTransformsAttr().Clear(), "restTransforms: wanted 5"),
    "nan rest": (
        lambda s, b, a: s.GetRestTransformsAttr().Set([Gf.Matrix4d(float("nan"))] * 5),
        "transforms must be finite",
    ),
    "far joint": (
        lambda s, b, a: b.GetJointIndicesPrimvar().Set([99] * 120),
        r"jointIndices: wanted 0 \.\. 4, got 99",
    ),
    "negative joint": (
        lambda s, b, a: b.GetJointIndicesPrimvar().Set([-1] * 120),
        r"jointIndices: wanted 0 \.\. 4, got -1",
    ),
    "few weights": (lambda s, b, a: b.GetJointWeightsPrimvar().Set([1.0] * 7), "jointWeights"),
    "nan weights": (
        lambda s, b, a: b.GetJointWeightsPrimvar().Set([float("nan")] * 120),
        "jointWeights: numbers must be finite",
    ),
    "unknown own joint": (lambda s, b, a: b.CreateJointsAttr(["q"] * 5), "skel:joints"),
    "few turns": (
        lambda s, b, a: a.GetRotationsAttr().Set([Gf.Quatf(1)], 5),
        "rotations: wanted 3 finite values, one for each joint, got 1",
    ),
    "no scales": (
        lambda s, b, a: a.GetScalesAttr().Clear(),
        "scales: wanted 3 finite values, .* got 0",
    ),
    "nan translations": (
        lambda s, b, a: a.GetTranslationsAttr().Set([Gf.Vec3f(float("nan"))] * 3, 5),
        "translations: wanted 3 finite values",
    ),
    "joints without parents": (
        lambda s, b, a: s.GetJointsAttr().Set(["a/b", "a", "a/b", "c", "d"]),
        "skeleton.joints: each must appear once",
    ),
}


@pytest.mark.parametrize("name", _FAULTS)
def test_what_is_wrong_is_one_error_that_names_its_prim(name: str, tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    _skin(stage)
    change, told = _FAULTS[name]
    _bad(change)(stage)
    path = stages.save(stage)
    with pytest.raises(dg.InputError, match=told) as caught:
        dg.load(path)
    assert str(caught.value).startswith(f"{path}: ")
    assert "/Root/" in str(caught.value)


# Blend shapes -----------------------------------------------------------------------------------


def _blend(stage: Usd.Stage, *, between: bool = True) -> UsdGeom.Mesh:
    """A mesh of five points with a full and a sparse shape, and an animation of their weights."""
    UsdSkel.Root.Define(stage, "/Root")
    skeleton = UsdSkel.Skeleton.Define(stage, "/Root/skeleton")
    skeleton.CreateJointsAttr(["a"])
    skeleton.CreateBindTransformsAttr([Gf.Matrix4d(1)])
    skeleton.CreateRestTransformsAttr([Gf.Matrix4d(1)])
    points = np.random.default_rng(3).normal(size=(5, 3))
    mesh = stages.mesh(stage, "/Root/mesh", points, [5], range(5))
    binding = UsdSkel.BindingAPI.Apply(mesh.GetPrim())
    binding.CreateSkeletonRel().AddTarget("/Root/skeleton")
    binding.CreateBlendShapesAttr(["wide", "tall"])
    for name in ("wide", "tall"):
        binding.CreateBlendShapeTargetsRel().AddTarget(f"/Root/mesh/{name}")
    wide = UsdSkel.BlendShape.Define(stage, "/Root/mesh/wide")
    wide.CreateOffsetsAttr([(1, 0, 0)] * 5)
    if between:
        half = wide.CreateInbetween("half")
        half.SetWeight(0.5)
        half.SetOffsets([(0, 4, 0)] * 5)
    tall = UsdSkel.BlendShape.Define(stage, "/Root/mesh/tall")
    tall.CreateOffsetsAttr([(0, 0, 1), (0, 0, 2)])
    tall.CreatePointIndicesAttr([4, 1])
    made = UsdSkel.Animation.Define(stage, "/Root/animation")
    made.CreateBlendShapesAttr(["other", "tall", "wide"])
    for code, weights in ((0, (9, 0, 0)), (10, (9, 1, 1)), (20, (9, 0.5, 3)), (30, (9, -1, -1))):
        made.CreateBlendShapeWeightsAttr().Set(list(map(float, weights)), code)
    UsdSkel.BindingAPI.Apply(skeleton.GetPrim()).CreateAnimationSourceRel().AddTarget(
        "/Root/animation"
    )
    return mesh


def _blended(stage: Usd.Stage, code: float) -> np.ndarray:
    """Points by UsdSkel's own sub-shapes."""
    binding = UsdSkel.BindingAPI(stage.GetPrimAtPath("/Root/mesh"))
    query = UsdSkel.BlendShapeQuery(binding)
    weights = stage.GetPrimAtPath("/Root/animation").GetAttribute("blendShapeWeights").Get(code)
    found = query.ComputeSubShapeWeights([weights[2], weights[1]])
    points = UsdGeom.Mesh.Get(stage, "/Root/mesh").GetPointsAttr().Get()
    assert query.ComputeDeformedPoints(
        *(*found, query.ComputeBlendShapePointIndices(), query.ComputeSubShapePointOffsets()),
        points,
    )
    return np.array(points)


@pytest.mark.parametrize("between", [False, True])
def test_blend_shapes_are_those_of_usd(between: bool) -> None:
    stage = Usd.Stage.CreateInMemory()
    _blend(stage, between=between)
    moving = _ours(stage)
    for code in (-5.0, 0.0, 2.0, 5.0, 7.5, 10.0, 13.0, 20.0, 24.0, 30.0):
        assert np.allclose(moving.at(code / _RATE), _blended(stage, code), atol=1e-5), code


def test_shapes_in_between_and_sparse_ones_by_hand() -> None:
    stage = Usd.Stage.CreateInMemory()
    rest = np.array(_blend(stage).GetPointsAttr().Get())
    moving = _ours(stage)
    # At 5, both weights are 0.5: the shape in between, and half of the sparse one.
    assert np.allclose((moving.at(5 / _RATE) - rest)[:3], [(0, 4, 0), (0, 4, 1), (0, 4, 0)])
    # At 7.5 the weight is half-way from the shape in between to the whole one.
    assert np.allclose((moving.at(7.5 / _RATE) - rest)[0], (0.5, 2, 0))
    # At 20 the weight is 3: (1, 0, 0) + 4 ((1, 0, 0) - (0, 4, 0)).
    assert np.allclose((moving.at(20 / _RATE) - rest)[0], (5, -16, 0), atol=1e-5)
    assert np.allclose((moving.at(20 / _RATE) - rest)[4], (5, -16, 0.5), atol=1e-5)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda s: s.GetOffsetsAttr().Set([(0, 0, 1)] * 3), r"tall\.offsets: wanted 2"),
        (lambda s: s.GetOffsetsAttr().Clear(), r"tall\.offsets: wanted 2"),
        (lambda s: s.GetPointIndicesAttr().Set([4, 5]), r"pointIndices: wanted 0 \.\. 4"),
        (lambda s: s.GetPointIndicesAttr().Set([-1, 0]), r"pointIndices: wanted 0 \.\. 4"),
        (
            lambda s: s.GetOffsetsAttr().Set([(0, 0, float("nan"))] * 2),
            r"tall\.offsets: wanted 2 finite",
        ),
        (
            lambda s: (
                s.GetPrim()
                .GetStage()
                .GetPrimAtPath("/Root/animation")
                .GetAttribute("blendShapeWeights")
                .Set([0.0, float("inf"), 0.0], 10)
            ),
            "blendShapeWeights: keys.1.: wanted finite",
        ),
    ],
)
def test_blend_shapes_that_do_not_fit_are_one_error(tmp_path: Path, change: Any, told: str) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    _blend(stage)
    change(UsdSkel.BlendShape.Get(stage, "/Root/mesh/tall"))
    with pytest.raises(dg.InputError, match=told):
        dg.load(stages.save(stage))


def test_shapes_and_weights_that_are_missing_are_notes(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    _blend(stage)
    stage.RemovePrim("/Root/mesh/wide")
    stage.GetPrimAtPath("/Root/mesh/tall").SetTypeName("Scope")
    scene = dg.load(stages.save(stage))
    assert "a blend shape is missing (2 uses)" in scene.warnings
    weights = stage.GetPrimAtPath("/Root/animation").GetAttribute("blendShapeWeights")
    weights.Clear()
    weights.Set([1.0])
    other = stages.save(stage).rename(tmp_path / "y.usda")
    assert any("weights of blend shapes" in note for note in dg.load(other).warnings)


def test_the_blur_of_a_bending_skin_is_the_mean_of_stills(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda", rate=10.0)
    UsdSkel.Root.Define(stage, "/Root")
    skeleton = UsdSkel.Skeleton.Define(stage, "/Root/skeleton")
    skeleton.CreateJointsAttr(["a", "a/b"])
    up = Gf.Matrix4d(1).SetTranslate(Gf.Vec3d(0, 0.5, 0))
    skeleton.CreateBindTransformsAttr([Gf.Matrix4d(1), up])
    skeleton.CreateRestTransformsAttr([Gf.Matrix4d(1), up])
    made = UsdSkel.Animation.Define(stage, "/Root/animation")
    made.CreateJointsAttr(["a/b"])
    made.CreateTranslationsAttr([(0, 0.5, 0)])
    made.CreateScalesAttr(Vt.Vec3hArray([Gf.Vec3h(1)]))
    for code, degrees in ((8.0, -60), (10.5, 30), (12, 110)):
        half = np.radians(degrees / 2)
        turn = stages.quaternions([(0, 0, np.sin(half), np.cos(half))], Vt.QuatfArray)
        made.CreateRotationsAttr().Set(turn, code)
    UsdSkel.BindingAPI.Apply(skeleton.GetPrim()).CreateAnimationSourceRel().AddTarget(
        "/Root/animation"
    )
    rows = np.linspace(-0.2, 1.3, 9)
    points = [(x, y, 0) for y in rows for x in (-0.3, 0.3)]
    corners = [2 * i + k for i in range(8) for k in (0, 1, 3, 2)]
    mesh = stages.mesh(stage, "/Root/mesh", points, [4] * 8, corners)
    colors = np.random.default_rng(0).uniform(0, 1, (18, 3))
    stages.primvar(mesh, "displayColor", colors, "vertex")
    binding = UsdSkel.BindingAPI.Apply(mesh.GetPrim())
    binding.CreateSkeletonRel().AddTarget("/Root/skeleton")
    share = np.repeat(np.clip((rows - 0.2) / 0.6, 0, 1), 2)
    binding.CreateJointIndicesPrimvar(False, 2).Set([0, 1] * 18)
    weights = np.stack([1 - share, share], axis=1).ravel().tolist()
    binding.CreateJointWeightsPrimvar(False, 2).Set(weights)
    stages.place(skeleton, at=(0, -0.4, -2.5))
    scene = dg.load(stages.save(stage), time=1.0)
    scene.set_environment(color=(1, 1, 1))
    made_case = case(scene, dg.Camera(lens="pinhole", focal_length=35.0), 0.3)
    wanted = mean_of_stills(made_case, 6, 12, 12)
    assert disagreement(blurred(made_case, 6, 144), wanted) == []
    assert disagreement(frozen(made_case, 6, 144), wanted) != []


def _hinge(stage: Usd.Stage, top: str, *, moving: bool) -> None:
    """A square with normals, turned by one joint about x: by 90 degrees, or by 0 to 90 in 1 s."""
    UsdSkel.Root.Define(stage, top)
    skeleton = UsdSkel.Skeleton.Define(stage, f"{top}/skeleton")
    skeleton.CreateJointsAttr(["a"])
    skeleton.CreateBindTransformsAttr([Gf.Matrix4d(1)])
    skeleton.CreateRestTransformsAttr([Gf.Matrix4d(1)])
    made = UsdSkel.Animation.Define(stage, f"{top}/animation")
    made.CreateJointsAttr(["a"])
    made.CreateTranslationsAttr([(0, 0, 0)])
    made.CreateScalesAttr(Vt.Vec3hArray([Gf.Vec3h(1)]))
    turned = stages.quaternions([(np.sqrt(0.5), 0, 0, np.sqrt(0.5))], Vt.QuatfArray)
    if moving:
        rest = stages.quaternions([(0, 0, 0, 1)], Vt.QuatfArray)
        made.CreateRotationsAttr().Set(rest, 0)
        made.GetRotationsAttr().Set(turned, 24)
    else:
        made.CreateRotationsAttr(turned)
    UsdSkel.BindingAPI.Apply(skeleton.GetPrim()).CreateAnimationSourceRel().AddTarget(
        f"{top}/animation"
    )
    mesh = stages.mesh(stage, f"{top}/card")
    mesh.CreateNormalsAttr(stages.vectors([(0, 0, 1)] * 4))
    mesh.SetNormalsInterpolation("vertex")
    binding = UsdSkel.BindingAPI.Apply(mesh.GetPrim())
    binding.CreateSkeletonRel().AddTarget(f"{top}/skeleton")
    binding.CreateJointIndicesPrimvar(True, 1).Set([0])
    binding.CreateJointWeightsPrimvar(True, 1).Set([1.0])


@pytest.mark.parametrize("moving", [False, True])
def test_normals_of_the_file_turn_with_the_skin(tmp_path: Path, moving: bool) -> None:
    stage = stages.new_stage(tmp_path / "x.usda", rate=24.0)
    _hinge(stage, "/Root", moving=moving)
    (mesh,) = dg.load(stages.save(stage), time=1.0).meshes
    assert np.allclose(mesh.positions[:, 1], 0, atol=1e-6)
    assert np.allclose(mesh.normals, (0, -1, 0), atol=1e-6)


_RADIUS, _BEND = 0.15, np.radians(80.0)
_ROWS, _AROUND = np.linspace(-0.2, 1.3, 31), 2 * np.pi * np.arange(24) / 24


def _on_arm(y: Any, angle: Any, bend: float) -> np.ndarray:
    """Points of an arm of two joints, by the height and angle at rest."""
    share = np.clip((y - 0.2) / 0.6, 0, 1)[..., None]
    rest = np.stack([_RADIUS * np.cos(angle), y, _RADIUS * np.sin(angle)], axis=-1)
    c, s = np.cos(bend), np.sin(bend)
    elbow = np.array([0, 0.5, 0])
    turned = (rest - elbow) @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]) + elbow
    return np.asarray((1 - share) * rest + share * turned)


def _bending_arm(tmp_path: Path) -> Path:
    """A round arm with normals, bent at its elbow by up to 80 degrees in 1 s."""
    stage = stages.new_stage(tmp_path / "arm.usda", rate=24.0)
    UsdSkel.Root.Define(stage, "/Root")
    skeleton = UsdSkel.Skeleton.Define(stage, "/Root/skeleton")
    skeleton.CreateJointsAttr(["a", "a/b"])
    up = Gf.Matrix4d(1).SetTranslate(Gf.Vec3d(0, 0.5, 0))
    skeleton.CreateBindTransformsAttr([Gf.Matrix4d(1), up])
    skeleton.CreateRestTransformsAttr([Gf.Matrix4d(1), up])
    made = UsdSkel.Animation.Define(stage, "/Root/animation")
    made.CreateJointsAttr(["a/b"])
    made.CreateTranslationsAttr([(0, 0.5, 0)])
    made.CreateScalesAttr(Vt.Vec3hArray([Gf.Vec3h(1)]))
    for code, half in ((0, 0.0), (24, _BEND / 2)):
        turn = stages.quaternions([(0, 0, np.sin(half), np.cos(half))], Vt.QuatfArray)
        made.CreateRotationsAttr().Set(turn, code)
    UsdSkel.BindingAPI.Apply(skeleton.GetPrim()).CreateAnimationSourceRel().AddTarget(
        "/Root/animation"
    )
    y, angle = (grid.ravel() for grid in np.meshgrid(_ROWS, _AROUND, indexing="ij"))
    count, around = len(_ROWS), len(_AROUND)
    corners = [
        row * around + column % around
        for i in range(count - 1)
        for k in range(around)
        for row, column in ((i, k), (i + 1, k), (i + 1, k + 1), (i, k + 1))
    ]
    faces = [4] * ((count - 1) * around)
    mesh = stages.mesh(stage, "/Root/mesh", _on_arm(y, angle, 0), faces, corners)
    mesh.CreateNormalsAttr(stages.vectors(np.stack([np.cos(angle), 0 * y, np.sin(angle)], 1)))
    mesh.SetNormalsInterpolation("vertex")
    binding = UsdSkel.BindingAPI.Apply(mesh.GetPrim())
    binding.CreateSkeletonRel().AddTarget("/Root/skeleton")
    share = np.clip((y - 0.2) / 0.6, 0, 1)
    binding.CreateJointIndicesPrimvar(False, 2).Set([0, 1] * len(y))
    weights = np.stack([1 - share, share], axis=1).ravel().tolist()
    binding.CreateJointWeightsPrimvar(False, 2).Set(weights)
    return stages.save(stage)


@pytest.mark.parametrize("time", [0.0, 0.25, 0.5])
def test_normals_of_a_bending_skin_are_those_of_its_surface(tmp_path: Path, time: float) -> None:
    """Joints that turn normals alone, without the change of shape, err by up to 20 degrees here."""
    mesh = dg.load(_bending_arm(tmp_path), time=time).meshes[0]
    bend, step = _BEND * time, 1e-5
    kinks = np.abs(_ROWS[:, None] - (0.2, 0.8)).min(axis=1) < 0.03
    inner = _ROWS[1:-1][~kinks[1:-1]]
    y, angle = (grid.ravel() for grid in np.meshgrid(inner, _AROUND, indexing="ij"))
    along = _on_arm(y + step, angle, bend) - _on_arm(y - step, angle, bend)
    around = _on_arm(y, angle + step, bend) - _on_arm(y, angle - step, bend)
    normals = np.cross(around, along)
    normals /= -np.linalg.norm(normals, axis=1, keepdims=True)
    places = _on_arm(y, angle, bend)
    far = np.linalg.norm(places[:, None] - mesh.positions[None], axis=2)
    assert far.min(axis=1).max() < 1e-5
    found = mesh.normals[far.argmin(axis=1)]
    off = np.degrees(np.arccos(np.clip(np.einsum("ni,ni->n", found, normals), -1, 1)))
    assert off.max() < 2


def test_a_bending_skin_with_normals_blurs_as_the_mean_of_its_moments(tmp_path: Path) -> None:
    path = _bending_arm(tmp_path)
    place = np.eye(4)
    place[:3, 3] = -0.2, 0.5, 4
    camera = dg.Camera(transform=place, focal_length=50, sensor_size=(24, 16))
    light = np.eye(4)
    light[:3, :3] = np.array([[1, 0, 0], [0, 0.28, 0.96], [0, -0.96, 0.28]])

    def light_of(time: float, shutter_s: float) -> float:
        scene = dg.load(path, time=time)
        scene.add_light(dg.DirectionalLight((1, 1, 1)), light)
        open_ = camera.with_(shutter_time=shutter_s)
        given: dict[str, Any] = {"resolution": (24, 16), "spp": 256, "light_paths": "off"}
        return float(dg.render(scene, open_, **given).rgb.mean())

    moments = [light_of(0.6 * (k + 0.5) / 12, 0.0) for k in range(12)]
    assert max(moments) > 1.1 * min(moments) > 0
    assert light_of(0.3, 0.6) == pytest.approx(np.mean(moments), rel=3e-3)


def test_a_skin_in_an_instancer_stands_at_each_copy(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    stages.instancer(stage, "/i", [(10, 0, 0), (20, 0, 0)], prototypes=("/i/Root",))
    _hinge(stage, "/i/Root", moving=False)
    stages.place(UsdSkel.Skeleton.Get(stage, "/i/Root/skeleton"), at=(0, 5, 0))
    scene = dg.load(stages.save(stage))
    assert np.allclose(scene.meshes[0].positions[:, 1], 0, atol=1e-6)
    places = [instance.transform[:3, 3] for instance in scene.instances]
    assert np.allclose(places, [(10, 5, 0), (20, 5, 0)])
