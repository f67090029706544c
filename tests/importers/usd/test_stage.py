"""Stages are confined to their folder, and damaged ones are refused."""

from __future__ import annotations

import os
import struct
import subprocess
import sys
import threading
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pxr import Sdf, Usd, UsdGeom, UsdShade, UsdUtils

import daguerre as dg
from daguerre.importers.usd.assets import Assets
from daguerre.importers.usd.layer_files import check_file
from tests.support.formats import stages

_HEAD = '#usda 1.0\n(\n    metersPerUnit = 1\n    upAxis = "Y"\n'
_CARD = (
    'def Mesh "card" {{ point3f[] points = [{0}]; int[] faceVertexCounts = [3];'
    " int[] faceVertexIndices = [0, 1, 2] }}\n"
)
_PLACE = "(0, 0, 0), (1, 0, 0), (0, 1, 0)"


def _card() -> str:
    return _CARD.format(_PLACE)


def _write(path: Path, header: str = "", body: str = "") -> Path:
    path.parent.mkdir(exist_ok=True)
    lines = body.replace("; ", "\n").replace(" }", "\n}")
    path.write_text(f"{_HEAD}{header})\n{lines}")
    return path


#: Ways to name another layer: header and body of a stage.
_ARCS = {
    "sublayer": ("    subLayers = [@{}@]\n", ""),
    "reference": ("", 'def "a" (references = @{}@</card>) {{}}\n'),
    "payload": ("", 'def "a" (payload = @{}@</card>) {{}}\n'),
    "variant": (
        "",
        'def "a" (variants = {{ string v = "x" }}; prepend variantSets = "v") {{ variantSet "v" = '
        '{{ "x" {{}}\n"y" (references = @{}@</card>) {{}} }} }}\n',
    ),
    "clips": (
        "",
        'def "a" (clips = {{ dictionary default = {{ asset[] assetPaths = [@{}@]; '
        "string primPath = "
        '"/card"; double2[] active = [(0, 0)]; double2[] times = [(0, 0), (9, 9)] }} }}) '
        "{{ double b.timeSamples = {{ 0: 1 }} }}\n",
    ),
}


def _arc(path: Path, arc: str, name: str) -> Path:
    header, body = _ARCS[arc]
    return _write(path, header.format(name), body.format(name) or _card())


@pytest.mark.parametrize("arc", _ARCS)
def test_layers_outside_of_the_folder_are_refused(arc: str, tmp_path: Path) -> None:
    other = _write(tmp_path / "other" / "o.usda", body=_card())
    inner = tmp_path / "in"
    names = ["../other/o.usda", str(other), "./x/../../other/o.usda", "link.usda"]
    inner.mkdir()
    (inner / "link.usda").symlink_to(other)
    for i, name in enumerate(names):
        stage = _arc(inner / f"s{i}.usda", arc, name)
        with pytest.raises(dg.InputError, match="leaves the stage's folder") as caught:
            dg.load(stage)
        assert str(caught.value).startswith(f"{stage}: ")
        dg.load(stage, allow_dirs=[tmp_path / "other"])


@pytest.mark.parametrize("arc", ["sublayer", "reference", "payload", "variant"])
@pytest.mark.parametrize("name", ["http://x.org/a.usda", "file:///etc/a.usda", "ftp://x/a.usd"])
def test_addresses_are_refused(arc: str, name: str, tmp_path: Path) -> None:
    with pytest.raises(dg.InputError, match="refused: wanted a file, got"):
        dg.load(_arc(tmp_path / "s.usda", arc, name))


def test_layers_of_layers_are_confined_too(tmp_path: Path) -> None:
    _write(tmp_path / "o.usda", body=_card())
    _arc(tmp_path / "in" / "b.usda", "reference", "../o.usda")
    stage = _write(
        tmp_path / "in" / "a.usda", body='def "c" (references = @b.usda@</a>) {}\n' + _card()
    )
    with pytest.raises(dg.InputError, match=r"layer b\.usda: leaves the stage's folder"):
        dg.load(stage)


