"""A stage and its glTF twin, written from the same arrays, give the same picture."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
from pxr import Gf, Sdf, UsdGeom, UsdLux, UsdShade

import daguerre as dg
from tests.support.formats import stages
from tests.support.formats.make_gltf import Builder, png

#: A wavy sheet with normals and texture coordinates (origin at the top left).
_N = 9
_U, _V = (grid.reshape(-1) for grid in np.meshgrid(*2 * [np.linspace(0, 1, _N)]))
_POINTS = np.stack([2 * _U - 1, 1 - 2 * _V, 0.2 * np.sin(6 * _U)], axis=1).astype(np.float32)
_NORMALS = np.stack([-0.6 * np.cos(6 * _U), 0 * _U, np.ones_like(_U)], axis=1)
_NORMALS = (_NORMALS / np.linalg.norm(_NORMALS, axis=1, keepdims=True)).astype(np.float32)
_UV = np.stack([_U, _V], axis=1).astype(np.float32)
_I = (np.arange(_N - 1)[:, None] * _N + np.arange(_N - 1)).reshape(-1)
_QUADS = np.stack([_I, _I + _N, _I + _N + 1, _I + 1], axis=1)
_TRIANGLES = np.concatenate([_QUADS[:, [0, 1, 2]], _QUADS[:, [0, 2, 3]]])


def _picture(folder: Path) -> Path:
    path = folder / "checks.png"
    rng = np.random.default_rng(1)
    pixels = rng.integers(40, 220, (8, 8, 3), np.uint8)
    path.write_bytes(png(pixels))
    return path


def _gltf(folder: Path) -> Path:
    b = Builder()
    image = _picture(folder)
    b.add("images", {"bufferView": b.view(image.read_bytes()), "mimeType": "image/png"})
    b.add("textures", {"source": 0})
    b.add(
        "materials",
        {
            "pbrMetallicRoughness": {
                "baseColorTexture": {"index": 0},
                "metallicFactor": 0.3,
                "roughnessFactor": 0.4,
            },
            "emissiveFactor": [0.01, 0.02, 0.03],
        },
    )
    attributes = {
        "POSITION": b.accessor(_POINTS),
        "NORMAL": b.accessor(_NORMALS),
        "TEXCOORD_0": b.accessor(_UV),
    }
    b.mesh(attributes, indices=b.accessor(_TRIANGLES.reshape(-1), "u2"), material=0)
    b.node(mesh=0, translation=[0, 0, -4], name="sheet")
    b.json["extensionsUsed"] = ["KHR_lights_punctual"]
    sun = {"type": "directional", "intensity": 2.0, "color": [1.0, 0.9, 0.8]}
    b.json["extensions"] = {"KHR_lights_punctual": {"lights": [sun]}}
    b.node(extensions={"KHR_lights_punctual": {"light": 0}}, rotation=[-0.3, 0, 0, math.sqrt(0.91)])
    b.add(
        "cameras",
        {
            "type": "perspective",
            "perspective": {"yfov": 2 * math.atan(12 / 50), "znear": 0.1, "aspectRatio": 1.5},
            "extras": {"daguerre": {"fStop": 2.8, "focusDistance": 4.0}},
        },
    )
    b.node(camera=0, name="Cam")
    return b.glb(folder / "twin.glb")


def _usd(folder: Path) -> Path:
    _picture(folder)
    stage = stages.new_stage(folder / "twin.usda")
    sheet = stages.mesh(stage, "/sheet", _POINTS, [4] * len(_QUADS), _QUADS.reshape(-1))
    sheet.CreateNormalsAttr(stages.vectors(_NORMALS))
    sheet.SetNormalsInterpolation("vertex")
    stages.primvar(sheet, "st", _UV * (1, -1) + (0, 1), "vertex")
    stages.place(sheet, at=(0, 0, -4))
    UsdShade.MaterialBindingAPI.Apply(sheet.GetPrim()).Bind(_material(stage))
    sun = UsdLux.DistantLight.Define(stage, "/sun")
    sun.CreateIntensityAttr(2.0)
    sun.CreateAngleAttr(0.0)
    sun.CreateColorAttr(Gf.Vec3f(1, 0.9, 0.8))
    turned = UsdGeom.Xformable(sun).AddOrientOp()
    turned.Set(Gf.Quatf(math.sqrt(0.91), Gf.Vec3f(-0.3, 0, 0)))
    camera = UsdGeom.Camera.Define(stage, "/Cam")
    camera.CreateFocalLengthAttr(0.5)  # tenths of a metre
    camera.CreateHorizontalApertureAttr(0.36)
    camera.CreateVerticalApertureAttr(0.24)
    camera.CreateFStopAttr(2.8)
    camera.CreateFocusDistanceAttr(4.0)
    return stages.save(stage)


def _material(stage: Any) -> UsdShade.Material:
    made = UsdShade.Material.Define(stage, "/Looks/M")
    surface = UsdShade.Shader.Define(stage, "/Looks/M/surface")
    surface.CreateIdAttr("UsdPreviewSurface")
    texture = UsdShade.Shader.Define(stage, "/Looks/M/texture")
    texture.CreateIdAttr("UsdUVTexture")
    texture.CreateInput("file", Sdf.ValueTypeNames.Asset).Set("./checks.png")
    texture.CreateInput("wrapS", Sdf.ValueTypeNames.Token).Set("repeat")
    texture.CreateInput("wrapT", Sdf.ValueTypeNames.Token).Set("repeat")
    reader = UsdShade.Shader.Define(stage, "/Looks/M/reader")
    reader.CreateIdAttr("UsdPrimvarReader_float2")
    reader.CreateInput("varname", Sdf.ValueTypeNames.String).Set("st")
    st = reader.CreateOutput("result", Sdf.ValueTypeNames.Float2)
    texture.CreateInput("st", Sdf.ValueTypeNames.Float2).ConnectToSource(st)
    rgb = texture.CreateOutput("rgb", Sdf.ValueTypeNames.Float3)
    surface.CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f).ConnectToSource(rgb)
    surface.CreateInput("metallic", Sdf.ValueTypeNames.Float).Set(0.3)
    surface.CreateInput("roughness", Sdf.ValueTypeNames.Float).Set(0.4)
    glow = surface.CreateInput("emissiveColor", Sdf.ValueTypeNames.Color3f)
    glow.Set(Gf.Vec3f(0.01, 0.02, 0.03))
    made.CreateSurfaceOutput().ConnectToSource(surface.ConnectableAPI(), "surface")
    return made


def test_a_stage_and_its_gltf_twin_give_the_same_picture(tmp_path: Path) -> None:
    frames = []
    for path in (_gltf(tmp_path), _usd(tmp_path)):
        scene = dg.load(path)
        assert scene.warnings == []
        frames.append(dg.render(scene, resolution=(96, 64), spp=64, seed=3))
    first, second = (frame.rgb for frame in frames)
    assert np.ptp(first) > 0.2
    assert abs(second.mean() / first.mean() - 1) < 2e-3
    blocks = [f[:64, :96].reshape(8, 8, 12, 8, 3).mean(axis=(1, 3)) for f in (first, second)]
    assert np.abs(blocks[0] - blocks[1]).max() < 0.02 * first.max()
