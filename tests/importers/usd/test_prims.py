"""Purposes, visibility, instances and names of prims."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pytest
from pxr import Gf, Sdf, Usd, UsdGeom

import daguerre as dg
from tests.support.formats import stages

_DEEP = 1500


def _names(scene: dg.Scene) -> set[str]:
    return {one.name for one in scene.instances if one.shown}


def _purposes(tmp_path: Path) -> Path:
    stage = stages.new_stage(tmp_path / "x.usda")
    for purpose in ("default", "render", "proxy", "guide"):
        UsdGeom.Xform.Define(stage, f"/{purpose}").CreatePurposeAttr(purpose)
        UsdGeom.Xform.Define(stage, f"/{purpose}/in")
        stages.mesh(stage, f"/{purpose}/in/card")
    stages.mesh(stage, "/proxy/own").CreatePurposeAttr("render")
    stages.mesh(stage, "/render/own").CreatePurposeAttr("default")
    return stages.save(stage)


@pytest.mark.parametrize(
    ("purpose", "drawn"),
    [
        (("render",), {"default/in/card", "render/in/card", "render/own", "proxy/own"}),
        (("default",), {"default/in/card", "render/own"}),
        (("proxy",), {"default/in/card", "render/own", "proxy/in/card"}),
        (("default", "guide"), {"default/in/card", "render/own", "guide/in/card"}),
    ],
)
def test_purposes_are_inherited_and_chosen(
    tmp_path: Path, purpose: tuple[str, ...], drawn: set[str]
) -> None:
    assert _names(dg.load(_purposes(tmp_path), purpose=purpose)) == drawn


def test_purposes_of_prototypes_are_inherited(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    UsdGeom.Xform.Define(stage, "/i/p").CreatePurposeAttr("proxy")
    stages.mesh(stage, "/i/p/a")
    stages.cube(stage, "/i/p/b").CreatePurposeAttr("render")
    stages.instancer(stage, "/i", np.zeros((1, 3)), None, ("/i/p",))
    path = stages.save(stage)
    for purpose, size in (("proxy", 4), ("render", 8)):
        scene = dg.load(path, purpose=(purpose,))
        assert [len(scene.meshes[one.mesh].positions) for one in scene.instances] == [size]


def test_an_unknown_purpose_is_named(tmp_path: Path) -> None:
    with pytest.raises(dg.UsageError, match=r"purpose: wanted .* got 'rendr'"):
        dg.load(_purposes(tmp_path), purpose=("rendr",))


def test_what_is_invisible_hides_its_children(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    for name in ("a", "b"):
        UsdGeom.Xform.Define(stage, f"/{name}")
        stages.mesh(stage, f"/{name}/card")
    UsdGeom.Imageable(stage.GetPrimAtPath("/a")).MakeInvisible()
    UsdGeom.Imageable(stage.GetPrimAtPath("/a/card")).CreateVisibilityAttr("inherited")
    moving = stages.mesh(stage, "/a/blinks").CreateVisibilityAttr()
    for code, token in enumerate(("invisible", "inherited")):
        moving.Set(token, code)
    scene = dg.load(stages.save(stage))
    assert {one.name for one in scene.instances} == {"b/card"}
    assert scene.nodes["a"] == []


def test_visibility_changes_over_time(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda", rate=10.0)
    top = UsdGeom.Xform.Define(stage, "/a").CreateVisibilityAttr()
    own = stages.mesh(stage, "/a/card").CreateVisibilityAttr()
    for attribute, codes in ((top, (0, 10, 30)), (own, (0, 20, 40))):
        for code, token in zip(codes, ("inherited", "invisible", "inherited"), strict=True):
            attribute.Set(token, code)
    path = stages.save(stage)
    scene = dg.load(path)
    seen = [bool(scene.at(t).instances[0].shown) for t in (0, 0.99, 1, 1.5, 2, 3, 3.9, 4)]
    assert seen == [True, True, False, False, False, False, False, True]
    assert scene.motion.shown[0].breaks(0.5, 3.5) == [1.0, 2.0, 3.0]
    assert pickle.loads(pickle.dumps(scene.motion.shown[0])) == scene.motion.shown[0]
    assert scene == dg.load(path)


def test_what_blinks_may_be_scaled_to_zero(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda", rate=10.0)
    card = stages.mesh(stage, "/card")
    stages.place(card, scale=(0, 0, 0))
    for code, token in enumerate(("invisible", "inherited")):
        card.CreateVisibilityAttr().Set(token, code)
    scene = dg.load(stages.save(stage))
    assert not scene.instances
    note = "a prim that is scaled to zero or sheared flat is left out (1 use)"
    assert any(note in said for said in scene.warnings)


def test_instances_share_meshes_and_have_names(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    UsdGeom.Xform.Define(stage, "/Thing")
    stages.place(stages.cube(stage, "/Thing/cube"), at=(0, 1, 0))
    for i in range(50):
        one = UsdGeom.Xform.Define(stage, f"/World/n{i}")
        one.GetPrim().GetReferences().AddInternalReference("/Thing")
        one.GetPrim().SetInstanceable(True)
        stages.place(one, at=(i, 0, 0))
    stage.GetPrimAtPath("/Thing").SetSpecifier(Sdf.SpecifierClass)
    scene = dg.load(stages.save(stage))
    assert len(scene.meshes) == 1
    assert len(scene.instances) == 50
    assert scene.nodes["World"] == list(range(50))
    assert scene.nodes["World/n7"] == scene.nodes["World/n7/cube"] == [7]
    assert np.allclose(scene.instances[7].transform[:3, 3], (7, 1, 0))
    assert np.allclose(scene.node_positions["World/n7/cube"], (7, 1, 0))


def test_only_defined_active_prims_are_drawn(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    for name in ("on", "off", "abstract", "over"):
        stages.mesh(stage, f"/{name}")
    stage.GetPrimAtPath("/off").SetActive(False)
    stage.GetPrimAtPath("/abstract").SetSpecifier(Sdf.SpecifierClass)
    stage.GetPrimAtPath("/over").SetSpecifier(Sdf.SpecifierOver)
    scene = dg.load(stages.save(stage))
    assert _names(scene) == {"on"}
    assert set(scene.nodes) == {"on"}


def test_a_prim_without_a_kind_passes_transforms_on_to_its_children(tmp_path: Path) -> None:
    stage = stages.new_stage(tmp_path / "x.usda")
    stages.place(UsdGeom.Xform.Define(stage, "/a"), at=(1, 0, 0))
    stage.DefinePrim("/a/plain")
    stage.DefinePrim("/a/plain/strange", "NoSuchType")
    stages.place(stages.mesh(stage, "/a/plain/strange/card"), at=(0, 2, 0))
    scene = dg.load(stages.save(stage))
    assert np.allclose(scene.instances[0].transform[:3, 3], (1, 2, 0))
    assert scene.nodes["a"] == [0]


def test_a_deep_tree_is_read(tmp_path: Path) -> None:
    path = Sdf.Path.absoluteRootPath
    layer = Sdf.Layer.CreateNew(str(tmp_path / "x.usdc"))
    spec: Sdf.PrimSpec | Sdf.Layer = layer
    for _ in range(_DEEP):
        spec = Sdf.PrimSpec(spec, "a", Sdf.SpecifierDef, "Xform")
        path = path.AppendChild("a")
    stage = Usd.Stage.Open(layer)
    stages.place(stages.mesh(stage, "/a/a/card"), at=(1, 2, 3))
    UsdGeom.Xformable(stage.GetPrimAtPath(path)).AddTranslateOp().Set(Gf.Vec3d(100, 0, 0))
    layer.Save()
    del stage, layer, spec
    scene = dg.load(tmp_path / "x.usdc")
    assert len(scene.nodes) == _DEEP + 1
    assert np.allclose(scene.node_positions[str(path)[1:]], (1, 0, 0))


@pytest.mark.in_process
def test_prims_too_many_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("daguerre.importers.usd.prims.MAX_PRIMS", 20)
    stage = stages.new_stage(tmp_path / "x.usda")
    for i in range(21):
        UsdGeom.Xform.Define(stage, f"/n{i}")
    with pytest.raises(dg.InputError, match="too many prims and instances: the limit is 20"):
        dg.load(stages.save(stage))