def test_assets_of_attributes_are_confined(tmp_path: Path) -> None:
    (tmp_path / "in").mkdir()
    (tmp_path / "o.png").write_bytes(b"x")
    (tmp_path / "in" / "i.png").write_bytes(b"x")
    assets = Assets(tmp_path / "in" / "s.usda", ())
    inside = assets.resolve("/p.a", Sdf.AssetPath("i.png", str(tmp_path / "in" / "i.png")))
    assert inside == tmp_path / "in" / "i.png"
    assert assets.resolve("/p.a", Sdf.AssetPath("")) is None
    for bad in (str(tmp_path / "o.png"), str(tmp_path / "in" / ".." / "o.png"), "http://x/i.png"):
        with pytest.raises(dg.InputError, match=r"s\.usda: /p\.a: (leaves|refused)"):
            assets.resolve("/p.a", Sdf.AssetPath("i.png", bad))
    with pytest.raises(dg.InputError, match="leaves"):
        assets.check("/p.a", f"{tmp_path / 'o.usdz'}[i.png]")


def _package(path: Path, stage: Path) -> Path:
    assert UsdUtils.CreateNewUsdzPackage(str(stage), str(path))
    return path


def test_packages_are_read_and_confined(tmp_path: Path) -> None:
    _write(tmp_path / "b.usda", body=_card())
    stage = _write(tmp_path / "a.usda", body='def "c" (references = @b.usda@</card>) {}\n')
    package = _package(tmp_path / "in.usdz", stage)
    (tmp_path / "far").mkdir()
    moved = package.rename(tmp_path / "far" / "p.usdz")
    assert len(dg.load(moved).instances) == 1
    user = _arc(tmp_path / "user" / "u.usda", "reference", "../far/p.usdz")
    with pytest.raises(dg.InputError, match="leaves the stage's folder"):
        dg.load(user)
    bad = tmp_path / "bad.usdz"
    with zipfile.ZipFile(bad, "w") as made:
        made.writestr("a.usda", f'{_HEAD})\ndef "c" (references = @{tmp_path}/b.usda@</card>) {{}}')
    (tmp_path / "far" / "bad.usdz").write_bytes(bad.read_bytes())
    with pytest.raises(dg.InputError, match="leaves the stage's folder"):
        dg.load(tmp_path / "far" / "bad.usdz")


def test_missing_layers_are_one_note(tmp_path: Path) -> None:
    body = "".join(f'def "n{i}" (references = @none{i}.usda@) {{}}\n' for i in range(3))
    scene = dg.load(_write(tmp_path / "s.usda", "    subLayers = [@gone.usdc@]\n", body + _card()))
    assert len(scene.instances) == 1
    (note,) = (note for note in scene.warnings if "cannot be opened" in note)
    assert note.endswith("(4 uses)")


@pytest.mark.parametrize("arc", ["sublayer", "reference", "payload"])
def test_layers_that_name_themselves_are_noted(arc: str, tmp_path: Path) -> None:
    header, body = _ARCS[arc]
    body = body.replace("</card>", "</a>").format("s.usda") + _card()
    scene = dg.load(_write(tmp_path / "s.usda", header.format("s.usda"), body))
    assert [one.name for one in scene.instances] == ["card"]
    assert any("composition error" in note for note in scene.warnings)


