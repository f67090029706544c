"""Stages beside the glTF that OpenUSD's own functions and the package MaterialX make of them.

The chess set is full_assets/OpenChessSet of https://github.com/usd-wg/assets.
"""

from __future__ import annotations

import os
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from pxr import Gf, Sdf, Usd, UsdGeom, UsdLux, UsdShade

import daguerre as dg
from daguerre.scene.materials import TextureSlot
from tests.support.formats import stages
from tests.support.formats.make_gltf import png
from tests.support.formats.stage_twin import write_twin
from tests.support.pictures.statistical import batch_means, differences
from tests.support.scene.same_triangles import triangle_differences

_SHARED = Path(__file__).resolve().parents[4] / "shared" / "data"
CHESS = Path(
    os.environ.get("DAGUERRE_CHESS_SET") or _SHARED / "OpenChessSet" / "chess_set.usda"
).resolve()
_SCATTERED = "subsurface scattering is shown as diffuse light of its colour (4 uses)"

_LOOKS = """<?xml version="1.0"?>
<materialx version="1.38" colorspace="lin_rec709">
  <nodegraph name="NG">
    <image name="color" type="color3">
      <input name="file" type="filename" value="color.png" colorspace="srgb_texture"/></image>
    <image name="rough" type="float">
      <input name="file" type="filename" value="rough.png"/></image>
    <image name="metal" type="float">
      <input name="file" type="filename" value="metal.png"/></image>
    <image name="bumps" type="vector3">
      <input name="file" type="filename" value="bumps.png"/></image>
    <normalmap name="map" type="vector3">
      <input name="in" type="vector3" nodename="bumps"/></normalmap>
    <output name="color_out" type="color3" nodename="color"/>
    <output name="rough_out" type="float" nodename="rough"/>
    <output name="metal_out" type="float" nodename="metal"/>
    <output name="bumps_out" type="vector3" nodename="map"/>
  </nodegraph>
  <standard_surface name="S1" type="surfaceshader">
    <input name="base_color" type="color3" nodegraph="NG" output="color_out"/>
    <input name="metalness" type="float" nodegraph="NG" output="metal_out"/>
    <input name="specular_roughness" type="float" nodegraph="NG" output="rough_out"/>
    <input name="normal" type="vector3" nodegraph="NG" output="bumps_out"/>
  </standard_surface>
  <standard_surface name="S2" type="surfaceshader">
    <input name="base_color" type="color3" value="0.7, 0.3, 0.2"/>
  </standard_surface>
  <standard_surface name="S3" type="surfaceshader">
    <input name="specular_roughness" type="float" value="0.4"/>
    <input name="transmission" type="float" value="1"/>
    <input name="transmission_color" type="color3" value="0.9, 1, 0.8"/>
  </standard_surface>
  <surfacematerial name="Pictures" type="material">
    <input name="surfaceshader" type="surfaceshader" nodename="S1"/></surfacematerial>
  <surfacematerial name="Plain" type="material">
    <input name="surfaceshader" type="surfaceshader" nodename="S2"/></surfacematerial>
  <surfacematerial name="Glass" type="material">
    <input name="surfaceshader" type="surfaceshader" nodename="S3"/></surfacematerial>
</materialx>
"""
_N = 9
_PYRAMID = [(-1, 0, -1), (1, 0, -1), (1, 0, 1), (-1, 0, 1), (0, 1.5, 0)]
_PYRAMID_FACES = [0, 1, 2, 3, 1, 0, 4, 2, 1, 4, 3, 2, 4, 0, 3, 4]


def _write_looks(folder: Path) -> None:
    """Writes a document of materials and its pictures."""
    (folder / "looks.mtlx").write_text(_LOOKS)
    rng = np.random.default_rng(2)
    for name, channels in (("color", 3), ("rough", 1), ("metal", 1)):
        pixels = rng.integers(60, 220, (8, 8, channels), np.uint8)
        (folder / f"{name}.png").write_bytes(png(pixels))
    v, u = np.meshgrid(*2 * [2 * np.pi * (np.arange(32) + 0.5) / 32], indexing="ij")
    slopes = np.stack([0.4 * np.sin(u), 0.3 * np.cos(u + 2 * v), np.ones_like(u)], axis=-1)
    normals = slopes / np.linalg.norm(slopes, axis=-1, keepdims=True)
    bumps = np.round(127.5 * (normals + 1)).astype(np.uint8)
    (folder / "bumps.png").write_bytes(png(bumps))


