"""Materials of USD stages: preview surfaces, networks of MaterialX, and arcs to ``.mtlx`` files."""

from __future__ import annotations

import math
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.files.notes import Notes
from daguerre.scene.materials import Gltf
from tests.shading.shading_scenes import Read, color_at, looked_up, write

pytest.importorskip("pxr", reason="needs the package usd-core")

from pxr import Sdf, Usd, UsdShade

from daguerre.importers.usd.materials import Materials
from daguerre.shading.images import Images
from daguerre.shading.udim import stitched

ALL = ("st", "st1", "displayColor")


class Clock:
    """Time of the stages in these tests: a time code is a second."""

    def value(self, attribute: Any) -> Any:
        samples = attribute.GetTimeSamples()
        if len(samples) < 2:
            return attribute.Get(Usd.TimeCode.EarliestTime())
        values = [attribute.Get(time) for time in samples]
        rows = [value if isinstance(value, float) else tuple(map(float, value)) for value in values]
        return dg.keys(zip(samples, rows, strict=True))


class Stage:
    """A stage in memory with materials, and the scene that they come into."""

    def __init__(self, text: str, folder: Path, **options: Any) -> None:
        file = folder / f"stage{len(list(folder.glob('*.usda')))}.usda"  # USD keeps layers open
        layer = Sdf.Layer.CreateNew(str(file))
        lines = text.replace("}def", "}\ndef").replace(" }", "\n}")  # each member ends a line
        assert layer.ImportFromString(f"#usda 1.0\n{lines}")
        layer.Save()
        self.stage = Usd.Stage.Open(layer)
        self.scene, self.notes = dg.Scene(), Notes()
        self.images = Images(self.scene, lambda place, path: Path(path), self.notes)
        self.materials = Materials(self.scene, self.images, Clock(), self.notes, **options)

    def read(self, path: str = "/M", has: Any = ALL) -> Any:
        index = self.materials.index_at(self.stage, Sdf.Path(path), has)
        self.material = self.scene.materials[index]
        assert isinstance(self.material.kind, Gltf)
        self.kind = self.material.kind
        return self


def preview(inputs: str, others: str = "") -> str:
    return f"""def Material "M" {{
      token outputs:surface.connect = </M/S.outputs:surface>
      def Shader "S" {{ uniform token info:id = "UsdPreviewSurface"
        {inputs}
        token outputs:surface }}
      {others} }}"""


def texture(name: str, inputs: str, file: str = "./a.png", st: str = "") -> str:
    coordinates = f"float2 inputs:st.connect = <{st}>" if st else ""
    return f"""def Shader "{name}" {{ uniform token info:id = "UsdUVTexture"
      asset inputs:file = @{file}@
      {coordinates}
      {inputs}
      float outputs:r
      float outputs:g
      float outputs:b
      float outputs:a
      float3 outputs:rgb }}"""


READER = """def Shader "P" { uniform token info:id = "UsdPrimvarReader_float2"
  string inputs:varname = "st"
  float2 inputs:fallback = (0.6, 0.2)
  float2 outputs:result }"""
ST = "/M/P.outputs:result"
SHOWN = "color3f inputs:emissiveColor.connect = </M/T.outputs:rgb>"
RNG = np.random.default_rng(11)


# --- UsdPreviewSurface


def test_defaults_are_those_of_the_specification(tmp_path: Path) -> None:
    kind = Stage(preview(""), tmp_path).read().kind
    assert kind.base_color == pytest.approx((0.18, 0.18, 0.18))
    assert (kind.metallic, kind.roughness, kind.ior) == (0, 0.5, 1.5)
    assert (kind.clearcoat, kind.alpha_mode, kind.transmission) == (0, "opaque", 0)
    assert kind.normal_texture is None


def test_metallic_workflow(tmp_path: Path) -> None:
    inputs = """color3f inputs:diffuseColor = (0.1, 0.2, 0.3)
      color3f inputs:emissiveColor = (100, 50, 25)
      float inputs:metallic = 0.75
      float inputs:roughness = 0.25
      float inputs:ior = 1.8
      float inputs:clearcoat = 0.5
      float inputs:clearcoatRoughness = 0.125"""
    found = Stage(preview(inputs), tmp_path).read()
    kind = found.kind
    assert kind.base_color == pytest.approx((0.1, 0.2, 0.3))
    assert kind.emissive == (100, 50, 25)
    assert (kind.metallic, kind.roughness) == (0.75, 0.25)
    assert kind.ior == pytest.approx(1.8)
    assert (kind.clearcoat, kind.clearcoat_roughness) == (0.5, 0.125)
    assert found.notes.sentences() == []