def test_a_pipe_is_not_opened(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.usda")
    with pytest.raises(dg.InputError, match=r"pipe\.usda: not a regular file"):
        dg.load(_arc(tmp_path / "s.usda", "sublayer", "pipe.usda"))
    with pytest.raises(dg.InputError, match=r"pipe\.usda: not a regular file"):
        dg.load(tmp_path / "pipe.usda")


@pytest.mark.parametrize(
    ("header", "told"),
    [
        ("metersPerUnit = 0", "metersPerUnit: wanted a number above 0, got 0"),
        ("metersPerUnit = -1", "metersPerUnit: wanted a number above 0, got -1"),
        ("metersPerUnit = nan", "metersPerUnit: wanted a number above 0, got nan"),
        ('upAxis = "X"', "upAxis: wanted Y or Z, got 'X'"),
        ("timeCodesPerSecond = 0", "timeCodesPerSecond: wanted a number above 0, got 0"),
        ("timeCodesPerSecond = -1", "timeCodesPerSecond: wanted a number above 0, got -1"),
        (
            "framesPerSecond = 0",
            "invalid value for field \"framesPerSecond\" at 'framesPerSecond = 0' in </>",
        ),
    ],
)
def test_units_axes_and_rates_out_of_bounds_are_refused(
    tmp_path: Path, header: str, told: str
) -> None:
    path = tmp_path / "s.usda"
    path.write_text(f"#usda 1.0\n(\n    {header}\n)\n")
    with pytest.raises(dg.InputError) as caught:
        dg.load(path)
    assert str(caught.value) == f"{path}: {told}"


def test_the_clock_of_a_stage(tmp_path: Path) -> None:
    body = (
        'def Xform "x" { double3 xformOp:translate.timeSamples = {0: (0,0,0), 50: (5,0,0)}\n'
        'uniform token[] xformOpOrder = ["xformOp:translate"] }\n' + _card()
    )
    header = "    timeCodesPerSecond = 50\n    startTimeCode = 0\n    endTimeCode = 100\n"
    scene = dg.load(_write(tmp_path / "s.usda", header, body), time=0.5)
    assert np.allclose(scene.node_positions["x"], (2.5, 0, 0))
    assert scene.duration == 2.0


def _variants(path: Path) -> Path:
    stage = stages.new_stage(path)
    top = UsdGeom.Xform.Define(stage, "/Top").GetPrim()
    shapes = top.GetVariantSets().AddVariantSet("shape")
    for name in ("card", "cube"):
        shapes.AddVariant(name)
        shapes.SetVariantSelection(name)
        with shapes.GetVariantEditContext():
            (stages.mesh if name == "card" else stages.cube)(stage, f"/Top/{name}")
    shapes.SetVariantSelection("card")
    return stages.save(stage)


def test_variants_are_chosen(tmp_path: Path) -> None:
    path = _variants(tmp_path / "s.usda")
    assert [one.name for one in dg.load(path).instances] == ["Top/card"]
    assert [one.name for one in dg.load(path, variant="/Top:shape=cube").instances] == ["Top/cube"]
    assert [one.name for one in dg.load(path).instances] == ["Top/card"]  # nothing is left of it


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("/Top:shape=ball", "/Top: shape: no variant 'ball'"),
        ("/Top:form=cube", "/Top: no set of variants 'form'"),
        ("/Non:shape=cube", "variant: no prim named /Non"),
        *(
            (text, "variant: wanted /prim:set=name, got")
            for text in (
                "",
                "cube",
                "/Top",
                "/Top:shape",
                "/Top:shape=",
                "/Top:=cube",
                ":shape=cube",
                "Top:shape=cube",
                "/Top.a:shape=cube",
                "//:shape=cube",
                "/Top{a=b}:shape=cube",
            )
        ),
    ],
)
def test_variants_that_do_not_exist_are_named(tmp_path: Path, text: str, told: str) -> None:
    with pytest.raises(dg.UsageError, match=told):
        dg.load(_variants(tmp_path / "s.usda"), variant=text)


def test_a_variant_cannot_lead_out_of_the_folder(tmp_path: Path) -> None:
    _write(tmp_path / "o.usda", body=_card())
    body = (
        'def "a" (variants = { string v = "x" }; prepend variantSets = "v") { variantSet "v" = '
        '{ "x" {}\n"y" (references = @`"${W}/o.usda"`@</card>) {} } }\n' + _card()
    )
    header = '    expressionVariables = { string W = ".." }\n'
    stage = _write(tmp_path / "in" / "s.usda", header, body)
    for chosen in ((), "/a:v=y"):
        with pytest.raises(dg.InputError, match="leaves the stage's folder"):
            dg.load(stage, variant=chosen)