def _write_set(folder: Path) -> Path:
    """Writes a set with what the chess set has: copies, left-handed faces, seams, variants."""
    _write_looks(folder)
    stage = stages.new_stage(folder / "set.usda")
    root = UsdGeom.Xform.Define(stage, "/Set")
    stages.place(root, at=(0.1, 0, -0.2), turn=(0, 20, 0))
    looks = stage.DefinePrim("/Set/Looks", "Scope")
    looks.GetReferences().AddReference("./looks.mtlx", "/MaterialX/Materials")
    _add_sheet(stage)
    crowd = stages.instancer(
        stage,
        "/Set/Crowd",
        [(-0.6, 0.4, 0.5), (0, 0.4, 0.9), (0.7, 0.4, 0.4), (0, 3, 0)],
        [1, 0, 1, 0],
        ["/Set/Crowd/Box", "/Set/Crowd/Tent"],
    )
    # Exact in half precision: USD's functions do not normalize what is rounded.
    turns = [(0, 0, 0, 1), (0.5, 0.5, 0.5, 0.5), (0, 1, 0, 0), (0, 0, 0, 1)]
    crowd.CreateOrientationsAttr(stages.quaternions(turns))
    crowd.CreateScalesAttr(stages.vectors([(0.3,) * 3, (0.2, 0.2, 0.3), (0.2, 0.4, 0.2), (1,) * 3]))
    crowd.CreateInvisibleIdsAttr([3])
    _bind(stages.cube(stage, "/Set/Crowd/Box"), "Plain")
    tent = UsdGeom.Xform.Define(stage, "/Set/Crowd/Tent")
    stages.place(tent, at=(0, -1, 0))
    _bind(tent, "Glass")
    stages.mesh(
        stage, "/Set/Crowd/Tent/Cloth", _PYRAMID, [4, 3, 3, 3, 3], _PYRAMID_FACES
    )  # faces away from its inside
    return stages.save(stage)


def _add_sheet(stage: Usd.Stage) -> None:
    """Adds a wavy left-handed sheet with a seam, one part of it of another material."""
    u, v = (grid.reshape(-1) for grid in np.meshgrid(*2 * [np.linspace(0, 1, _N)]))
    points = np.stack([3 * u - 1.5, 0.1 * np.sin(6 * u), 3 * v - 1.5], axis=1)
    normals = np.stack([-0.2 * np.cos(6 * u), np.ones_like(u), 0 * u], axis=1)
    i = (np.arange(_N - 1)[:, None] * _N + np.arange(_N - 1)).reshape(-1)
    quads = np.stack([i, i + 1, i + _N + 1, i + _N], axis=1)  # down, so left-handed is up
    sheet = stages.mesh(stage, "/Set/Sheet", points, [4] * len(quads), quads.reshape(-1))
    sheet.CreateOrientationAttr(UsdGeom.Tokens.leftHanded)
    sheet.CreateNormalsAttr(stages.vectors(normals / np.linalg.norm(normals, axis=1)[:, None]))
    sheet.SetNormalsInterpolation("vertex")
    corners = quads.reshape(-1)
    right = np.repeat(u[quads].mean(axis=1) > 0.5, 4)
    st = np.concatenate([np.stack([u, v], 1), np.stack([2 - u, v + 0.25], 1)])
    stages.primvar(sheet, "st", st, "faceVarying", corners + len(u) * right)
    _bind(sheet, "Pictures")
    part = UsdShade.MaterialBindingAPI(sheet.GetPrim()).CreateMaterialBindSubset(
        "strip", [3, 11, 19, 27]
    )
    _bind(part, "Plain")


def _bind(prim: Any, name: str) -> None:
    api = UsdShade.MaterialBindingAPI.Apply(prim.GetPrim())
    binding = api.GetPrim().CreateRelationship("material:binding", False)
    binding.SetTargets([f"/Set/Looks/{name}"])  # USD alone has no prim there


def _sky() -> NDArray[np.float32]:
    """A sky that is different on all sides."""
    rows, columns = np.meshgrid(np.linspace(0, 1, 32), np.linspace(0, 1, 64), indexing="ij")
    turn = 2 * np.pi * columns
    light = [1.2 - rows, 0.6 + 0.4 * np.sin(turn), 0.7 + 0.5 * np.cos(turn + 1) * rows]
    return np.stack(light, axis=-1).astype(np.float32)


def _shot(folder: Path, of: Path, eye: Any, aim: Any) -> Path:
    """Writes a stage around another one: camera, sky and sun, and no subdivision surfaces."""
    stage = stages.new_stage(folder / "shot.usda")
    stage.GetRootLayer().subLayerPaths.append(str(of))
    for prim in stage.Traverse():
        if prim.IsA(UsdGeom.Mesh):
            UsdGeom.Mesh(prim).GetSubdivisionSchemeAttr().Set("none")
    camera = UsdGeom.Camera.Define(stage, "/Cam")
    camera.AddTransformOp().Set(Gf.Matrix4d(np.asarray(dg.look_at(eye, aim)).T))
    camera.CreateFocalLengthAttr(0.5)  # tenths of a metre
    camera.CreateHorizontalApertureAttr(0.36)
    camera.CreateVerticalApertureAttr(0.2025)
    camera.CreateFStopAttr(2.8)
    camera.CreateFocusDistanceAttr(float(np.linalg.norm(np.subtract(eye, aim))))
    sky = UsdLux.DomeLight.Define(stage, "/Sky")
    stages.picture(folder / "sky.exr", _sky())
    sky.CreateTextureFileAttr("./sky.exr")
    sun = UsdLux.DistantLight.Define(stage, "/Sun")
    sun.CreateAngleAttr(0.0)
    sun.CreateIntensityAttr(1.5)
    sun.CreateColorAttr(Gf.Vec3f(1, 0.9, 0.8))
    stages.place(sun, turn=(-50, 30, 0))
    return stages.save(stage)


