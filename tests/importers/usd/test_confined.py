"""No file is opened that a stage may not read: by any arc, clip, expression, package or texture.

The file is a pipe, which tells whether anyone opened it.
"""

from __future__ import annotations

import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest
from pxr import Sdf

import daguerre as dg
from tests.support.program.pipes import watched

_HEAD = "#usda 1.0\n( metersPerUnit = 1\n{} )\n"
_CARD = (
    'def Mesh "card" { point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]\n'
    "int[] faceVertexCounts = [3]\nint[] faceVertexIndices = [0, 1, 2] }\n"
)
_CLIPS = (
    'clips = {{ dictionary default = {{ {}\nstring primPath = "/card"\n'
    "double2[] active = [(0, 0)]\ndouble2[] times = [(0, 0), (9, 9)] }} }}"
)
_TEMPLATE = (
    'string templateAssetPath = "{}"\ndouble templateStartTime = 1\n'
    "double templateEndTime = 3\ndouble templateStride = 1"
)


def _layer(path: Path, body: str, header: str = "") -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(_text(body, header))
    return path


def _text(body: str, header: str = "") -> str:
    return (_HEAD.format(header) + body + _CARD).replace(" }", "\n}").replace("{ ", "{\n")


def _prim(metadata: str, inside: str = "double b.timeSamples = { 0: 1 }") -> str:
    return f'def "a" (\n{metadata}\n) {{\n{inside}\n}}\n'


def _clips(told: str) -> str:
    return _prim(_CLIPS.format(told))


def _texture(name: str) -> str:
    return f"""
def Material "m" {{
    token outputs:surface.connect = </m/s.outputs:surface>
    def Shader "s" {{
        uniform token info:id = "UsdPreviewSurface"
        color3f inputs:diffuseColor.connect = </m/t.outputs:rgb>
        token outputs:surface
    }}
    def Shader "t" {{
        uniform token info:id = "UsdUVTexture"
        asset inputs:file = {name}
        color3f outputs:rgb
    }}
}}
def Sphere "ball" {{ rel material:binding = </m> }}
"""


def _in_reference(folder: Path, body: str) -> Path:
    _layer(folder / "inner.usda", body)
    return _layer(folder / "s.usda", _prim("references = @inner.usda@</a>"))


def _in_variant(folder: Path, metadata: str) -> Path:
    body = 'def Xform "a" ( variants = { string v = "x" }\nprepend variantSets = "v" ) {\n'
    body += f'variantSet "v" = {{ "x" (\n{metadata}\n) {{ double b = 1 }} }} }}\n'
    return _layer(folder / "s.usda", body)


def _in_package(folder: Path, body: str) -> Path:
    inner = _layer(folder / "inner.usda", body)
    with zipfile.ZipFile(folder / "s.usdz", "w") as made:
        made.write(inner, "inner.usda")
    inner.unlink()
    return folder / "s.usdz"


def _in_binary(folder: Path, body: str) -> Path:
    layer = Sdf.Layer.CreateAnonymous(".usda")
    assert layer.ImportFromString(_text(body))
    assert layer.Export(str(folder / "s.usdc"))
    return folder / "s.usdc"


def _overridden(folder: Path, name: str) -> Path:
    """A layer's expression is evaluated with the variables of the one that refers to it."""
    _layer(
        folder / "inner.usda",
        _prim('references = @`"${X}"`@</card>'),
        'expressionVariables = { string X = "none.usda" }',
    )
    header = f'expressionVariables = {{ string X = "{name}" }}'
    return _layer(folder / "s.usda", _prim("references = @inner.usda@</a>"), header)


def _nested_variable(folder: Path, name: str) -> Path:
    header = f'expressionVariables = {{ string X = "`\\"${{Y}}\\"`"\nstring Y = "{name}" }}'
    body = _prim('payload = @`if(eq(${X}, "q"), "none.usda", ${X})`@</card>')
    return _layer(folder / "s.usda", body, header)


def _expression(field: str) -> Callable[[Path, str], Path]:
    def make(folder: Path, name: str) -> Path:
        variables = f'expressionVariables = {{ string X = "{name}" }}'
        asset = '@`"${X}"`@'
        if field == "subLayers":
            return _layer(folder / "s.usda", "", f"{variables}\nsubLayers = [{asset}]")
        if field == "clips":
            body = _clips(f"asset[] assetPaths = [{asset}]")
        elif field == "texture":
            body = _texture(asset)
        else:
            body = _prim(f"{field} = {asset}</card>")
        return _layer(folder / "s.usda", body, variables)

    return make