# Damage -----------------------------------------------------------------------------------------


def _told(path: Path) -> str:
    """Error of a stage; empty if it is read."""
    try:
        dg.load(path)
    except dg.InputError as error:
        return str(error)
    return ""


def _rich(path: Path) -> Path:
    """A small stage with time samples, packed arrays, an instancer and a camera."""
    rng = np.random.default_rng(0)
    stage = stages.new_stage(path)
    cube = stages.cube(stage, "/World/cube")
    stages.place(cube, at=(0, 0, -3))
    op = cube.AddRotateXOp()
    for code in range(3):
        op.Set(10.0 * code, code)
    UsdGeom.Camera.Define(stage, "/World/cam")
    stages.instancer(stage, "/World/i", rng.normal(size=(30, 3)))
    points = UsdGeom.Points.Define(stage, "/World/p")
    points.CreatePointsAttr(stages.vectors(rng.normal(size=(40, 3))))
    points.CreateWidthsAttr([0.25 * (i % 3) for i in range(40)])
    return stages.save(stage)


@pytest.mark.behind_wall
@pytest.mark.parametrize("suffix", ["usda", "usdc", "usdz"])
def test_damage_at_any_place_is_an_error_or_a_scene(
    tmp_path: Path, suffix: str, capfd: pytest.CaptureFixture[str]
) -> None:
    path = _rich(tmp_path / ("whole.usdc" if suffix == "usdz" else f"whole.{suffix}"))
    if suffix == "usdz":
        path = _package(tmp_path / "whole.usdz", path)
    whole = path.read_bytes()
    assert len(dg.load(path).instances) > 30
    refused = 0
    for i, place in enumerate(range(0, len(whole), 50)):
        data = bytearray(whole)
        data[place] ^= (0xFF, 0x80, 0x01)[i % 3]
        damaged = tmp_path / f"d{place}.{suffix}"
        damaged.write_bytes(data)
        told = _told(damaged)
        refused += bool(told)
        assert not told or told.startswith(f"{damaged}: ")
        assert len(told.splitlines()) < 2
    assert refused > 5
    assert capfd.readouterr() == ("", "")


_MUTATE = """
import random, resource, sys
from pathlib import Path
import daguerre as dg
resource.setrlimit(resource.RLIMIT_AS, (8 << 30, 8 << 30))
whole = Path(sys.argv[1]).read_bytes()
for seed in range(400):
    random.seed(seed)
    data = bytearray(whole)
    if seed % 4 == 0:
        del data[random.randrange(len(data)):]
    for _ in range(random.choice([1, 1, 2, 8])):
        if data:
            data[random.randrange(len(data))] = random.choice([0, 1, 127, 128, 255])
    path = Path(sys.argv[1]).with_name(f"m{seed}.usdc")
    path.write_bytes(data)
    try:
        dg.load(path)
    except dg.InputError:
        pass
    path.unlink()
print("done")
"""


def test_mutations_of_a_binary_layer_never_end_the_process(tmp_path: Path) -> None:
    path = _rich(tmp_path / "whole.usdc")
    done = subprocess.run(
        [sys.executable, "-c", _MUTATE, str(path)], capture_output=True, text=True, timeout=300
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "done\n", "")


def _replaced(path: Path, count: int, by: int) -> Path:
    data, old = path.read_bytes(), count.to_bytes(8, "little")
    assert data.count(old) == 1
    made = path.with_name("lies.usdc")
    made.write_bytes(data.replace(old, by.to_bytes(8, "little")))
    return made