def _both(shot: Path, of: Path) -> tuple[dg.Scene, dg.Scene]:
    """The scene of a stage, and that of its twin."""
    twin = dg.load(write_twin(shot, shot.with_name("twin.glb")))
    # A panorama of USD has +z at its centre, one of a scene has -z there.
    twin.set_environment(np.roll(_sky(), 32, axis=1))
    return dg.load(shot, allow_dirs=(of.parent,)), twin


def _assert_same_surfaces(ours: dg.Scene, theirs: dg.Scene) -> None:
    one, other = ({m.name: m.kind for m in scene.materials} for scene in (ours, theirs))
    assert one.keys() == other.keys()
    for name, kind in one.items():
        for field in fields(kind):
            if field.name.startswith("iridescence_"):  # no film, whose thickness does not matter
                continue
            value, wanted = getattr(kind, field.name), getattr(other[name], field.name)
            if not isinstance(value, TextureSlot):
                assert value == pytest.approx(wanted), (name, field.name)
                continue
            assert replace(value, texture=wanted.texture) == wanted
            a, b = ours.textures[value.texture], theirs.textures[wanted.texture]
            assert (a.srgb, a.wrap, a.filter) == (b.srgb, b.wrap, b.filter)
            # JPEG decoders may differ by 1.
            apart = np.abs(a.pixels.astype(np.int16) - b.pixels.astype(np.int16)).max()
            assert apart <= 1, (name, field.name)


def _assert_same(pair: tuple[dg.Scene, dg.Scene], resolution: tuple[int, int], spp: int) -> None:
    ours, theirs = pair
    assert triangle_differences(ours, theirs) == []
    _assert_same_surfaces(ours, theirs)
    one, other = ours.camera(), theirs.camera()
    assert np.allclose(one.transform, other.transform, rtol=0, atol=1e-6)
    for name in ("focal_length", "sensor_size", "f_stop", "focus_distance"):
        assert getattr(one, name) == pytest.approx(getattr(other, name), rel=1e-6)
    pictures = [
        batch_means(scene, scene.camera(), 8, spp, resolution=resolution, seed=seed)
        for scene, seed in ((ours, 100), (theirs, 200))
    ]
    means = [picture.mean() for picture in pictures]
    assert means[0] == pytest.approx(means[1], rel=0.01)
    assert np.ptp(pictures[0].mean(axis=0)) > means[0]
    assert differences(*pictures) == []


def test_a_set_is_the_gltf_that_openusd_reports(tmp_path: Path) -> None:
    of = _write_set(tmp_path)
    pair = _both(_shot(tmp_path, of, (1.2, 1.6, 3.4), (0, 0.3, 0)), of)
    assert [scene.warnings for scene in pair] == [[], []]
    assert len(pair[0].instances) == 5
    _assert_same(pair, (96, 54), 32)


@pytest.mark.slow
@pytest.mark.skipif(
    not CHESS.is_file(),
    reason="no ../shared/data/OpenChessSet, and no chess_set.usda in DAGUERRE_CHESS_SET",
)
@pytest.mark.parametrize("grey", [True, False], ids=["grey", "materials"])
def test_the_chess_set_is_the_gltf_that_openusd_reports(tmp_path: Path, grey: bool) -> None:
    shot = _shot(tmp_path, CHESS, (0.31, 0.17, 0.68), (0.0, 0.045, 0.08))
    if grey:
        _make_grey(shot)
    pair = _both(shot, CHESS)
    assert pair[0].warnings == ([] if grey else [_SCATTERED])
    assert pair[1].warnings == []
    assert len(pair[0].instances) == len(pair[1].instances) == 49
    _assert_same(pair, (320, 180), 16)


def _make_grey(shot: Path) -> None:
    """Binds one grey material to everything."""
    stage = Usd.Stage.Open(str(shot))
    grey = UsdShade.Material.Define(stage, "/Grey")
    surface = UsdShade.Shader.Define(stage, "/Grey/surface")
    surface.CreateIdAttr("UsdPreviewSurface")
    surface.CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f).Set(Gf.Vec3f(0.4))
    surface.CreateInput("metallic", Sdf.ValueTypeNames.Float).Set(0.0)
    surface.CreateInput("roughness", Sdf.ValueTypeNames.Float).Set(0.5)
    grey.CreateSurfaceOutput().ConnectToSource(surface.ConnectableAPI(), "surface")
    for prim in stage.GetPrimAtPath("/ChessSet").GetChildren():
        UsdShade.MaterialBindingAPI.Apply(prim).Bind(grey, UsdShade.Tokens.strongerThanDescendants)
    stages.save(stage)
