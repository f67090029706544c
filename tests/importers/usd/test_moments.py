"""Stages that are read for the time that is drawn: the same pictures, from fewer samples."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pxr import Gf, Sdf, Usd, UsdGeom, UsdLux, UsdSkel, Vt

import daguerre as dg
from daguerre.cli import main
from daguerre.errors import UsageError
from daguerre.importers.usd import wall
from daguerre.importers.usd.reader import read
from daguerre.importers.usd.values import Clock, Moments
from daguerre.motion.values import at as value_at
from daguerre.motion.values import is_dynamic
from daguerre.scene.packed.gathered import Gathered
from daguerre.setup.content_hash import content_hash
from tests.support.formats import stages

from .walls import differences_within, exact

pytestmark = pytest.mark.behind_wall  # the tests compare by themselves
_RATE, _LAST = 24.0, 96
_CODES = [*range(0, _LAST + 1, 3)]
_RNG = np.random.default_rng


def _points(schema: Any, seed: int, codes: list[int], name: str = "points") -> None:
    rng = _RNG(seed)
    at_rest = np.asarray(schema.GetPointsAttr().Get() or [(0, 0, 0), (1, 0, 0), (0, 1, 0)])
    for code in codes:
        made = rng.normal(scale=0.2, size=at_rest.shape) + (at_rest if name == "points" else 0)
        schema.GetPrim().GetAttribute(name).Set(stages.vectors(made), code)


def _skin(stage: Usd.Stage) -> None:
    root = UsdSkel.Root.Define(stage, "/skin")
    mesh = stages.cube(stage, "/skin/mesh")
    joints = Vt.TokenArray(["a", "a/b"])
    skeleton = UsdSkel.Skeleton.Define(stage, "/skin/bones")
    skeleton.CreateJointsAttr(joints)
    for make in (skeleton.CreateBindTransformsAttr, skeleton.CreateRestTransformsAttr):
        make(Vt.Matrix4dArray([Gf.Matrix4d(1)] * 2))
    moves = UsdSkel.Animation.Define(stage, "/skin/moves")
    moves.CreateJointsAttr(joints)
    rng, turns = _RNG(5), partial(stages.quaternions, kind=Vt.QuatfArray)
    for code in _CODES:
        moves.CreateTranslationsAttr().Set(stages.vectors(rng.normal(scale=0.2, size=(2, 3))), code)
        moves.CreateRotationsAttr().Set(turns(rng.normal(size=(2, 4))), code)
    moves.CreateScalesAttr(Vt.Vec3hArray([Gf.Vec3h(1)] * 2))
    binding = UsdSkel.BindingAPI.Apply(mesh.GetPrim())
    count = len(mesh.GetPointsAttr().Get())
    binding.CreateJointIndicesPrimvar(False, 1).Set(Vt.IntArray([i % 2 for i in range(count)]))
    binding.CreateJointWeightsPrimvar(False, 1).Set(Vt.FloatArray([1.0] * count))
    binding.CreateSkeletonRel().AddTarget("/skin/bones")
    UsdSkel.BindingAPI.Apply(skeleton.GetPrim()).CreateAnimationSourceRel().AddTarget("/skin/moves")
    assert root


def _come_and_go(stage: Usd.Stage, name: str) -> None:
    """A mesh whose faces and points change in number."""
    mesh = stages.cube(stage, name)
    points = np.asarray(mesh.GetPointsAttr().Get())
    faces = mesh.GetFaceVertexIndicesAttr().Get()
    for code in _CODES:
        one = code == 48
        mesh.GetPointsAttr().Set(stages.vectors(points[: 4 if one else None] + 0.01 * code), code)
        mesh.GetFaceVertexCountsAttr().Set(Vt.IntArray([4] * (1 if one else 6)), code)
        numbers = Vt.IntArray([0, 1, 3, 2]) if one else faces
        mesh.GetFaceVertexIndicesAttr().Set(numbers, code)


def _instancer(stage: Usd.Stage, name: str, *, flies: bool) -> None:
    rng = _RNG(7)
    made = stages.instancer(stage, name, rng.normal(size=(4, 3)))
    for code in _CODES:
        made.GetPositionsAttr().Set(stages.vectors(rng.normal(size=(4, 3))), code)
        if flies:
            made.CreateVelocitiesAttr().Set(stages.vectors(rng.normal(size=(4, 3))), code)
    for code in _CODES[::2]:
        made.CreateOrientationsAttr().Set(stages.quaternions(rng.normal(size=(4, 4))), code)


def _busy(folder: Path, *, holds: bool = False) -> Path:
    """A stage in which all kinds of things move, with a sample every three time codes."""
    stage = stages.new_stage(folder / "busy.usdc", rate=_RATE)
    stage.SetEndTimeCode(_LAST)
    if holds:
        stage.SetInterpolationType(Usd.InterpolationTypeHeld)
    _points(stages.cube(stage, "/linear"), 1, _CODES)
    late = stages.cube(stage, "/late")  # at rest while most pictures are taken
    for code in _CODES[-3:]:
        late.GetPointsAttr().Set(
            stages.vectors(np.asarray(late.GetPointsAttr().Get()) + 0.1 * (code == _LAST)), code
        )
    still = stages.cube(stage, "/still")
    for code in _CODES:
        still.GetPointsAttr().Set(still.GetPointsAttr().Get(), code)
    smooth = stages.cube(stage, "/smooth", "catmullClark")
    _points(smooth, 2, _CODES)
    flies = stages.cube(stage, "/flies")
    for name in ("points", "velocities", "accelerations"):
        _points(flies, 3, _CODES, name)
    _come_and_go(stage, "/comes")
    _skin(stage)
    _instancer(stage, "/crowd", flies=False)
    _instancer(stage, "/swarm", flies=True)
    lamp = UsdLux.SphereLight.Define(stage, "/lamp")
    for code in _CODES:
        lamp.CreateIntensityAttr().Set(100.0 + code, code)
        UsdGeom.XformCommonAPI(lamp).SetTranslate(Gf.Vec3d(0, 4, 0.02 * code), code)
        UsdGeom.XformCommonAPI(stage.GetPrimAtPath("/still")).SetRotate((0, code, 0), time=code)
        UsdGeom.Imageable(late).CreateVisibilityAttr().Set("inherited", code)
    UsdGeom.Imageable(still).CreateVisibilityAttr().Set("invisible", 60)
    camera = UsdGeom.Camera.Define(stage, "/camera")
    camera.CreateFocalLengthAttr(20.0)
    for code in _CODES:
        UsdGeom.XformCommonAPI(camera).SetTranslate(Gf.Vec3d(0.01 * code, 0, 9), code)
        camera.CreateFocusDistanceAttr().Set(9.0 + 0.01 * code, code)
    return stages.save(stage)


_MOMENTS = ((-1.0, -0.9), (0.0, 0.05), (1.0, 1.0), (1.97, 2.04), (2.6, 3.2), (3.9, 4.5))


@pytest.mark.parametrize("holds", [False, True])
@pytest.mark.parametrize("moments", _MOMENTS)
def test_moments_have_the_bits_of_the_whole_file(
    tmp_path: Path, moments: tuple[float, float], holds: bool
) -> None:
    path, (begin, end) = _busy(tmp_path, holds=holds), moments
    time = 0.5 * (begin + end)
    whole, part = dg.load(path, time=time), dg.load(path, time=time, moments=moments)
    assert differences_within(whole, part, begin, end) == []
    assert part.moments == moments
    assert whole.moments is None
    assert content_hash(whole, moments) == content_hash(part, moments)
    camera = replace(whole.camera(), shutter_time=0.98 * (end - begin))
    pictures = [dg.render(one, camera, resolution=(32, 18), spp=4) for one in (whole, part)]
    assert exact(pictures[0].rgb, pictures[1].rgb)


def test_only_samples_around_the_moments_are_kept(tmp_path: Path) -> None:
    scene = dg.load(_busy(tmp_path), time=1.0, moments=(0.99, 1.01))
    names = {mesh.name: i for i, mesh in enumerate(scene.meshes)}
    kept = {name: scene.motion.meshes[names[name]] for name in ("/linear", "/smooth", "/flies")}
    codes = {name: [round(_RATE * t) for t in one.breaks(-9, 9)] for name, one in kept.items()}
    assert codes == {"/linear": [21, 24, 27], "/smooth": [21, 24, 27], "/flies": [21, 24, 27]}
    crowd = [one for one in scene.motion.instances.values() if len(one.breaks(-9, 9)) < 5]
    assert len(crowd) == 8
    assert len(scene.camera().motion["focus_distance"].times) == len(_CODES)  # numbers stay


@pytest.mark.parametrize("seed", range(60))
def test_arrays_with_blocked_samples_are_the_same_at_the_moments(seed: int) -> None:
    rng = _RNG(seed)
    stage = Usd.Stage.CreateInMemory()
    attribute = UsdSkel.Animation.Define(stage, "/a").CreateBlendShapeWeightsAttr()
    attribute.Set(Vt.FloatArray([9.0, 9.0]))
    for code in np.sort(rng.choice(40, rng.integers(1, 7), replace=False)):
        value = Vt.FloatArray([float(rng.integers(2))] * 2)
        attribute.Set(Sdf.ValueBlock() if rng.random() < 0.5 else value, float(code))
    begin = rng.uniform(-3, 42)
    end = begin + rng.choice([0.0, 0.5, 8.0])
    clock = Clock("f.usda", 1.0, 0.5 * (begin + end), holds=bool(seed % 2))
    moments = Moments(float(begin), float(end))
    whole, part = (
        one.value(attribute, np.asarray, large=True)
        for one in (clock, replace(clock, moments=moments))
    )
    assert is_dynamic(whole) == is_dynamic(part)
    for time in np.linspace(begin, end, 7):
        assert exact(*(value_at(one, float(time)) for one in (whole, part)))


def test_other_moments_are_refused(tmp_path: Path) -> None:
    scene = dg.load(_busy(tmp_path), time=1.0, moments=(0.5, 1.5))
    assert scene.at(1.2).moments == (0.5, 1.5)
    with pytest.raises(UsageError, match=r"time: wanted 0.5 \.\. 1.5 s, the moments .* got 2$"):
        scene.at(2)
    camera = replace(scene.camera(), shutter_time=1.1)
    with pytest.raises(UsageError, match=r"got 0\.45 \.\. 1\.55$"):
        dg.render(scene, camera, resolution=(8, 8), spp=1)
    for wrong in ((1.5, 0.5), (2.0, 3.0)):
        with pytest.raises(UsageError, match="moments: wanted an interval with the time 1 s"):
            dg.load(scene.path, time=1.0, moments=wrong)


def _loads(monkeypatch: pytest.MonkeyPatch) -> list[tuple[Any, Any]]:
    """Moments that loads ask for, and those that their scenes have."""
    found, read = [], wall.read

    def noted(path: Any, **options: Any) -> Any:
        scene = read(path, **options)
        found.append((options.get("moments"), scene.moments))
        return scene

    monkeypatch.setattr(wall, "read", noted)
    return found


_DRAW = ("--res", "24x16", "--spp", "4", "--quiet")


@pytest.mark.parametrize(
    ("flags", "loads"),
    [
        ((), 1),
        (("--aov", "motion,motion_back,depth"), 1),
        (("--shutter", "2s"), 2),
        (("--shutter", "2s", "--aov", "motion,motion_back"), 2),
        (("--fps", "6", "--shutter-offset", "-1"), 1),
        (("--shutter-type", "electronic"), 1),
    ],
)
def test_render_reads_the_time_that_it_draws(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, flags: tuple[str, ...], loads: int
) -> None:
    path, made = _busy(tmp_path), _loads(monkeypatch)
    words = [str(path), *_DRAW, "--time", "2", *flags, "-o"]
    assert main(["render", *words, str(tmp_path / "part.exr")]) == 0
    assert len(made) == loads
    assert all(kept == asked is not None for asked, kept in made)
    _read_whole(monkeypatch)
    assert main(["render", *words, str(tmp_path / "whole.exr")]) == 0
    assert made[-1] == (None, None)
    assert _same_files(tmp_path / "part.exr", tmp_path / "whole.exr")


@pytest.mark.parametrize("rate", [None, 12.0, 48.0])
def test_a_sequence_reads_the_time_of_its_frames(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, rate: float | None
) -> None:
    path, made = _busy(tmp_path), _loads(monkeypatch)
    if rate is not None:
        stage = Usd.Stage.Open(str(path))
        stage.SetFramesPerSecond(rate)
        stage.Save()
    words = [str(path), *_DRAW, "--frames", "10-12", "-o"]
    assert main(["render", *words, str(tmp_path / "part.##.exr")]) == 0
    assert all(kept == asked is not None for asked, kept in made)
    assert len(made) == 1 + (rate == 12)
    _read_whole(monkeypatch)
    assert main(["render", *words, str(tmp_path / "whole.##.exr")]) == 0
    for frame in (10, 12):
        both = (tmp_path / f"{name}.{frame}.exr" for name in ("part", "whole"))
        assert _same_files(*both)


def _read_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    read = wall.read
    monkeypatch.setattr(
        wall, "read", lambda path, **options: read(path, **options | {"moments": None})
    )


def _same_files(one: Path, other: Path) -> bool:
    return all(
        exact(first, second)
        for first, second in zip(
            *(sorted_planes(dg.load_frame(path)) for path in (one, other)), strict=True
        )
    )


def sorted_planes(frame: Any) -> list[Any]:
    """All planes of a frame."""
    return [frame.rgb, *(frame.aovs[name] for name in sorted(frame.aovs))]


def test_info_tells_all_that_moves(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    path, made = _busy(tmp_path), _loads(monkeypatch)
    words = ["info", str(path), "--time", "1", "--json"]
    assert main(words) == 0
    part = capsys.readouterr().out
    _read_whole(monkeypatch)
    assert main(words) == 0
    assert capsys.readouterr().out == part
    assert [kept for _, kept in made] == [(1.0, 1.0), None]


def test_a_moment_of_a_long_animation_is_small(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    stage = stages.new_stage(tmp_path / "long.usdc")
    mesh = stages.cube(stage, "/p")
    rng = _RNG(1)
    for code in range(100):
        mesh.CreatePointsAttr().Set(stages.vectors(rng.normal(size=(10_000, 3))), code)
    path, sizes, made = stages.save(stage), [], wall._scene
    monkeypatch.setattr(wall, "_scene", lambda answer: (sizes.append(answer.size), made(answer))[1])
    wall.read(path, time=2.0, moments=(1.99, 2.01))
    wall.read(path, time=2.0)
    assert sizes[1] > 1e7
    assert sizes[0] < 0.1 * sizes[1]


def test_points_for_the_wall_stay_in_the_memory_of_the_stage(tmp_path: Path) -> None:
    path, found = _busy(tmp_path), Gathered()
    read(path, into=found)
    whole = read(path)
    i = next(i for i, mesh in enumerate(whole.meshes) if mesh.name == "/linear")
    owns = [
        scene.motion.meshes[i].positions.points.values[0].flags.owndata  # type: ignore[attr-defined]
        for scene in (found, whole)
    ]
    assert owns == [False, True]
    assert found.owner.GetPrimAtPath("/linear")