def test_clips_named_by_a_template_are_confined(tmp_path: Path) -> None:
    clip = _write(tmp_path / "other" / "o.1.usda", body='over "x" { double b = 3 }\n')
    for i in (1, 2):
        _write(tmp_path / "in" / f"o.{i}.usda", body='over "x" { double b = 3 }\n')
    (tmp_path / "in" / "o.3.usda").symlink_to(clip)
    body = (
        'def "a" (clips = { dictionary default = { string templateAssetPath = "./o.#.usda"; '
        'string primPath = "/card"; double templateStartTime = 1; double templateEndTime = 3; '
        "double templateStride = 1 } }) { double b.timeSamples = { 0: 1 } }\n"
    )
    with pytest.raises(dg.InputError, match="leaves the stage's folder"):
        dg.load(_write(tmp_path / "in" / "s.usda", body=body + _card()))


@pytest.mark.parametrize("name", ["TOKENS", "STRINGS", "FIELDS", "FIELDSETS", "PATHS", "SPECS"])
def test_sections_that_state_more_than_they_hold_are_refused(tmp_path: Path, name: str) -> None:
    path = _rich(tmp_path / "s.usdc")
    data = bytearray(path.read_bytes())
    (table,) = struct.unpack_from("<q", data, 16)
    entry = data.index(name.encode() + b"\0", table)
    (begin,) = struct.unpack_from("<q", data, entry + 16)
    struct.pack_into("<Q", data, begin, 1 << 33)
    lies = tmp_path / "lies.usdc"
    lies.write_bytes(data)
    with pytest.raises(dg.InputError, match=f"wanted at most .* {name.lower()}, got 8589934592"):
        dg.load(lies)


@pytest.mark.parametrize("name", ["points", "ids", "widths"])
def test_arrays_that_state_more_than_the_file_holds_are_refused(tmp_path: Path, name: str) -> None:
    stage = stages.new_stage(tmp_path / "s.usdc")
    points = UsdGeom.Points.Define(stage, "/p")
    points.CreatePointsAttr(stages.vectors(np.random.default_rng(0).normal(size=(1234, 3))))
    points.CreateIdsAttr(list(range(777)))
    points.CreateWidthsAttr([0.25 * (i % 3) for i in range(555)])
    path = stages.save(stage)
    check_file(path, str(path))
    lies = _replaced(path, {"points": 1234, "ids": 777, "widths": 555}[name], 300_000_000)
    with pytest.raises(dg.InputError, match=r"damaged binary layer: wanted at most .* elements"):
        dg.load(lies)
    user = _arc(tmp_path / "u.usda", "sublayer", "lies.usdc")
    with pytest.raises(dg.InputError, match=r"lies\.usdc: damaged binary layer"):
        dg.load(user)


@pytest.mark.parametrize(
    "body",
    [
        'def Mesh "m" { string points = "x"; int[] faceVertexCounts = [3] }',
        'def Mesh "m" { float points = 3; int faceVertexCounts = 3; int faceVertexIndices = 0 }',
        'def PointInstancer "i" { int protoIndices = 3; int positions = 2; rel prototypes = </p> }',
        'def Points "p" { point3f[] points = [(0, 0, 0)]; string widths = "a" }',
        'def Xform "x" { token visibility = "nonsense"; string purpose = "x" }',
        'def Sphere "s" { string radius = "a" }',
    ],
)
def test_values_of_other_types_are_an_error_or_left_out(tmp_path: Path, body: str) -> None:
    path = _write(tmp_path / "s.usda", body=body)
    told = _told(path)
    assert not told or told.startswith(f"{path}: ")


