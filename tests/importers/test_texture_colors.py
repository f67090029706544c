"""Textures and skies of scenes whose files state primaries: colours are converted, data are not."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from tests.importers.mitsuba.scene_files import loaded
from tests.importers.pbrt.text import SQUARE, read
from tests.shading.shading_scenes import Read, color_at, shining, surface
from tests.support.pictures.stated_light import AP0, AP1, REC2020, TO_REC709, exr

COLOR = (0.4, 0.3, 0.2)
OTHER = tuple(np.array(TO_REC709[AP1]) @ COLOR)


def ap1(path: Path, color: tuple[float, ...] = COLOR, size: tuple[int, int] = (2, 2)) -> Path:
    pixels = np.broadcast_to(np.float32(color), (*size, 3))
    return exr(path, pixels, chromaticities=AP1)


def of_materialx(folder: Path, space: str, kind: str = "color3") -> Any:
    named = f' colorspace="{space}"' if space else ""
    node = (
        f'<image name="N" type="{kind}"><input name="file" type="filename" value="{folder}/a.exr"'
        f"{named}/></image>"
    )
    return Read(shining(node), folder)


@pytest.mark.parametrize(
    ("space", "wanted"),
    [("", OTHER), ("lin_rec709", OTHER), ("raw", COLOR), ("acescg", OTHER), ("data", COLOR)],
)
def test_materialx(tmp_path: Path, space: str, wanted: tuple[float, ...]) -> None:
    ap1(tmp_path / "a.exr")
    made = of_materialx(tmp_path, space)
    color = color_at(made, "emissive", 0.5, 0.5)[:3]
    np.testing.assert_allclose(color, wanted, atol=2e-5)
    told = [text for text in made.notes.sentences() if "converted" in text]
    assert len(told) == (wanted is OTHER and space != "acescg")


def test_a_space_that_the_scene_names_counts_more_than_the_file(tmp_path: Path) -> None:
    ap1(tmp_path / "a.exr")
    made = of_materialx(tmp_path, "lin_rec2020")
    wanted = np.array(TO_REC709[REC2020]) @ COLOR
    np.testing.assert_allclose(color_at(made, "emissive", 0.5, 0.5)[:3], wanted, atol=2e-5)


def test_vectors_are_data(tmp_path: Path) -> None:
    ap1(tmp_path / "a.exr")
    normal = (
        f'<image name="N" type="vector3"><input name="file" type="filename" '
        f'value="{tmp_path}/a.exr"/></image><normalmap name="M1" type="vector3">'
        '<input name="in" type="vector3" nodename="N"/></normalmap>'
    )
    inputs = '<input name="normal" type="vector3" nodename="M1"/>'
    made = Read(surface(inputs, normal), tmp_path)
    assert not [text for text in made.notes.sentences() if "converted" in text]


def test_udim_tiles_of_different_primaries(tmp_path: Path) -> None:
    ap1(tmp_path / "a.1001.exr")
    exr(tmp_path / "a.1002.exr", np.broadcast_to(np.float32(COLOR), (2, 2, 3)))
    node = (
        '<image name="N" type="color3"><input name="file" type="filename" '
        f'value="{tmp_path}/a.<UDIM>.exr"/></image>'
    ).replace("<UDIM>", "&lt;UDIM&gt;")
    made = Read(shining(node), tmp_path)
    np.testing.assert_allclose(color_at(made, "emissive", 0.5, 0.5)[:3], OTHER, atol=2e-5)
    np.testing.assert_allclose(color_at(made, "emissive", 1.5, 0.5)[:3], COLOR, atol=2e-5)


@pytest.mark.parametrize("raw", [False, True])
def test_mitsuba(tmp_path: Path, raw: bool) -> None:
    ap1(tmp_path / "a.exr")
    texture = (
        '<texture type="bitmap" name="reflectance"><string name="filename" value="a.exr"/>'
        f'<boolean name="raw" value="{str(raw).lower()}"/></texture>'
    )
    scene = loaded(tmp_path, f'<shape type="cube"><bsdf type="diffuse">{texture}</bsdf></shape>')
    kind = scene.materials[0].kind
    assert isinstance(kind, dg.Diffuse)
    assert kind.reflectance_texture is not None
    texel = scene.textures[kind.reflectance_texture.texture].pixels[0, 0, :3]
    np.testing.assert_allclose(texel, COLOR if raw else OTHER, atol=2e-5)
    assert any("converted" in text for text in scene.warnings) != raw


def test_pbrt(tmp_path: Path) -> None:
    ap1(tmp_path / "a.exr")
    scene = read(
        tmp_path,
        'Texture "t" "spectrum" "imagemap" "string filename" "a.exr" '
        f'Material "diffuse" "texture reflectance" "t" {SQUARE}',
    )
    kind = scene.materials[scene.instances[0].material].kind
    assert isinstance(kind, dg.Diffuse)
    assert kind.reflectance_texture is not None
    texel = scene.textures[kind.reflectance_texture.texture].pixels[0, 0, :3]
    np.testing.assert_allclose(np.array(kind.reflectance) * texel, OTHER, atol=2e-5)
    assert any("converted" in text for text in scene.warnings)


def skies(folder: Path) -> dict[str, Any]:
    """The same sky, in AP0, read by each format of scenes."""
    exr(folder / "sky.exr", np.full((8, 16, 3), COLOR, np.float32), chromaticities=AP0)
    exr(folder / "square.exr", np.full((8, 8, 3), COLOR, np.float32), chromaticities=AP0)
    scene = dg.Scene()
    scene.set_environment(str(folder / "sky.exr"))
    envmap = '<emitter type="envmap"><string name="filename" value="sky.exr"/></emitter>'
    infinite = 'LightSource "infinite" "string filename" "square.exr"'
    return {
        "python": scene,
        "mitsuba": loaded(folder, envmap),
        "pbrt": read(folder, f"{infinite} {SQUARE}"),
    }


def test_skies_are_converted_with_a_note(tmp_path: Path) -> None:
    wanted = np.array(TO_REC709[AP0]) @ COLOR
    for name, scene in skies(tmp_path).items():
        assert scene.environment is not None
        image, scale = scene.environment.image, scene.environment.scale
        color = (np.asarray(image).mean(axis=(0, 1)) * scale).tolist()
        np.testing.assert_allclose(np.array(color) / sum(color), wanted / wanted.sum(), atol=1e-4)
        assert [text for text in scene.warnings if "converted" in text], name


def test_a_dome_of_usd(tmp_path: Path) -> None:
    pytest.importorskip("pxr", reason="needs the package usd-core")
    exr(tmp_path / "sky.exr", np.full((8, 16, 3), COLOR, np.float32), chromaticities=AP0)
    stage = tmp_path / "a.usda"
    stage.write_text(
        '#usda 1.0\n(metersPerUnit = 1)\ndef DomeLight "L" {\n'
        "asset inputs:texture:file = @./sky.exr@\n"
        'token inputs:texture:format = "latlong"\n}\n'
    )
    scene = dg.load(stage)
    assert scene.environment is not None
    color = np.asarray(scene.environment.image).mean(axis=(0, 1))
    wanted = np.array(TO_REC709[AP0]) @ COLOR
    np.testing.assert_allclose(color / color.sum(), wanted / wanted.sum(), atol=1e-4)
    assert [text for text in scene.warnings if "converted" in text]


@pytest.mark.parametrize(("space", "wanted"), [("auto", OTHER), ("raw", COLOR)])
def test_a_texture_of_usd(tmp_path: Path, space: str, wanted: tuple[float, ...]) -> None:
    pytest.importorskip("pxr", reason="needs the package usd-core")
    ap1(tmp_path / "a.exr")
    (tmp_path / "a.usda").write_text(
        f"""#usda 1.0