def test_specular_workflow_has_its_reflectance(tmp_path: Path) -> None:
    """An index of 0 reflects everything in the core; the colour scales that to F0."""
    inputs = """int inputs:useSpecularWorkflow = 1
      color3f inputs:specularColor = (0.2, 0.3, 0.4)
      float inputs:metallic = 1"""
    kind = Stage(preview(inputs), tmp_path).read().kind
    assert (kind.metallic, kind.ior, kind.specular) == (0, 0, 1)
    assert kind.specular_color == pytest.approx((0.2, 0.3, 0.4))


def test_opacity(tmp_path: Path) -> None:
    def kind(inputs: str) -> Gltf:
        found: Gltf = Stage(preview(inputs), tmp_path).read().kind
        return found

    mask = kind("float inputs:opacity = 0.5\nfloat inputs:opacityThreshold = 0.25")
    assert (mask.alpha_mode, mask.base_alpha, mask.alpha_cutoff) == ("mask", 0.5, 0.25)
    there = kind('float inputs:opacity = 0.5\ntoken inputs:opacityMode = "presence"')
    assert (there.alpha_mode, there.base_alpha) == ("blend", 0.5)
    color = "color3f inputs:diffuseColor = (0.4, 0.4, 0.4)\n"
    sheet = kind(color + "float inputs:opacity = 0.25")
    base, clear = sheet.base_color[0], sheet.transmission
    assert base * (1 - clear) == pytest.approx(0.4 * 0.25)  # diffuse light
    assert base * clear == pytest.approx(0.75)  # straight through
    assert (sheet.alpha_mode, sheet.thickness) == ("opaque", 0)
    glass = kind("float inputs:opacity = 0")
    assert (glass.base_color, glass.transmission) == ((1, 1, 1), 1)


def test_displacement_is_one_note_and_occlusion_none(tmp_path: Path) -> None:
    inputs = "float inputs:displacement = 0.1\nfloat inputs:occlusion = 0.5"
    found = Stage(preview(inputs), tmp_path).read()
    assert found.notes.sentences() == ["displacement of a material is not supported (1 use)"]


# --- UsdUVTexture


@pytest.mark.parametrize(
    ("channels", "space", "is_srgb"),
    [
        (3, "auto", True),
        (4, "auto", True),
        (1, "auto", False),
        (3, "raw", False),
        (1, "sRGB", True),
        (3, "sRGB", True),
    ],
)
def test_source_colour_space(channels: int, space: str, is_srgb: bool, tmp_path: Path) -> None:
    write(tmp_path / "a.png", RNG.integers(0, 256, (2, 2, channels), np.uint8))
    inputs = f'token inputs:sourceColorSpace = "{space}"'
    found = Stage(preview(SHOWN, texture("T", inputs, st=ST) + READER), tmp_path).read()
    assert found.scene.textures[0].srgb is is_srgb


def test_colour_space_of_an_attribute(tmp_path: Path) -> None:
    write(tmp_path / "a.png", RNG.integers(0, 256, (2, 2, 3), np.uint8))
    file = texture("T", "", st=ST).replace(
        "@./a.png@", '@./a.png@ (colorSpace = "lin_rec709_scene")'
    )
    found = Stage(preview(SHOWN, file + READER), tmp_path).read()
    assert not found.scene.textures[0].srgb
    assert found.notes.sentences() == []


def test_scale_and_bias_are_exact(tmp_path: Path) -> None:
    pixels = RNG.integers(0, 256, (3, 2, 4), np.uint8)
    write(tmp_path / "a.png", pixels)
    inputs = """token inputs:sourceColorSpace = "raw"
      float4 inputs:scale = (2, 0.5, 1, 1)
      float4 inputs:bias = (0, 0.25, -0.5, 0)"""
    found = Stage(preview(SHOWN, texture("T", inputs, st=ST) + READER), tmp_path).read()
    for y in range(3):
        for x in range(2):
            raw = pixels[y, x, :3] / 255
            wanted = np.maximum(raw * (2, 0.5, 1) + (0, 0.25, -0.5), 0)
            at = (x + 0.5) / 2, 1 - (y + 0.5) / 3
            assert color_at(found, "emissive", *at) == pytest.approx(wanted, abs=1e-6)