#: Ways to name a layer.
LAYERS: dict[str, Callable[[Path, str], Path]] = {
    "clip": lambda f, n: _layer(f / "s.usda", _clips(f"asset[] assetPaths = [@{n}@]")),
    "clip in a reference": lambda f, n: _in_reference(f, _clips(f"asset[] assetPaths = [@{n}@]")),
    "clip in a binary layer": lambda f, n: _in_binary(f, _clips(f"asset[] assetPaths = [@{n}@]")),
    "clip in a variant": lambda f, n: _in_variant(
        f, _CLIPS.format(f"asset[] assetPaths = [@{n}@]")
    ),
    "manifest": lambda f, n: _layer(
        f / "s.usda", _clips(f"asset[] assetPaths = [@s.usda@]\nasset manifestAssetPath = @{n}@")
    ),
    "expression in a sublayer": _expression("subLayers"),
    "expression in a reference": _expression("references"),
    "expression in a payload": _expression("payload"),
    "expression in a clip": _expression("clips"),
    "overridden variable": _overridden,
    "variable in a variable": _nested_variable,
    "reference in a variant": lambda f, n: _in_variant(f, f"references = @{n}@</card>"),
}


@pytest.mark.parametrize("way", LAYERS)
@pytest.mark.parametrize("place", ["inside", "outside", "link"])
def test_a_layer_that_is_a_pipe_is_not_opened(tmp_path: Path, way: str, place: str) -> None:
    inner, name = tmp_path / "in", "../out/p.usda" if place == "outside" else "./p.usda"
    inner.mkdir()
    with watched(inner / "p.usda" if place == "inside" else tmp_path / "out" / "p.usda") as pipe:
        if place == "link":
            (inner / "p.usda").symlink_to(pipe.path)
        stage = LAYERS[way](inner, name)
        wanted = "not a regular file" if place == "inside" else "leaves the stage's folder"
        with pytest.raises(dg.InputError, match=wanted):
            dg.load(stage)
    assert not pipe.opened


@pytest.mark.parametrize("place", ["inside", "outside"])
def test_clips_of_a_template_are_not_opened(tmp_path: Path, place: str) -> None:
    inner = tmp_path / "in"
    name = "../out/p.###.usda" if place == "outside" else "./p.###.usda"
    with watched(tmp_path / ("out" if place == "outside" else "in") / "p.002.usda") as pipe:
        stage = _layer(inner / "s.usda", _clips(_TEMPLATE.format(name)))
        with pytest.raises(dg.InputError, match=r"not a regular file|leaves the stage's folder"):
            dg.load(stage)
    assert not pipe.opened


@pytest.mark.parametrize("way", ["reference", "clips", "value"])
def test_a_package_that_is_a_pipe_is_not_opened(tmp_path: Path, way: str) -> None:
    (tmp_path / "in").mkdir()
    with watched(tmp_path / "out" / "p.usdz") as pipe:
        name = "@../out/p.usdz[a.usda]@"
        body = {
            "reference": _prim(f"references = {name}</card>"),
            "clips": _clips(f"asset[] assetPaths = [{name}]"),
            "value": f'def Scope "x" {{ asset z = {name} }}\n',
        }[way]
        with pytest.raises(dg.InputError, match="leaves the stage's folder"):
            dg.load(_layer(tmp_path / "in" / "s.usda", body))
    assert not pipe.opened


def test_clips_in_a_package_are_confined(tmp_path: Path) -> None:
    (tmp_path / "in").mkdir()
    with watched(tmp_path / "out" / "p.usda") as pipe:
        body = _clips(f"asset[] assetPaths = [@{pipe.path}@]")
        with pytest.raises(dg.InputError, match="leaves the stage's folder"):
            dg.load(_in_package(tmp_path / "in", body))
    assert not pipe.opened


def test_names_that_are_searched_for_are_confined(tmp_path: Path) -> None:
    """A name without ./ that is missing beside its layer is looked for beside the stage."""
    inner = tmp_path / "in"
    with watched(tmp_path / "out" / "p.usda") as pipe:
        _layer(inner / "sub" / "b.usda", _prim("references = @p.usda@</card>"))
        (inner / "p.usda").symlink_to(pipe.path)
        stage = _layer(inner / "s.usda", _prim("references = @sub/b.usda@</a>"))
        with pytest.raises(dg.InputError, match="leaves the stage's folder"):
            dg.load(stage)
    assert not pipe.opened


@pytest.mark.parametrize("name", ["@p.png@", "@p.<UDIM>.png@", '@`"p.png"`@'])
@pytest.mark.parametrize("place", ["inside", "link"])
def test_a_texture_that_is_a_pipe_is_not_opened(tmp_path: Path, name: str, place: str) -> None:
    inner = tmp_path / "in"
    file = inner / ("p.1001.png" if "UDIM" in name else "p.png")
    with watched(file if place == "inside" else tmp_path / "out" / "p.png") as pipe:
        stage = _layer(inner / "s.usda", _texture(name))
        if place == "link":
            file.symlink_to(pipe.path)
            with pytest.raises(dg.InputError, match="leaves the stage's folder"):
                dg.load(stage)
        else:
            assert any("missing" in note for note in dg.load(stage).warnings)
    assert not pipe.opened