def test_usd_prints_nothing(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    body = (
        'def Material "m" { token outputs:surface.connect = </none.x> }\n'
        'def Mesh "a" (references = @gone.usd@) { rel material:binding = </m> }\n' + _card()
    )
    dg.load(_write(tmp_path / "s.usda", body=body))
    for text in ("", "#usda 1.0\n(", "#usda 1.0\ndef Mesh", "PXR-USDC"):
        (tmp_path / "bad.usda").write_text(text)
        with pytest.raises(dg.InputError):
            dg.load(tmp_path / "bad.usda")
    assert capfd.readouterr() == ("", "")


def test_two_threads_read_different_stages(tmp_path: Path) -> None:
    good = _rich(tmp_path / "good.usdc")
    other = _write(tmp_path / "other.usda", body=_card())
    (tmp_path / "bad.usda").write_text("#usda 1.0\ndef Mesh {")
    wanted = {path: dg.load(path) for path in (good, other)}
    found: dict[Path, list[Any]] = {path: [] for path in (good, other, tmp_path / "bad.usda")}

    def read(path: Path) -> None:
        for _ in range(8):
            try:
                found[path].append(dg.load(path) == wanted[path])
            except dg.InputError as error:
                found[path].append(str(error).startswith(f"{path}: "))

    threads = [threading.Thread(target=read, args=(path,)) for path in found]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(one == [True] * 8 for one in found.values())


def test_a_second_reading_is_equal_and_sees_changes(tmp_path: Path) -> None:
    path = _rich(tmp_path / "s.usdc")
    first = dg.load(path)
    assert first == dg.load(path)
    stage = Usd.Stage.Open(str(path))
    stages.mesh(stage, "/more")
    stages.save(stage)
    del stage
    assert len(dg.load(path).instances) == len(first.instances) + 1


def _textured(folder: Path, name: str) -> Path:
    """A card whose colour is a picture."""
    stage = stages.new_stage(folder / "x.usda")
    card = stages.mesh(stage, "/card")
    texture = UsdShade.Shader.Define(stage, "/M/texture")
    texture.CreateIdAttr("UsdUVTexture")
    texture.CreateInput("file", Sdf.ValueTypeNames.Asset).Set(name)
    surface = UsdShade.Shader.Define(stage, "/M/surface")
    surface.CreateIdAttr("UsdPreviewSurface")
    color = texture.CreateOutput("rgb", Sdf.ValueTypeNames.Float3)
    surface.CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f).ConnectToSource(color)
    made = UsdShade.Material.Define(stage, "/M")
    made.CreateSurfaceOutput().ConnectToSource(surface.ConnectableAPI(), "surface")
    UsdShade.MaterialBindingAPI.Apply(card.GetPrim()).Bind(made)
    return stages.save(stage)


@pytest.mark.parametrize("name", ["pictures/none.png", "./pictures/none.png", "none.<UDIM>.png"])
def test_a_missing_picture_in_the_folder_is_a_note(tmp_path: Path, name: str) -> None:
    (note,) = (note for note in dg.load(_textured(tmp_path, name)).warnings if "missing" in note)
    assert note.startswith("a texture whose file is missing shows its fallback value (1 use: ")
    assert note.endswith(f"{name.removeprefix('./')}')")


@pytest.mark.parametrize("name", ["wood.ptx", "wood.tex", "wood.usda"])
def test_a_picture_in_a_format_that_cannot_be_read_is_a_note(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_bytes(b"no picture that any reader knows")
    notes = dg.load(_textured(tmp_path, name)).warnings
    unknown = "a texture in an unknown format shows its fallback value (1 use: "
    assert any(note.startswith(unknown) and note.endswith(f"{name}')") for note in notes)
    assert not any("missing" in note for note in notes)


@pytest.mark.parametrize("name", ["wood.png", "wood.exr", "wood.tif"])
def test_a_damaged_picture_is_one_error(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_bytes(b"no picture that any reader knows")
    with pytest.raises(dg.InputError, match=rf"{name}: cannot be decoded"):
        dg.load(_textured(tmp_path, name))


def test_a_picture_is_known_by_its_content_where_its_suffix_is_not(tmp_path: Path) -> None:
    stages.picture(tmp_path / "wood.tif", np.full((2, 2, 3), 0.5))
    (tmp_path / "wood.tif").rename(tmp_path / "wood.tex")
    scene = dg.load(_textured(tmp_path, "wood.tex"))
    assert len(scene.textures) == 1
    assert not any("fallback" in note for note in scene.warnings)