def test_single_outputs_and_opacity(tmp_path: Path) -> None:
    pixels = RNG.integers(0, 256, (2, 2, 4), np.uint8)
    write(tmp_path / "a.png", pixels)
    inputs = """color3f inputs:diffuseColor.connect = </M/T.outputs:rgb>
      float inputs:opacity.connect = </M/T.outputs:a>
      float inputs:opacityThreshold = 0.5
      float inputs:roughness.connect = </M/T.outputs:g>
      float inputs:metallic.connect = </M/T.outputs:r>"""
    raw = 'token inputs:sourceColorSpace = "raw"'
    found = Stage(preview(inputs, texture("T", raw, st=ST) + READER), tmp_path).read()
    assert np.array_equal(
        found.scene.textures[found.kind.base_color_texture.texture].pixels, pixels
    )
    packed = found.scene.textures[found.kind.metallic_roughness_texture.texture].pixels
    assert np.array_equal(packed[:, :, 1], pixels[:, :, 1])
    assert np.array_equal(packed[:, :, 2], pixels[:, :, 0])
    assert found.kind.alpha_mode == "mask"


def test_grey_with_opacity(tmp_path: Path) -> None:
    pixels = np.array([[[51, 204]]], np.uint8)
    write(tmp_path / "a.png", pixels)
    inputs = """color3f inputs:diffuseColor.connect = </M/T.outputs:rgb>
      float inputs:opacity.connect = </M/T.outputs:a>
      float inputs:opacityThreshold = 0.5"""
    found = Stage(preview(inputs, texture("T", "", st=ST) + READER), tmp_path).read()
    texel = looked_up(found.scene, found.kind.base_color_texture, 0.5, 0.5)
    assert texel == pytest.approx((0.2, 0.2, 0.2, 0.8))


def test_normal_maps_need_no_copy(tmp_path: Path) -> None:
    pixels = RNG.integers(0, 256, (4, 4, 3), np.uint8)
    write(tmp_path / "a.png", pixels)
    inputs = """token inputs:sourceColorSpace = "raw"
      float4 inputs:scale = (2, 2, 2, 1)
      float4 inputs:bias = (-1, -1, -1, 0)"""
    normal = "normal3f inputs:normal.connect = </M/T.outputs:rgb>"
    found = Stage(preview(normal, texture("T", inputs, st=ST) + READER), tmp_path).read()
    assert np.array_equal(found.scene.textures[0].pixels, pixels)
    assert found.kind.normal_scale == 1
    odd = inputs.replace("(2, 2, 2, 1)", "(2, -2, 2, 1)").replace("(-1, -1,", "(-1, 1,")
    found = Stage(preview(normal, texture("T", odd, st=ST) + READER), tmp_path).read()
    texel = looked_up(found.scene, found.kind.normal_texture, 0.125, 0.875)[:3]
    wanted = pixels[0, 0] / 255
    wanted[1] = 1 - wanted[1]  # green downward in this file
    assert texel == pytest.approx(wanted, abs=1e-6)


@pytest.mark.parametrize("wrap", ["repeat", "clamp", "mirror", "black", "useMetadata"])
def test_wrapping(wrap: str, tmp_path: Path) -> None:
    pixels = np.array([[[10], [20]], [[30], [40]]], np.uint8)
    write(tmp_path / "a.png", pixels)
    inputs = f'token inputs:wrapS = "{wrap}"\ntoken inputs:wrapT = "{wrap}"'
    found = Stage(preview(SHOWN, texture("T", inputs, st=ST) + READER), tmp_path).read()
    for s in (-0.3, 0.2, 0.7, 1.2, 1.7):
        for t in (-0.7, 0.2, 0.8, 1.4):
            i, j = math.floor(2 * s), math.floor(2 * t)
            if wrap == "black" and not (0 <= i < 2 and 0 <= j < 2):
                wanted = 0.0
            else:
                at = [
                    min(max(k, 0), 1) if wrap == "clamp" else k % 2 if wrap != "mirror"
                    else (0, 1, 1, 0)[k % 4]
                    for k in (i, j)
                ]  # fmt: skip
                wanted = pixels[1 - at[1], at[0], 0] / 255
            assert color_at(found, "emissive", s, t)[0] == pytest.approx(wanted)