def test_devices_are_not_read(tmp_path: Path) -> None:
    for name, body in {
        "layer": _prim("references = @/dev/zero@</card>"),
        "clip": _clips("asset[] assetPaths = [@zero.usda@]"),
        "texture": _texture("@zero.png@"),
    }.items():
        for link in ("zero.usda", "zero.png"):
            (tmp_path / link).unlink(missing_ok=True)
            (tmp_path / link).symlink_to("/dev/zero")
        stage = _layer(tmp_path / f"{name}.usda", body)
        with pytest.raises(dg.InputError, match="leaves the stage's folder"):
            dg.load(stage)
        (note_or_error,) = [_told(stage)]
        assert note_or_error


def _told(stage: Path) -> str:
    try:
        return " ".join(dg.load(stage, allow_dirs=["/dev"]).warnings)
    except dg.InputError as error:
        return str(error)


def test_expressions_still_work(tmp_path: Path) -> None:
    _layer(tmp_path / "p.usda", "")
    for way in ("overridden variable", "variable in a variable", "expression in a reference"):
        found = dg.load(LAYERS[way](tmp_path, "p.usda"))
        assert sorted(one.name for one in found.instances) == ["a", "card"], way


@pytest.mark.parametrize(
    "variables",
    [
        "\n".join(f'string V{i} = "`\\"${{V{i + 1}}}${{V{i + 1}}}\\"`"' for i in range(40)),
        'string V0 = "`\\"${V1}\\"`"\nstring V1 = "`\\"${V0}\\"`"',
        'string V0 = "`' + "if(true, " * 1000 + "1" + ", 2)" * 1000 + '`"',
    ],
    ids=["doubling", "loop", "depth"],
)
def test_expressions_that_grow_without_end_are_refused(tmp_path: Path, variables: str) -> None:
    header = f"expressionVariables = {{ {variables} }}"
    stage = _layer(tmp_path / "s.usda", _prim('references = @`"${V0}.usda"`@'), header)
    with pytest.raises(dg.InputError, match="expression: wanted at most"):
        dg.load(stage)


def test_templates_of_too_many_clips_are_refused(tmp_path: Path) -> None:
    told = _TEMPLATE.format("./p.#.usda").replace("EndTime = 3", "EndTime = 1e9")
    with pytest.raises(dg.InputError, match="wanted a template of at most 200000 times"):
        dg.load(_layer(tmp_path / "s.usda", _clips(told)))
    half = _TEMPLATE.format("./p.#.usda").replace("double templateStride = 1", "")
    _layer(tmp_path / "b.usda", _clips(half))
    stride = _clips("double templateStride = 1e-9")
    with pytest.raises(dg.InputError, match="wanted a template of at most 200000 times"):
        dg.load(_layer(tmp_path / "t.usda", stride, "subLayers = [@b.usda@]"))


@pytest.mark.parametrize("through", ["", "reference"])
def test_a_layer_that_changed_is_read_again_while_a_scene_lives(
    tmp_path: Path, through: str
) -> None:
    stage = changed = _layer(tmp_path / "b.usda", "")
    if through:
        stage = _layer(tmp_path / "s.usda", _prim("references = @b.usda@</card>"))
    alive = Sdf.Layer.FindOrOpen(str(changed))
    first = dg.load(stage, in_process=True)
    changed.write_text(changed.read_text().replace("(1, 0, 0)", "(7, 0, 0)"))
    second = dg.load(stage, in_process=True)
    assert alive
    assert first.meshes[0].positions.max() == 1
    assert second.meshes[0].positions.max() == 7


def _listed(monkeypatch: pytest.MonkeyPatch) -> list[Path]:
    """Folders that are listed from now on."""
    listed: list[Path] = []
    real = Path.iterdir
    monkeypatch.setattr(Path, "iterdir", lambda folder: (listed.append(folder), real(folder))[1])
    return listed


@pytest.mark.parametrize(
    "template", ["", ".", "./", ":SDF_FORMAT_ARGS:a=1", "p.usda", "./p.#.usda"]
)
def test_a_template_of_no_clips_lists_no_folder_outside(
    tmp_path: Path, template: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    listed = _listed(monkeypatch)
    dg.load(_layer(tmp_path / "in" / "s.usda", _clips(_TEMPLATE.format(template))), in_process=True)
    assert {folder.resolve() for folder in listed} <= {tmp_path / "in"}
    assert ("#" in template) == bool(listed)


def test_a_folder_outside_is_not_listed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    listed = _listed(monkeypatch)
    stage = _layer(tmp_path / "in" / "s.usda", _clips(_TEMPLATE.format("../p.#.usda")))
    with pytest.raises(dg.InputError, match="leaves the stage's folder"):
        dg.load(stage, in_process=True)
    assert tmp_path not in listed