def Mesh "Q" (prepend apiSchemas = ["MaterialBindingAPI"]) {{
  int[] faceVertexCounts = [3]
  int[] faceVertexIndices = [0, 1, 2]
  point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
  texCoord2f[] primvars:st = [(0, 0), (1, 0), (0, 1)] (interpolation = "vertex")
  rel material:binding = </M>
}}
def Material "M" {{
  token outputs:surface.connect = </M/S.outputs:surface>
  def Shader "S" {{
    uniform token info:id = "UsdPreviewSurface"
    color3f inputs:emissiveColor.connect = </M/T.outputs:rgb>
    float inputs:roughness.connect = </M/T.outputs:g>
    token outputs:surface
  }}
  def Shader "T" {{
    uniform token info:id = "UsdUVTexture"
    asset inputs:file = @./a.exr@
    token inputs:sourceColorSpace = "{space}"
    float3 outputs:rgb
    float outputs:g
  }}
}}
"""
    )
    scene = dg.load(tmp_path / "a.usda")
    kind = scene.materials[scene.instances[0].material].kind
    assert kind.emissive_texture is not None
    texel = scene.textures[kind.emissive_texture.texture].pixels[0, 0, :3]
    np.testing.assert_allclose(texel, wanted, atol=2e-5)
    slot = kind.metallic_roughness_texture
    assert slot is not None
    rough = kind.roughness * scene.textures[slot.texture].pixels[0, 0, 1]
    np.testing.assert_allclose(rough, COLOR[1], atol=1e-6)  # a number, whatever the primaries