def test_transform_2d(tmp_path: Path) -> None:
    """Scale, then rotation counter-clockwise, then translation."""
    pixels = RNG.integers(0, 256, (8, 8, 1), np.uint8)
    write(tmp_path / "a.png", pixels)
    nodes = """def Shader "X" { uniform token info:id = "UsdTransform2d"
      float2 inputs:in.connect = </M/P.outputs:result>
      float2 inputs:scale = (2, 0.5)
      float inputs:rotation = 30
      float2 inputs:translation = (0.1, 0.2)
      float2 outputs:result }"""
    file = texture("T", "", st="/M/X.outputs:result")
    found = Stage(preview(SHOWN, file + nodes + READER), tmp_path).read()
    cosine, sine = math.cos(math.pi / 6), math.sin(math.pi / 6)
    for s, t in ((0.13, 0.31), (0.77, 0.52), (0.4, 0.93)):
        x, y = 2 * s, 0.5 * t
        x, y = cosine * x - sine * y + 0.1, sine * x + cosine * y + 0.2
        wanted = pixels[7 - math.floor(8 * y) % 8, math.floor(8 * x) % 8, 0] / 255
        assert color_at(found, "emissive", s, t)[0] == pytest.approx(wanted)


def test_readers_of_primvars_that_are_not_there_give_their_fallback(tmp_path: Path) -> None:
    write(tmp_path / "a.png", np.array([[[10], [20]], [[30], [40]]], np.uint8))
    text = preview(SHOWN, texture("T", "", st=ST) + READER)
    stage = Stage(text, tmp_path)
    assert stage.read(has=()).kind.emissive == pytest.approx((40 / 255,) * 3)  # at (0.6, 0.2)
    assert stage.read(has=("st",)).kind.emissive_texture is not None
    assert len(stage.scene.materials) == 2
    stage.read(has=("st", "other"))
    assert len(stage.scene.materials) == 2


def test_sets_of_coordinates_by_name(tmp_path: Path) -> None:
    write(tmp_path / "a.png", RNG.integers(0, 256, (2, 2, 3), np.uint8))
    reader = READER.replace('"P"', '"Q"').replace("string inputs:varname = \"st\"",
        "string inputs:varname.connect = </M.inputs:where>")  # fmt: skip
    inputs = """color3f inputs:diffuseColor.connect = </M/T.outputs:rgb>
      color3f inputs:emissiveColor.connect = </M/U.outputs:rgb>"""
    others = texture("T", "", st="/M/Q.outputs:result") + texture("U", "", st=ST)
    text = preview(inputs, others + READER + reader)
    text = text.replace("{", '{ string inputs:where = "map2"\n', 1)
    stage = Stage(text, tmp_path)
    material = UsdShade.Material(stage.stage.GetPrimAtPath("/M"))
    assert stage.materials.uv_sets(material) == ("map2", "st")
    found = stage.read(has=("st", "map2"))
    assert found.kind.base_color_texture.uv_set == 0
    assert found.kind.emissive_texture.uv_set == 1


def test_a_third_set_is_a_mean_with_a_note(tmp_path: Path) -> None:
    write(tmp_path / "a.png", np.array([[[51], [102]]], np.uint8))
    names = ("one", "two", "three")
    readers = "".join(
        READER.replace('"P"', f'"P{n}"').replace('"st"', f'"{n}"')
        + texture(f"T{n}", "", st=f"/M/P{n}.outputs:result")
        for n in names
    )
    inputs = """color3f inputs:diffuseColor.connect = </M/Tone.outputs:rgb>
      float inputs:ior = 1.5
      float inputs:clearcoatRoughness.connect = </M/Ttwo.outputs:r>
      float inputs:roughness.connect = </M/Tthree.outputs:r>"""
    found = Stage(preview(inputs, readers), tmp_path).read(has=names)
    assert found.kind.roughness == pytest.approx(0.3)
    assert any("third set" in sentence for sentence in found.notes.sentences())


def test_vertex_colours(tmp_path: Path) -> None:
    reader = """def Shader "C" { uniform token info:id = "UsdPrimvarReader_float3"
      string inputs:varname = "displayColor"
      float3 inputs:fallback = (0.1, 0.2, 0.3)
      float3 outputs:result }"""
    inputs = "color3f inputs:diffuseColor.connect = </M/C.outputs:result>"
    stage = Stage(preview(inputs, reader), tmp_path)
    assert stage.materials.reads_vertex_colors(stage.stage, Sdf.Path("/M"))
    assert stage.read().kind.base_color == (1, 1, 1)
    assert stage.read(has=("st",)).kind.base_color == pytest.approx((0.1, 0.2, 0.3))
    assert stage.notes.sentences() == []


def test_display_colour(tmp_path: Path) -> None:
    stage = Stage("", tmp_path)
    found = [
        stage.materials.displayed((0.1, 0.2, 0.3), 0.5),
        stage.materials.displayed((0.1, 0.2, 0.3), 0.5),
        stage.materials.displayed(),
    ]
    assert found == [0, 0, 1]
    kind = stage.scene.materials[0].kind
    assert isinstance(kind, Gltf)
    assert kind.base_color == (0.1, 0.2, 0.3)
    assert (kind.base_alpha, kind.alpha_mode, kind.metallic) == (0.5, "blend", 0)


# --- Files


def test_udim_tiles_are_stitched(tmp_path: Path) -> None:
    tiles = {1001: 10, 1002: 20, 1011: 30}  # 1012 is missing
    for number, value in tiles.items():
        size = 4 if number == 1011 else 2  # of two sizes
        write(tmp_path / f"a.{number}.png", np.full((size, size, 3), value, np.uint8))
    write(tmp_path / "a.0999.png", np.full((2, 2, 3), 99, np.uint8))
    raw = 'token inputs:sourceColorSpace = "raw"'
    file = texture("T", raw, "./a.<UDIM>.png", st=ST)
    found = Stage(preview(SHOWN, file + READER), tmp_path).read()
    assert found.scene.textures[0].pixels.shape == (8, 8, 3)
    shown = {
        (s, t): round(color_at(found, "emissive", s, t)[0] * 255)
        for s in (0.5, 1.5)
        for t in (0.5, 1.5)
    }
    assert shown == {(0.5, 0.5): 10, (1.5, 0.5): 20, (0.5, 1.5): 30, (1.5, 1.5): 0}


def test_pictures_in_packages(tmp_path: Path) -> None:
    pixels = RNG.integers(0, 256, (2, 2, 3), np.uint8)
    write(tmp_path / "a.png", pixels)
    Stage(preview(SHOWN, texture("T", "", "tex/a.png", st=ST) + READER), tmp_path)
    with zipfile.ZipFile(tmp_path / "x.usdz", "w") as archive:
        archive.write(tmp_path / "stage0.usda", "stage.usda")
        archive.write(tmp_path / "a.png", "tex/a.png")
    scene, notes = dg.Scene(), Notes()
    images = Images(scene, lambda place, path: Path(path), notes)
    materials = Materials(scene, images, Clock(), notes)
    stage = Usd.Stage.Open(str(tmp_path / "x.usdz"))
    materials.index_at(stage, Sdf.Path("/M"), ALL)
    assert np.array_equal(scene.textures[0].pixels, pixels)
    assert notes.sentences() == []


@pytest.mark.parametrize("name", ["gone.<UDIM>.png", "<UDIM>/a.png", "x.usdz[gone.png]", "a\udc80"])
def test_names_of_nothing_are_noted(name: str, tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "x.usdz", "w") as archive:
        archive.writestr("other.txt", "")
    stage = Stage("", tmp_path)
    assert stage.images.picture("/M", f"{tmp_path}/{name}") is None
    assert len(stage.notes.sentences()) == 1


@pytest.mark.parametrize(
    ("damage", "says"),
    [("compressed", "the file in the package is compressed"), ("no package", "wanted a usdz")],
)
def test_damaged_packages_are_one_error(damage: str, says: str, tmp_path: Path) -> None:
    """Packages store files as they are, so that none can grow beyond its bytes."""
    write(tmp_path / "a.png", np.zeros((64, 64, 3), np.uint8))
    with zipfile.ZipFile(tmp_path / "x.usdz", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.write(tmp_path / "a.png", "a.png")
    if damage == "no package":
        (tmp_path / "x.usdz").write_bytes(b"PK\3\4" + b"x" * 99)
    with pytest.raises(dg.InputError, match=rf"/M: .*x.usdz\[a.png\]: {says}"):
        Stage("", tmp_path).images.picture("/M", f"{tmp_path}/x.usdz[a.png]")


def test_udim_tiles_are_halved_within_a_limit() -> None:
    tiles = {1001: np.full((8, 8, 3), 100, np.uint8), 1099: np.full((8, 8, 3), 200, np.uint8)}
    pixels, grid, halved = stitched(tiles, limit=9 * 10 * 16 * 3 - 1)
    assert (grid.columns, grid.rows, halved) == (9, 10, True)
    assert pixels.shape == (20, 18, 3)
    assert pixels[-1, 0, 0] == 100
    assert pixels[0, -1, 0] == 200


def test_missing_files_show_the_fallback(tmp_path: Path) -> None:
    inputs = "float4 inputs:fallback = (0.1, 0.2, 0.3, 1)"
    found = Stage(preview(SHOWN, texture("T", inputs, "gone.png", st=ST) + READER), tmp_path).read()
    assert found.kind.emissive == pytest.approx((0.1, 0.2, 0.3))
    (note,) = found.notes.sentences()
    assert note.startswith("a texture whose file is missing shows its fallback value (1 use: ")
    assert note.endswith("gone.png')")


def test_textures_without_a_file_show_the_fallback(tmp_path: Path) -> None:
    inputs = "float4 inputs:fallback = (0.1, 0.2, 0.3, 1)"
    found = Stage(preview(SHOWN, texture("T", inputs, "", st=ST) + READER), tmp_path).read()
    assert found.kind.emissive == pytest.approx((0.1, 0.2, 0.3))
    assert found.notes.sentences() == ["a texture without a file shows its fallback value (1 use)"]


def test_paths_that_leave_the_folder_are_refused_by_their_owner(tmp_path: Path) -> None:
    def refused(place: str, path: str) -> Path:
        raise dg.InputError(f"{place}: leaves the folder")

    stage = Stage(preview(SHOWN, texture("T", "", "../a.png", st=ST) + READER), tmp_path)
    stage.images.resolve = refused
    with pytest.raises(dg.InputError, match="/M/T: leaves the folder"):
        stage.read()


def test_a_damaged_picture_among_others_is_one_error(tmp_path: Path) -> None:
    """Pictures of a material are decoded in parallel."""
    write(tmp_path / "a.png", RNG.integers(0, 256, (2, 2, 3), np.uint8))
    (tmp_path / "b.png").write_bytes((tmp_path / "a.png").read_bytes()[:-20])
    inputs = f"{SHOWN}\nfloat inputs:roughness.connect = </M/U.outputs:r>"
    others = texture("T", "", st=ST) + texture("U", "", "./b.png", st=ST) + READER
    with pytest.raises(dg.InputError, match=r"^/M/U: .*b.png: truncated PNG"):
        Stage(preview(inputs, others), tmp_path).read()


def test_images_are_added_once(tmp_path: Path) -> None:
    write(tmp_path / "a.png", RNG.integers(0, 256, (2, 2, 3), np.uint8))
    images = Stage("", tmp_path).images
    path = str(tmp_path / "a.png")
    assert images.add("/A", path, srgb=True) == images.add("/B", path, srgb=True) == 0
    assert images.add("/A", path, srgb=False) == 1
    assert images.add("/A", str(tmp_path / "gone.png"), srgb=False) is None


# --- Networks


def test_circles_and_depth_end(tmp_path: Path) -> None:
    circle = """def NodeGraph "G" { color3f inputs:a.connect = </M/G.outputs:o>
      color3f outputs:o.connect = </M/G.inputs:a> }"""
    text = preview("color3f inputs:diffuseColor.connect = </M/G.outputs:o>", circle)
    with pytest.raises(
        dg.InputError, match=r"/M/S.inputs:diffuseColor: .*connections form a cycle"
    ):
        Stage(text, tmp_path).read()
    node = """def Shader "{}" {{ uniform token info:id = "ND_add_color3"
      color3f inputs:in1.connect = </M/{}.outputs:out>
      color3f outputs:out }}"""
    text = preview(
        "color3f inputs:diffuseColor.connect = </M/A.outputs:out>",
        node.format("A", "B") + node.format("B", "A"),
    )
    with pytest.raises(dg.InputError, match="connections form a cycle"):
        Stage(text, tmp_path).read()


@pytest.mark.parametrize("value", ["nan", "inf"])
def test_numbers_must_be_finite(value: str, tmp_path: Path) -> None:
    with pytest.raises(dg.InputError, match=r"/M/S: wanted finite numbers, got"):
        Stage(preview(f"float inputs:roughness = {value}"), tmp_path).read()


def test_the_context_that_is_supported_is_read(tmp_path: Path) -> None:
    text = preview(
        "float inputs:roughness = 0.25",
        """def Shader "Other" {
      uniform token info:id = "ND_lama_surface"
      token outputs:out }""",
    )
    text = text.replace(
        "token outputs:surface.connect",
        """
      token outputs:mtlx:surface.connect = </M/Other.outputs:out>
      token outputs:surface.connect""",
        1,
    )
    found = Stage(text, tmp_path).read()
    assert found.kind.roughness == 0.25
    assert found.notes.sentences() == []


def test_other_languages_are_noted_by_name(tmp_path: Path) -> None:
    text = """def Material "M" { token outputs:mtlx:surface.connect = </M/S.outputs:out>
      def Shader "S" { uniform token info:implementationSource = "sourceAsset"
        uniform asset info:mdl:sourceAsset = @OmniPBR.mdl@
        uniform token info:mdl:sourceAsset:subIdentifier = "OmniPBR"
        token outputs:out } }"""
    found = Stage(text, tmp_path).read()
    assert found.notes.sentences() == ["surface 'OmniPBR' is not supported: it is grey (1 use)"]


def test_exr_textures_keep_their_range(tmp_path: Path) -> None:
    pixels = np.array([[[0.5, 2, 4, 0.25], [-1, 0, 1, 1]]], np.float32)
    write(tmp_path / "a.exr", pixels)
    found = Stage(preview(SHOWN, texture("T", "", "./a.exr", st=ST) + READER), tmp_path).read()
    assert color_at(found, "emissive", 0.25, 0.5) == pytest.approx((0.5, 2, 4))
    assert color_at(found, "emissive", 0.75, 0.5) == pytest.approx((0, 0, 1))


def test_values_that_are_none_of_a_surface_are_noted(tmp_path: Path) -> None:
    uv = "color3f inputs:diffuseColor.connect = </M/P.outputs:result>"
    found = Stage(preview(uv, READER), tmp_path).read()
    assert found.kind.base_color == pytest.approx((0.18, 0.18, 0.18))
    assert "texture coordinates" in found.notes.sentences()[0]
    write(tmp_path / "a.png", RNG.integers(0, 256, (2, 2, 3), np.uint8))
    switch = "int inputs:useSpecularWorkflow.connect = </M/T.outputs:r>"
    found = Stage(preview(switch, texture("T", "", st=ST) + READER), tmp_path).read()
    assert "a picture in 'useSpecularWorkflow' is not supported" in found.notes.sentences()[0]


def test_wrong_types_are_noted(tmp_path: Path) -> None:
    inputs = """matrix4d inputs:roughness = ((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,0,0,1))
      float inputs:diffuseColor = 0.25
      string inputs:metallic = "very"
      color3f inputs:emissiveColor.connect = </Nowhere.outputs:out>"""
    found = Stage(preview(inputs), tmp_path).read()
    assert found.kind.base_color == (0.25, 0.25, 0.25)
    assert (found.kind.roughness, found.kind.metallic) == (0.5, 0)
    assert len(found.notes.sentences()) == 2


def test_a_material_without_a_surface_is_grey(tmp_path: Path) -> None:
    found = Stage('def Material "M" {}', tmp_path).read()
    assert found.kind.base_color == (0.18, 0.18, 0.18)
    assert found.notes.sentences() == ["a material without a surface is grey (1 use)"]


MTLX = """<nodegraph name="G">
  <image name="i" type="color3"><input name="file" type="filename" value="a.png"
    colorspace="srgb_texture"/></image>
  <constant name="k" type="color3">
    <input name="value" type="color3" value="0.5, 0.25, 1"/></constant>
  <multiply name="m" type="color3"><input name="in1" type="color3" nodename="i"/>
    <input name="in2" type="color3" nodename="k"/></multiply>
  <output name="o" type="color3" nodename="m"/></nodegraph>
  <standard_surface name="S" type="surfaceshader">
    <input name="base_color" type="color3" nodegraph="G" output="o"/>
    <input name="specular_roughness" type="float" value="0.375"/></standard_surface>
  <surfacematerial name="M" type="material">
    <input name="surfaceshader" type="surfaceshader" nodename="S"/></surfacematerial>"""
NETWORK = """def Material "M" {
  token outputs:mtlx:surface.connect = </M/S.outputs:out>
  def Shader "S" { uniform token info:id = "ND_standard_surface_surfaceshader"
    color3f inputs:base_color.connect = </M/G.outputs:o>
    float inputs:specular_roughness = 0.375
    token outputs:out }
  def NodeGraph "G" { color3f outputs:o.connect = </M/G/m.outputs:out>
    def Shader "i" { uniform token info:id = "ND_image_color3"
      asset inputs:file = @./a.png@ (colorSpace = "srgb_texture")
      color3f outputs:out }
    def Shader "k" { uniform token info:id = "ND_constant_color3"
      color3f inputs:value = (0.5, 0.25, 1)
      color3f outputs:out }
    def Shader "m" { uniform token info:id = "ND_multiply_color3"
      color3f inputs:in1.connect = </M/G/i.outputs:out>
      color3f inputs:in2.connect = </M/G/k.outputs:out>
      color3f outputs:out } } }"""


def test_a_network_equals_its_document(tmp_path: Path) -> None:
    write(tmp_path / "a.png", RNG.integers(0, 256, (4, 4, 3), np.uint8))
    document, network = Read(MTLX, tmp_path), Stage(NETWORK, tmp_path).read()
    assert document.material == network.material
    assert document.scene.textures == network.scene.textures
    assert network.kind.base_color == (0.5, 0.25, 1)
    assert network.kind.roughness == 0.375
    assert network.notes.sentences() == document.notes.sentences() == []


@pytest.mark.parametrize("target", ["/MaterialX/Materials", "/MaterialX/Materials/M"])
def test_documents_are_found_by_their_arcs(target: str, tmp_path: Path) -> None:
    """Without USD's plugin a reference to a document brings no prims."""
    if Sdf.FileFormat.FindByExtension("mtlx"):
        pytest.skip("this USD reads MaterialX itself")
    write(tmp_path / "a.png", RNG.integers(0, 256, (4, 4, 3), np.uint8))
    (tmp_path / "x.mtlx").write_text(f'<materialx version="1.39">{MTLX}</materialx>')
    name = "M" if target.endswith("/M") else "Looks"
    text = f"""def Scope "{name}" (references = @./x.mtlx@<{target}>) {{}}
      def Mesh "Mesh" (prepend apiSchemas = ["MaterialBindingAPI"]) {{
        rel material:binding = </{name if name == "M" else "Looks/M"}> }}"""
    stage = Stage(text, tmp_path)
    path = stage.materials.bound_path(stage.stage.GetPrimAtPath("/Mesh"))
    assert path is not None
    found = stage.read(str(path))
    assert found.material == Read(MTLX, tmp_path).material
    assert stage.materials.uv_sets_at(stage.stage, path) == ("st",)
    stage.read(str(path))
    assert len(found.scene.materials) == 1


def test_a_material_that_a_document_lacks_is_one_error(tmp_path: Path) -> None:
    if Sdf.FileFormat.FindByExtension("mtlx"):
        pytest.skip("this USD reads MaterialX itself")
    (tmp_path / "x.mtlx").write_text(f'<materialx version="1.39">{MTLX}</materialx>')
    text = 'def Scope "L" (references = @./x.mtlx@</MaterialX/Materials>) {}'
    with pytest.raises(dg.InputError, match=r"/L/Gone: no material 'Gone' in .*x.mtlx"):
        Stage(text, tmp_path).read("/L/Gone")


# --- Over time


def test_inputs_over_time(tmp_path: Path) -> None:
    inputs = """color3f inputs:diffuseColor.timeSamples = {0: (0, 0.5, 1), 2: (1, 0.5, 0)}
      float inputs:roughness.timeSamples = {1: 0.25, 3: 0.75}
      float inputs:metallic = 0.5"""
    found = Stage(preview(inputs), tmp_path).read()
    assert found.kind.base_color == (0, 0.5, 1)
    for time in (0.0, 0.5, 1.5, 2.5, 4.0):
        kind = found.scene.at(time).materials[0].kind
        assert isinstance(kind, Gltf)
        red = min(time / 2, 1)
        assert kind.base_color == pytest.approx((red, 0.5, 1 - red))
        assert kind.roughness == pytest.approx(min(max(0.25 + (time - 1) / 4, 0.25), 0.75))
        assert kind.metallic == 0.5


def test_products_over_time_are_close(tmp_path: Path) -> None:
    """A product of two moving numbers bends between its keys."""
    text = """def Material "M" { token outputs:mtlx:surface.connect = </M/S.outputs:out>
      def Shader "S" { uniform token info:id = "ND_standard_surface_surfaceshader"
        float inputs:emission.timeSamples = {0: 0, 1: 1}
        color3f inputs:emission_color.timeSamples = {0: (0, 0, 0), 1: (1, 1, 1)}
        token outputs:out } }"""
    found = Stage(text, tmp_path).read()
    for time in np.linspace(0, 1, 33):
        kind = found.scene.at(float(time)).materials[0].kind
        assert isinstance(kind, Gltf)
        assert kind.emissive[0] == pytest.approx(time**2, abs=0.25 / 8**2 + 1e-9)


def test_a_factor_over_time_keeps_its_texture(tmp_path: Path) -> None:
    write(tmp_path / "a.png", RNG.integers(0, 256, (2, 2, 3), np.uint8))
    inputs = "float4 inputs:scale.timeSamples = {0: (1, 1, 1, 1), 1: (0, 0.5, 2, 1)}"
    found = Stage(preview(SHOWN, texture("T", inputs, st=ST) + READER), tmp_path).read()
    later = found.scene.at(0.5).materials[0].kind
    assert isinstance(later, Gltf)
    assert later.emissive == pytest.approx((0.5, 0.75, 1.5))
    assert later.emissive_texture == found.kind.emissive_texture
