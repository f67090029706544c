"""MaterialX documents, and the nodes in them, against numbers computed by hand."""

from __future__ import annotations

import colorsys
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre.color.encodings import encoding_of, rec709_from
from daguerre.files.notes import Notes
from daguerre.shading.materialx.document import Document
from daguerre.shading.materialx.graph import Constant, Link
from tests.shading.shading_scenes import Read, color_at, shining, surface, write

A = (0.25, 0.5, 0.75)
B = (0.5, 0.125, 2.0)


def document(text: str, head: str = 'version="1.39"') -> Document:
    return Document(f"<materialx {head}>{text}</materialx>".encode(), "x.mtlx", Notes())


def in_(name: str, value: str, kind: str = "color3") -> str:
    """Input with a value, or with a link if the value is the name of a node."""
    how = "value" if value[0] in "-0123456789" or value in ("true", "false") else "nodename"
    return f'<input name="{name}" type="{kind}" {how}="{value}"/>'


def text(numbers: tuple[float, ...]) -> str:
    return ", ".join(map(str, numbers))


#: Beginning of a place2d "c" of texture coordinates "u".
PLACED = '<texcoord name="u" type="vector2"/><place2d name="c" type="vector2">'
PLACED += in_("texcoord", "u", "vector2")


# --- Documents


def test_graphs_interfaces_and_outputs_are_flat() -> None:
    found = document(
        """<nodegraph name="G"><input name="tint" type="color3" value="0.1, 0.2, 0.3"/>
        <multiply name="m" type="color3"><input name="in1" type="color3" interfacename="tint"/>
        <input name="in2" type="float" value="2"/></multiply>
        <output name="out" type="color3" nodename="m"/></nodegraph>
        <standard_surface name="S" type="surfaceshader">
        <input name="base_color" type="color3" nodegraph="G" output="out"/></standard_surface>
        <surfacematerial name="M" type="material">
        <input name="surfaceshader" type="surfaceshader" nodename="S"/></surfacematerial>"""
    ).graph("M")
    assert found is not None
    assert found.surface == "S"
    assert found.nodes["S"].inputs == {"base_color": Link("G/m")}
    in1 = found.nodes["G/m"].inputs["in1"]
    assert isinstance(in1, Constant)
    assert in1.value == (0.1, 0.2, 0.3)


def test_own_definitions_are_resolved_with_their_defaults(tmp_path: Path) -> None:
    nodes = """<nodedef name="ND_half" node="half"><input name="in" type="color3" value="1,1,1"/>
      <input name="by" type="float" value="0.5"/><output name="out" type="color3"/></nodedef>
      <nodegraph name="NG_half" nodedef="ND_half"><multiply name="m" type="color3">
        <input name="in1" type="color3" interfacename="in"/>
        <input name="in2" type="float" interfacename="by"/></multiply>
        <output name="out" type="color3" nodename="m"/></nodegraph>
      <half name="first" type="color3"><input name="in" type="color3" value="0.4, 0.8, 1"/></half>
      <half name="N" type="color3"><input name="in" type="color3" nodename="first"/>
        <input name="by" type="float" value="0.25"/></half>"""
    read = Read(shining(nodes), tmp_path)
    assert read.kind.emissive == pytest.approx((0.05, 0.1, 0.125))
    assert read.notes.sentences() == []


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (
            b"<!DOCTYPE x [<!ENTITY a 'b'>]><materialx/>",
            "document types and entities are not supported",
        ),
        (b"<materialx>", "line 1, column 12"),
        (b"<collada/>", "wanted <materialx>"),
        (b"", "empty or truncated"),
        (b"<materialx>" + b"<a>" * 100_000, "the limit is 64 elements"),
        (b"\xff\xfe\x00", "XML"),
        (b"<?xml version='1.0' encoding='klingon'?><materialx/>", "XML"),
    ],
)
def test_bad_xml_is_one_error(data: bytes, said: str) -> None:
    with pytest.raises(dg.InputError, match=r"x.mtlx: XML: .*") as caught:
        Document(data, "x.mtlx", Notes())
    assert said in str(caught.value)


@pytest.mark.parametrize("space", [b" ", b"\n\n", b"\t\r\n"])
def test_white_space_before_the_declaration_is_passed_over(space: bytes) -> None:
    text = b'<?xml version="1.0"?>\n<materialx version="1.38"/>'
    Document(space + text, "x.mtlx", Notes())
    line = 2 + space.count(b"\n")
    with pytest.raises(dg.InputError, match=rf"XML: line {line}, column 27"):
        Document(space + text.replace(b"/>", b">"), "x.mtlx", Notes())


@pytest.mark.parametrize("value", ["nan, 0, 0", "1, 2", "1, 2, 3, 4", "inf,0,0", "red", ""])
def test_bad_numbers_name_the_line(value: str) -> None:
    bad = document(
        surface(f'\n<input name="base_color" type="color3" value="{value}"/>').replace("\n", "\n")
    )
    with pytest.raises(dg.InputError, match=r"x.mtlx: line 2: <input> 'base_color'.*3 finite"):
        bad.graph("M")


def test_circles_are_one_error(tmp_path: Path) -> None:
    add = '<add name="{}" type="color3">' + in_("in1", "{}") + "</add>"
    with pytest.raises(dg.InputError, match="connections form a cycle"):
        Read(shining(add.format("N", "b") + add.format("b", "N")), tmp_path)
    with pytest.raises(dg.InputError, match="connections form a cycle"):
        Read(shining(add.format("N", "N")), tmp_path)
    interface = """<nodegraph name="G"><input name="a" type="color3" nodegraph="G" output="o"/>
      <output name="o" type="color3" interfacename="a"/></nodegraph>"""
    circle = document(surface('<input name="base_color" nodegraph="G" output="o"/>', interface))
    with pytest.raises(dg.InputError, match="connections form a cycle"):
        circle.graph("M")


def test_definitions_inside_themselves_end() -> None:
    nodes = """<nodedef name="ND_a" node="a"><output name="out" type="color3"/></nodedef>
      <nodegraph name="NG_a" nodedef="ND_a"><a name="x" type="color3"/>
      <add name="s" type="color3"><input name="in1" type="color3" nodename="x"/>
      <input name="in2" type="color3" nodename="x"/></add>
      <output name="out" type="color3" nodename="s"/></nodegraph><a name="N" type="color3"/>"""
    with pytest.raises(dg.InputError, match="nested graphs"):
        document(shining(nodes)).graph("M")


@pytest.mark.parametrize("count", [5_000, pytest.param(100_000, marks=pytest.mark.slow)])
def test_deep_graphs_need_no_recursion(count: int, tmp_path: Path) -> None:
    chain = "".join(
        f'<add name="n{i}" type="float">{in_("in1", f"n{i - 1}", "float")}'
        f"{in_('in2', '0.00001', 'float')}</add>"
        for i in range(1, count)
    )
    first = (
        '<constant name="n0" type="float"><input name="value" type="float" value="0"/></constant>'
    )
    read = Read(shining(first + chain, f"n{count - 1}"), tmp_path)
    assert read.kind.emissive == pytest.approx(((count - 1) * 1e-5,) * 3)


def test_a_connection_to_nothing_is_one_note(tmp_path: Path) -> None:
    read = Read(surface(in_("base_color", "nowhere")), tmp_path)
    assert read.kind.base_color == (0.8, 0.8, 0.8)
    assert read.notes.sentences() == [
        "MaterialX: a connection to a missing node is left out (1 use)"
    ]


def test_unknown_nodes_leave_the_default_and_one_note(tmp_path: Path) -> None:
    nodes = '<noise3d name="n" type="color3"/><noise3d name="m" type="float"/>'
    inputs = in_("base_color", "n") + in_("specular_roughness", "m", "float")
    read = Read(surface(inputs, nodes), tmp_path)
    assert read.kind.base_color == (0.8, 0.8, 0.8)
    assert read.kind.roughness == pytest.approx(0.2)
    assert read.notes.sentences() == ["shading node 'noise3d' is not supported (2 uses)"]


def test_units_of_length() -> None:
    tiled = """<tiledimage name="N" type="color3"><input name="realworldimagesize" type="vector2"
      value="0.5 0.5" unit="foot" unittype="distance"/></tiledimage>"""
    found = document(shining(tiled)).graph("M")
    assert found is not None
    size = found.nodes["N"].inputs["realworldimagesize"]
    assert isinstance(size, Constant)
    assert size.value == pytest.approx((0.1524, 0.1524))


def test_the_package_reads_the_same_values() -> None:
    """Every input of a document with scopes, prefixes and interfaces, by both readers."""
    mx = pytest.importorskip("MaterialX", reason="needs the package materialx")
    body = """<nodegraph name="G" fileprefix="tex/"><input name="k" type="float" value="0.3"/>
      <image name="i" type="color3"><input name="file" type="filename" value="a.png"
        colorspace="srgb_texture"/><input name="default" type="color3" value="1, 0.5, 0"/></image>
      <mix name="x" type="color3"><input name="bg" type="color3" value="0.1,0.2,0.3"/>
        <input name="fg" type="color3" nodename="i"/>
        <input name="mix" type="float" interfacename="k"/></mix>
      <output name="o" type="color3" nodename="x"/></nodegraph>"""
    inputs = '<input name="base_color" type="color3" nodegraph="G" output="o"/>' + in_(
        "specular_IOR", "1.45", "float"
    )
    head = 'version="1.39" colorspace="lin_rec709"'
    ours = document(surface(inputs, body), head).graph("M")
    assert ours is not None
    theirs = mx.createDocument()
    mx.readFromXmlString(theirs, f"<materialx {head}>{surface(inputs, body)}</materialx>")
    compared = 0
    for name, node in ours.nodes.items():
        element = theirs.getDescendant(name)
        for one in element.getInputs():
            found = node.inputs[one.getName()]
            resolved = one.getInterfaceInput() or one
            if isinstance(found, Link):
                link = one.getConnectedNode()
                assert theirs.getDescendant(found.node).getName() == link.getName()
            elif isinstance(found.value, str):
                assert found.value == one.getActiveFilePrefix() + one.getValueString()
                assert found.space == one.getActiveColorSpace()
            else:
                value = resolved.getValue()
                wanted = (value,) if isinstance(value, float) else tuple(value.asTuple())
                assert found.value == pytest.approx(wanted)
            compared += 1
    assert compared == 7


@pytest.mark.parametrize(
    "kind", ["standard_surface", "open_pbr_surface", "gltf_pbr", "UsdPreviewSurface"]
)
def test_defaults_are_those_of_the_library(kind: str, tmp_path: Path) -> None:
    """A surface with every input at its default is that without inputs, whatever is switched on.

    Weights are set to 1 in both, so that the defaults of their parameters show.
    """
    mx = pytest.importorskip("MaterialX", reason="needs the package materialx")
    library = mx.createDocument()
    mx.loadLibraries(mx.getDefaultDataLibraryFolders(), mx.getDefaultDataSearchPath(), library)
    definition = library.getNodeDef(f"ND_{kind}_surfaceshader")
    inputs = {
        one.getName(): (one.getType(), one.getValueString())
        for one in definition.getActiveInputs()
        if one.getValueString()
    }
    assert len(inputs) > 13
    weights = ("coat", "sheen", "subsurface", "transmission", "emission", "specular_anisotropy")
    weights += ("coat_weight", "fuzz_weight", "subsurface_weight", "transmission_weight")
    weights += ("thin_film_weight", "thin_film_thickness", "emission_luminance", "clearcoat")
    for weight in ("", *(name for name in weights if name in inputs)):
        on = in_(weight, "1", "float") if weight else ""
        rest = "".join(
            in_(name, value, type_) for name, (type_, value) in inputs.items() if name != weight
        )
        plain = Read(surface(on, kind=kind), tmp_path)
        assert Read(surface(on + rest, kind=kind), tmp_path).material == plain.material, weight


# --- Nodes: numbers, and the same of every texel

Node = tuple[str, Callable[[Any], Any]]
VECTOR = np.array(B)
NODES: dict[str, Node] = {
    "add": (in_("in1", "A") + in_("in2", text(B)), lambda a: a + VECTOR),
    "subtract": (in_("in1", text(B)) + in_("in2", "A"), lambda a: np.maximum(VECTOR - a, 0)),
    "multiply": (in_("in1", "A") + in_("in2", text(B)), lambda a: a * VECTOR),
    "divide": (in_("in1", text(B)) + in_("in2", "A"), lambda a: VECTOR / a),
    "power": (in_("in1", "A") + in_("in2", text(B)), lambda a: a**VECTOR),
    "min": (in_("in1", "A") + in_("in2", text(B)), lambda a: np.minimum(a, VECTOR)),
    "max": (in_("in1", "A") + in_("in2", text(B)), lambda a: np.maximum(a, VECTOR)),
    "modulo": (in_("in1", text(B)) + in_("in2", "A"), lambda a: np.mod(VECTOR, a)),
    "clamp": (
        in_("in", "A") + in_("low", "0.3, 0.3, 0.3") + in_("high", "0.6, 0.6, 0.6"),
        lambda a: np.clip(a, 0.3, 0.6),
    ),
    "invert": (in_("in", "A"), lambda a: 1 - a),
    "mix": (
        in_("bg", "A") + in_("fg", text(B)) + in_("mix", "0.25", "float"),
        lambda a: 0.75 * a + 0.25 * VECTOR,
    ),
    "remap": (
        in_("in", "A") + in_("inhigh", "2,2,2") + in_("outlow", "1,1,1") + in_("outhigh", "3,3,3"),
        lambda a: 1 + a,
    ),
    "smoothstep": (in_("in", "A"), lambda a: a * a * (3 - 2 * a)),
    "contrast": (
        in_("in", "A") + in_("amount", "2,2,2") + in_("pivot", "0.2,0.2,0.2"),
        lambda a: np.maximum(2 * a - 0.2, 0),
    ),
    "sqrt": (in_("in", "A"), np.sqrt),
    "fract": (in_("in", "A"), lambda a: a - np.floor(a)),
    "luminance": (
        in_("in", "A"),
        lambda a: np.full(3, a @ np.array([0.2722287, 0.6740818, 0.0536895])),
    ),
    "saturate": (
        in_("in", "A") + in_("amount", "0.5", "float"),
        lambda a: 0.5 * a + 0.5 * (a @ np.array([0.2722287, 0.6740818, 0.0536895])),
    ),
    "swizzle": (
        in_("in", "A") + '<input name="channels" type="string" value="bg1"/>',
        lambda a: np.array([a[2], a[1], 1.0]),
    ),
    "normalize": (in_("in", "A"), lambda a: a / np.linalg.norm(a)),
    "rgbtohsv": (in_("in", "A"), lambda a: np.array(colorsys.rgb_to_hsv(*a))),
    "hsvtorgb": (in_("in", "A"), lambda a: np.array(colorsys.hsv_to_rgb(*a))),
    "dotproduct": (in_("in1", "A") + in_("in2", text(B)), lambda a: np.full(3, a @ VECTOR)),
    "ifgreater": (
        in_("value1", "A") + in_("value2", "0.4,0.4,0.4") + in_("in1", text(B)),
        lambda a: np.where(a > 0.4, VECTOR, 0),
    ),
}


@pytest.mark.parametrize("kind", NODES)
def test_nodes_of_numbers(kind: str, tmp_path: Path) -> None:
    inputs, wanted = NODES[kind]
    source = f'<constant name="A" type="color3">{in_("value", text(A))}</constant>'
    read = Read(shining(f'{source}<{kind} name="N" type="color3">{inputs}</{kind}>'), tmp_path)
    assert read.kind.emissive == pytest.approx(tuple(wanted(np.array(A))), rel=1e-12)
    assert read.scene.textures == []
    assert read.notes.sentences() == []


@pytest.mark.parametrize(
    ("node", "type_", "inputs", "wanted"),
    [
        ("combine2", "color4", in_("in2", "0.5", "float"), (0, 0, 0, 0.5)),
        ("combine2", "vector4", in_("in1", "3, 4", "vector2"), (3, 4, 0, 0)),
        ("combine4", "color4", in_("in2", "0.5", "float"), (0, 0.5, 0, 0)),
        ("convert", "color4", in_("in", "0.5", "float"), (0.5,) * 4),
        ("convert", "color4", in_("in", "1, 2, 3"), (1, 2, 3, 1)),
        ("add", "vector3", "", (0, 0, 0)),
        ("ifequal", "color3", in_("in1", "1, 2, 3"), (1, 2, 3)),
        ("ifgreater", "color3", in_("in1", "1, 2, 3"), (1, 2, 3)),
        ("switch", "vector2", in_("in1", "1, 2", "vector2"), (1, 2)),
        ("switch", "float", in_("in10", "2", "float") + in_("which", "9.5", "float"), (2,)),
        ("switch", "float", in_("in10", "2", "float") + in_("which", "10", "float"), (0,)),
        ("rgbtohsv", "color3", in_("in", "-0.5, -0.2, -0.1"), (0, 0, -0.1)),
        ("smoothstep", "float", in_("in", "2", "float") + in_("low", "1", "float"), (1,)),
        ("smoothstep", "float", in_("low", "1", "float"), (0,)),
    ],
)
def test_inputs_that_are_missing(
    node: str, type_: str, inputs: str, wanted: tuple[float, ...], tmp_path: Path
) -> None:
    """Each channel by itself, as surfaces take no more than three."""
    for i, number in enumerate(wanted):
        source = f'<{node} name="A" type="{type_}">{inputs}</{node}>'
        index = in_("index", str(i), "integer")
        last = f'<extract name="e" type="float">{in_("in", "A", type_)}{index}</extract>'
        last += (
            f'<add name="N" type="float">{in_("in1", "e", "float")}{in_("in2", "1", "float")}</add>'
        )
        read = Read(shining(source + last), tmp_path)
        assert read.kind.emissive == pytest.approx((1 + number,) * 3), i
        assert read.notes.sentences() == []


@pytest.mark.parametrize("kind", NODES)
def test_nodes_of_pictures(kind: str, tmp_path: Path) -> None:
    pixels = np.random.default_rng(3).uniform(0.1, 0.9, (2, 3, 3)).astype(np.float32)
    write(tmp_path / "a.exr", pixels)
    inputs, wanted = NODES[kind]
    source = (
        '<image name="A" type="color3"><input name="file" type="filename" value="a.exr"/></image>'
    )
    read = Read(shining(f'{source}<{kind} name="N" type="color3">{inputs}</{kind}>'), tmp_path)
    for y in range(2):
        for x in range(3):
            found = color_at(read, "emissive", (x + 0.5) / 3, 1 - (y + 0.5) / 2)
            assert found == pytest.approx(wanted(pixels[y, x].astype(np.float64)), abs=2e-6)
    assert read.notes.sentences() == []


@pytest.mark.parametrize("kind", ["rgbtohsv", "luminance", "saturate", "normalize", "separate3"])
@pytest.mark.parametrize("type_", ["float", "vector2", "color4", "string", ""])
def test_nodes_of_odd_types_end(kind: str, type_: str, tmp_path: Path) -> None:
    nodes = f"""<constant name="A" type="float"><input name="value" type="float" value="0.5"/>
      </constant><{kind} name="N" type="{type_}">{in_("in", "A", "float")}</{kind}>"""
    assert len(Read(shining(nodes), tmp_path).kind.emissive) == 3


def test_channels_are_taken_apart_and_joined(tmp_path: Path) -> None:
    nodes = f"""<constant name="A" type="color3">{in_("value", text(A))}</constant>
      <separate3 name="p" type="multioutput">{in_("in", "A")}</separate3>
      <extract name="e" type="float">{in_("in", "A")}{in_("index", "1", "integer")}</extract>
      <combine3 name="N" type="color3">
        <input name="in1" type="float" nodename="p" output="outb"/>
        <input name="in2" type="float" nodename="e"/>
        <input name="in3" type="float" nodename="p" output="outr"/></combine3>"""
    assert Read(shining(nodes), tmp_path).kind.emissive == (0.75, 0.5, 0.25)


def test_channels_of_a_connection(tmp_path: Path) -> None:
    """MaterialX before 1.39: ``channels`` on an input."""
    nodes = f'<constant name="A" type="color3">{in_("value", text(A))}</constant>'
    inputs = '<input name="specular_roughness" type="float" nodename="A" channels="b"/>'
    assert Read(surface(inputs, nodes), tmp_path).kind.roughness == 0.75


def test_mixtures_of_pictures(tmp_path: Path) -> None:
    """Two pictures by a third."""
    rng = np.random.default_rng(9)
    pictures = {name: rng.uniform(0, 1, (2, 2, 3)).astype(np.float32) for name in ("bg", "fg", "s")}
    nodes = ""
    for name, pixels in pictures.items():
        write(tmp_path / f"{name}.exr", pixels)
        nodes += f"""<image name="{name}" type="color3">
          <input name="file" type="filename" value="{name}.exr"/></image>"""
    nodes += f"""<extract name="share" type="float">{in_("in", "s")}</extract>
      <mix name="N" type="color3">{in_("bg", "bg")}{in_("fg", "fg")}
      {in_("mix", "share", "float")}</mix>"""
    read = Read(shining(nodes), tmp_path)
    for y in range(2):
        for x in range(2):
            background, foreground, s = (one[y, x] for one in pictures.values())
            wanted = background + s[0] * (foreground - background)
            found = color_at(read, "emissive", (x + 0.5) / 2, 1 - (y + 0.5) / 2)
            assert found == pytest.approx(wanted, abs=1e-6)


def test_limits_on_bytes(tmp_path: Path) -> None:
    """A picture is computed only where a limit can be reached."""
    write(tmp_path / "a.png", np.array([[[102] * 3, [204] * 3]], np.uint8))
    for factor, wanted in (("2", (0.8, 1.0)), ("1", (0.4, 0.8))):
        nodes = f"""<image name="A" type="color3"><input name="file" type="filename" value="a.png"/>
          </image><multiply name="m" type="color3">{in_("in1", "A")}
          {in_("in2", factor, "float")}</multiply>
          <clamp name="N" type="color3">{in_("in", "m")}</clamp>"""
        read = Read(shining(nodes), tmp_path)
        found = [color_at(read, "emissive", s, 0.5)[0] for s in (0.25, 0.75)]
        assert found == pytest.approx(wanted)
        assert (read.scene.textures[0].pixels.dtype == np.uint8) == (factor == "1")


def test_pictures_of_two_sizes_are_resampled(tmp_path: Path) -> None:
    write(tmp_path / "small.exr", np.array([[[0.0] * 3, [1.0] * 3]], np.float32))
    write(tmp_path / "large.exr", np.full((2, 4, 3), 0.5, np.float32))
    nodes = "".join(
        f'<image name="{name}" type="color3"><input name="file" type="filename" '
        f'value="{name}.exr"/></image>'
        for name in ("small", "large")
    )
    nodes += (
        f'<multiply name="N" type="color3">{in_("in1", "small")}{in_("in2", "large")}</multiply>'
    )
    read = Read(shining(nodes), tmp_path)
    assert read.scene.textures[0].pixels.shape == (2, 4, 3)
    # Linear between the centres at 1/4 and 3/4, across the border too, as the picture repeats.
    wanted = [0.5 * share for share in (0.25, 0.25, 0.75, 0.75)]
    row = [color_at(read, "emissive", (x + 0.5) / 4, 0.25)[0] for x in range(4)]
    assert row == pytest.approx(wanted)


def test_a_budget_limits_computed_pictures(tmp_path: Path) -> None:
    write(tmp_path / "a.exr", np.full((8, 8, 3), 0.25, np.float32))
    nodes = f"""<image name="A" type="color3"><input name="file" type="filename" value="a.exr"/>
      </image><power name="N" type="color3">{in_("in1", "A")}{in_("in2", "2", "float")}</power>"""
    read = Read(shining(nodes), tmp_path, limit=100)
    assert read.kind.emissive == pytest.approx((0.0625,) * 3)
    assert read.scene.textures == []
    assert "too large" in read.notes.sentences()[0]


def test_pictures_that_lie_differently_are_combined_by_the_mean(tmp_path: Path) -> None:
    write(tmp_path / "a.exr", np.array([[[0.2] * 3, [0.6] * 3]], np.float32))
    place = f"{PLACED}{in_('scale', '0.5, 0.5', 'vector2')}</place2d>"
    file = '<input name="file" type="filename" value="a.exr"/>'
    nodes = f"""{place}<image name="A" type="color3">{file}</image>
      <image name="B" type="color3">{file}{in_("texcoord", "c", "vector2")}</image>
      <multiply name="N" type="color3">{in_("in1", "A")}{in_("in2", "B")}</multiply>"""
    read = Read(shining(nodes), tmp_path)
    assert color_at(read, "emissive", 0.75, 0.5) == pytest.approx((0.24,) * 3)
    assert "different mappings" in read.notes.sentences()[0]


# --- Texture coordinates

CORNERS = np.array([[[10], [20]], [[30], [40]]], np.uint8)  # top left, top right; bottom


@pytest.mark.parametrize(
    ("nodes", "shown"),
    [
        ("", lambda s, t: (s, t)),
        ('<texcoord name="c" type="vector2"/>', lambda s, t: (s, t)),
        (
            f"{PLACED}{in_('offset', '0.25, 0.5', 'vector2')}"
            f"{in_('scale', '2, 0.5', 'vector2')}{in_('pivot', '0.5, 0.25', 'vector2')}</place2d>",
            lambda s, t: ((s - 0.5) / 2 - 0.25 + 0.5, (t - 0.25) / 0.5 - 0.5 + 0.25),
        ),
        (
            f"{PLACED}{in_('offset', '0.25, 0.5', 'vector2')}"
            f"{in_('scale', '2, 0.5', 'vector2')}{in_('operationorder', '1', 'integer')}</place2d>",
            lambda s, t: ((s - 0.25) / 2, (t - 0.5) / 0.5),
        ),
        (  # clockwise: (1, 0) goes to (0, -1)
            f"{PLACED}{in_('rotate', '90', 'float')}</place2d>",
            lambda s, t: (t, -s),
        ),
        (
            f'{PLACED}<input name="rotate" type="float" value="1.5707963267948966" '
            'unittype="angle" unit="radian"/></place2d>',
            lambda s, t: (t, -s),
        ),
        (  # without coordinates: those of the pivot
            f'<place2d name="c" type="vector2">{in_("offset", "0.3, 0.6", "vector2")}</place2d>',
            lambda s, t: (-0.3, -0.6),
        ),
        (
            '<texcoord name="u" type="vector2"/><multiply name="c" type="vector2">'
            f"{in_('in1', 'u', 'vector2')}{in_('in2', '3, -1', 'vector2')}</multiply>",
            lambda s, t: (3 * s, -t),
        ),
    ],
)
def test_coordinates(
    nodes: str, shown: Callable[[float, float], tuple[float, float]], tmp_path: Path
) -> None:
    write(tmp_path / "a.png", CORNERS)
    uv = in_("texcoord", "c", "vector2") if nodes else ""
    image = f"""<image name="N" type="float"><input name="file" type="filename" value="a.png"/>
      {uv}</image>"""
    read = Read(shining(nodes + image), tmp_path)
    for s in (0.11, 0.37, 0.86):
        for t in (0.07, 0.33, 0.91):
            x, y = shown(s, t)
            wanted = CORNERS[1 - int(np.floor(2 * y)) % 2, int(np.floor(2 * x)) % 2, 0] / 255
            assert color_at(read, "emissive", s, t)[0] == pytest.approx(wanted)
    assert read.notes.sentences() == []


@pytest.mark.parametrize("degrees", [0, 30])
@pytest.mark.parametrize("kind", ["gltf_image", "gltf_colorimage"])
def test_pictures_of_gltf_lie_as_in_gltf(kind: str, degrees: float, tmp_path: Path) -> None:
    """KHR_texture_transform: scaled, turned, then moved, with (0, 0) at the top left."""
    write(tmp_path / "a.png", CORNERS)
    inputs = '<input name="file" type="filename" value="a.png"/>'
    inputs += in_("scale", "2, 3", "vector2") + in_("offset", "0.25, 0.5", "vector2")
    inputs += in_("rotate", str(degrees), "float")
    type_ = "multioutput" if kind == "gltf_colorimage" else "color3"
    output = "outcolor" if kind == "gltf_colorimage" else ""
    image = f'<{kind} name="N" type="{type_}">{inputs}</{kind}>'
    slot = Read(shining(image, output=output), tmp_path).kind.emissive_texture
    assert slot is not None
    cosine, sine = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    wanted = (2 * cosine, 3 * sine, 0.25, -2 * sine, 3 * cosine, 0.5)
    assert slot.transform == pytest.approx(wanted)


def test_pictures_of_gltf_are_tinted(tmp_path: Path) -> None:
    write(tmp_path / "a.png", CORNERS)
    inputs = '<input name="file" type="filename" value="a.png"/>'
    inputs += in_("color", "0.5, 0.5, 0.5, 1", "color4")
    inputs += in_("geomcolor", "0.2, 0.4, 0.8, 1", "color4")
    image = f'<gltf_colorimage name="N" type="multioutput">{inputs}</gltf_colorimage>'
    read = Read(shining(image, output="outcolor"), tmp_path)
    assert read.kind.emissive == pytest.approx((0.1, 0.2, 0.4))
    vertices = inputs.replace('value="0.2, 0.4, 0.8, 1"', 'nodename="v"')
    nodes = f"""<geomcolor name="v" type="color4"/>
      <gltf_colorimage name="N" type="multioutput">{vertices}</gltf_colorimage>"""
    read = Read(shining(nodes, output="outcolor"), tmp_path)
    assert read.kind.emissive == (0.5, 0.5, 0.5)
    assert read.notes.sentences() == [
        "colours of vertices that tint a picture are left out (1 use)"
    ]


@pytest.mark.parametrize("mode", ["periodic", "clamp", "mirror", "constant"])
def test_address_modes(mode: str, tmp_path: Path) -> None:
    write(tmp_path / "a.png", CORNERS)
    modes = "".join(
        f'<input name="{axis}addressmode" type="string" value="{mode}"/>' for axis in "uv"
    )
    image = f"""<image name="N" type="float"><input name="file" type="filename" value="a.png"/>
      {modes}{in_("default", "0.5", "float")}</image>"""
    read = Read(shining(image), tmp_path)

    def axis(x: float) -> int | None:
        i = math.floor(2 * x)
        return {
            "periodic": i % 2,
            "clamp": min(max(i, 0), 1),
            "mirror": (0, 1, 1, 0)[i % 4],
            "constant": i if i in (0, 1) else None,
        }[mode]

    for s in (-1.1, -0.3, 0.2, 0.7, 1.2, 1.8):
        for t in (-0.6, 0.2, 0.8, 1.4):
            column, row = axis(s), axis(t)
            wanted = 0.5 if column is None or row is None else CORNERS[1 - row, column, 0] / 255
            assert color_at(read, "emissive", s, t)[0] == pytest.approx(wanted, abs=1e-6)


def test_tiled_images(tmp_path: Path) -> None:
    write(tmp_path / "a.png", CORNERS)
    size = in_("realworldimagesize", "0.5, 0.25", "vector2")
    size += in_("realworldtilesize", "0.25, 0.25", "vector2")
    image = f"""<tiledimage name="N" type="float">
      <input name="file" type="filename" value="a.png"/>{in_("uvtiling", "3, 2", "vector2")}
      {in_("uvoffset", "0.5, 0.25", "vector2")}{size}</tiledimage>"""
    slot = Read(shining(image), tmp_path).kind.emissive_texture
    assert slot is not None
    # s' = (3 s - 1/2) / 2, t' = 2 t - 1/4, seen from the top: v' = 1 - t', t = 1 - v
    assert slot.transform == pytest.approx((1.5, 0, -0.25, 0, 2, -0.75))


# --- Colour


def test_named_colour_spaces() -> None:
    """Matrix of ACEScg as MaterialX's own library of colour (cmlib) has it."""
    encoding = encoding_of("lin_ap1")
    assert encoding is not None
    wanted = [
        [1.705051, -0.621792, -0.083259],
        [-0.130257, 1.140805, -0.010548],
        [-0.024003, -0.128969, 1.152972],
    ]
    assert np.array(rec709_from(encoding)) == pytest.approx(np.array(wanted), abs=2e-5)
    for name in ("lin_displayp3", "lin_rec2020_scene", "lin_ap0", "lin_adobergb"):
        found = encoding_of(name)
        assert found is not None
        assert np.array(rec709_from(found)).sum(axis=1) == pytest.approx(1, abs=1e-9)


def test_colours_of_numbers_are_converted(tmp_path: Path) -> None:
    for space, wanted in (
        ("lin_rec709", (0.2, 0.4, 0.6)),
        ("srgb_texture", tuple(((c + 0.055) / 1.055) ** 2.4 for c in (0.2, 0.4, 0.6))),
        ("g22_rec709", tuple(c**2.2 for c in (0.2, 0.4, 0.6))),
        ("acescg", (0.042337, 0.423942, 0.635391)),
    ):
        inputs = (
            f'<input name="base_color" type="color3" value="0.2,0.4,0.6" colorspace="{space}"/>'
        )
        read = Read(surface(inputs), tmp_path)
        assert read.kind.base_color == pytest.approx(wanted, abs=2e-5), space
        assert read.notes.sentences() == []
    odd = '<input name="base_color" type="color3" value="0.2,0.4,0.6" colorspace="rgb_of_mars"/>'
    read = Read(surface(odd), tmp_path)
    assert read.kind.base_color == (0.2, 0.4, 0.6)
    assert read.notes.sentences() == [
        "colour space 'rgb_of_mars' is unknown: read as linear Rec.709 (1 use)"
    ]


def test_pictures_in_srgb_stay_bytes(tmp_path: Path) -> None:
    pixels = np.random.default_rng(5).integers(0, 256, (4, 4, 3), np.uint8)
    write(tmp_path / "a.png", pixels)
    image = """<image name="N" type="color3">
      <input name="file" type="filename" value="a.png" colorspace="{}"/></image>"""
    read = Read(shining(image.format("srgb_texture")), tmp_path)
    (texture,) = read.scene.textures
    assert texture.srgb
    assert np.array_equal(texture.pixels, pixels)
    wide = Read(shining(image.format("srgb_displayp3")), tmp_path)
    encoding = encoding_of("lin_displayp3")
    assert encoding is not None
    light = pixels[1, 2] / 255
    light = np.where(light <= 0.04045, light / 12.92, ((light + 0.055) / 1.055) ** 2.4)
    wanted = np.maximum(np.array(rec709_from(encoding)) @ light, 0)
    assert color_at(wide, "emissive", 0.625, 0.625) == pytest.approx(wanted, abs=1e-6)


# --- Surfaces


def test_standard_surface(tmp_path: Path) -> None:
    inputs = (
        in_("base", "0.5", "float")
        + in_("base_color", "0.4, 0.6, 0.8")
        + in_("metalness", "0.25", "float")
        + in_("specular", "0.75", "float")
        + in_("specular_color", "0.9, 0.8, 0.7")
        + in_("specular_roughness", "0.35", "float")
        + in_("specular_IOR", "1.7", "float")
        + in_("sheen", "0.5", "float")
        + in_("sheen_color", "0.2, 0.4, 1")
        + in_("sheen_roughness", "0.6", "float")
        + in_("emission", "10", "float")
        + in_("emission_color", "1, 0.5, 0.25")
        + in_("opacity", "0.5, 0.5, 0.5")
        + in_("thin_film_thickness", "350", "float")
        + in_("thin_film_IOR", "1.6", "float")
    )
    kind = Read(surface(inputs), tmp_path).kind
    assert kind.base_color == pytest.approx((0.2, 0.3, 0.4))
    assert (kind.metallic, kind.roughness, kind.ior) == (0.25, 0.35, 1.7)
    assert kind.specular == 0.75
    assert kind.specular_color == (0.9, 0.8, 0.7)
    assert kind.sheen_color == pytest.approx((0.1, 0.2, 0.5))
    assert kind.sheen_roughness == 0.6
    assert kind.emissive == (10, 5, 2.5)
    assert (kind.alpha_mode, kind.base_alpha) == ("blend", 0.5)
    assert (kind.iridescence, kind.iridescence_ior) == (1, 1.6)
    assert kind.iridescence_thickness_min_nm == kind.iridescence_thickness_max_nm == 350


def test_coats_tint_what_is_below(tmp_path: Path) -> None:
    inputs = in_("base_color", "0.5, 0.5, 0.5") + in_("coat", "0.5", "float")
    inputs += in_("coat_color", "1, 0.5, 0") + in_("coat_roughness", "0.2", "float")
    kind = Read(surface(inputs), tmp_path).kind
    assert (kind.clearcoat, kind.clearcoat_roughness) == (0.5, 0.2)
    assert kind.base_color == pytest.approx((0.5, 0.375, 0.25))


def test_transmission_tints_or_absorbs(tmp_path: Path) -> None:
    glass = in_("transmission", "1", "float") + in_("transmission_color", "0.9, 0.8, 0.7")
    kind = Read(surface(glass), tmp_path).kind
    assert kind.base_color == (0.9, 0.8, 0.7)
    assert (kind.transmission, kind.thickness, kind.attenuation_distance) == (1, 1, math.inf)
    kind = Read(surface(glass + in_("transmission_depth", "0.25", "float")), tmp_path).kind
    assert kind.base_color == (1, 1, 1)
    assert (kind.attenuation_color, kind.attenuation_distance) == ((0.9, 0.8, 0.7), 0.25)
    kind = Read(surface(glass + in_("thin_walled", "true", "boolean")), tmp_path).kind
    assert kind.thickness == 0


def test_subsurface_is_diffuse_and_noted(tmp_path: Path) -> None:
    wax = in_("base_color", "0.2, 0.2, 0.2") + in_("subsurface", "0.5", "float")
    wax += in_("subsurface_color", "1, 0.4, 0.2")
    read = Read(surface(wax), tmp_path)
    assert read.kind.base_color == pytest.approx((0.6, 0.3, 0.2))
    assert len(read.notes.sentences()) == 1
    leaf = Read(surface(wax + in_("thin_walled", "true", "boolean")), tmp_path)
    assert leaf.kind.diffuse_transmission == 0.5
    assert leaf.kind.diffuse_transmission_color == (1, 0.4, 0.2)
    assert leaf.notes.sentences() == []


@pytest.mark.parametrize("roughness", [0.2, 0.5, 0.7])
@pytest.mark.parametrize("kind", ["standard_surface", "open_pbr_surface"])
def test_stretched_highlights_keep_both_widths(kind: str, roughness: float, tmp_path: Path) -> None:
    """glTF's widths r^2 + (1 - r^2) s^2 and r^2 are those of the definitions."""
    stretch = 0.6
    standard = kind == "standard_surface"
    name = "specular_anisotropy" if standard else "specular_roughness_anisotropy"
    inputs = in_("specular_roughness", str(roughness), "float") + in_(name, str(stretch), "float")
    found = Read(surface(inputs, kind=kind), tmp_path).kind
    across = found.roughness**2
    along = across + (1 - across) * found.anisotropy**2
    if standard:
        aspect = math.sqrt(1 - stretch)
        wanted = roughness**2 / aspect, roughness**2 * aspect
    else:
        width = roughness**2 * math.sqrt(2 / (1 + (1 - stretch) ** 2))
        wanted = width, (1 - stretch) * width
    assert (along, across) == pytest.approx(wanted)


def test_turns_dispersion_and_metal(tmp_path: Path) -> None:
    brushed = in_("specular_anisotropy", "0.5", "float") + in_(
        "specular_rotation", "0.125", "float"
    )
    # MaterialX's own translation to gltf_pbr turns by -2 pi.
    assert Read(surface(brushed), tmp_path).kind.anisotropy_rotation == -45
    glass = in_("transmission", "1", "float") + in_("transmission_dispersion", "40", "float")
    assert Read(surface(glass), tmp_path).kind.dispersion == 0.5
    metal = in_("base_color", "0.9, 0.6, 0.3") + in_("metalness", "1", "float")
    metal += in_("subsurface", "1", "float") + in_("subsurface_color", "0, 0, 1")
    assert Read(surface(metal), tmp_path).kind.base_color == (0.9, 0.6, 0.3)


def test_open_pbr(tmp_path: Path) -> None:
    inputs = (
        in_("base_weight", "0.5", "float")
        + in_("base_color", "0.4, 0.6, 0.8")
        + in_("base_metalness", "1", "float")
        + in_("specular_roughness", "0.4", "float")
        + in_("fuzz_weight", "0.5", "float")
        + in_("fuzz_color", "0.2, 0.4, 0.6")
        + in_("emission_luminance", "1000", "float")
        + in_("emission_color", "1, 0.5, 0")
        + in_("thin_film_weight", "0.5", "float")
        + in_("thin_film_thickness", "0.3", "float")
        + in_("geometry_opacity", "0.25", "float")
    )
    read = Read(surface(inputs, kind="open_pbr_surface"), tmp_path)
    kind = read.kind
    assert kind.base_color == pytest.approx((0.2, 0.3, 0.4))
    assert (kind.metallic, kind.roughness, kind.ior) == (1, 0.4, 1.5)
    assert kind.sheen_color == pytest.approx((0.1, 0.2, 0.3))
    assert kind.emissive == (1000, 500, 0)
    assert kind.iridescence == 0.5
    assert kind.iridescence_thickness_max_nm == pytest.approx(300)
    assert (kind.alpha_mode, kind.base_alpha) == ("blend", 0.25)
    assert read.notes.sentences() == []
    glass = in_("transmission_weight", "1", "float")
    glass += in_("transmission_dispersion_scale", "1", "float")
    glass += in_("transmission_dispersion_abbe_number", "40", "float")
    assert Read(surface(glass, kind="open_pbr_surface"), tmp_path).kind.dispersion == 0.5


def test_gltf_pbr_and_unlit(tmp_path: Path) -> None:
    inputs = (
        in_("base_color", "0.4, 0.6, 0.8")
        + in_("metallic", "0.5", "float")
        + in_("alpha", "0.75", "float")
        + in_("alpha_mode", "1", "integer")
        + in_("alpha_cutoff", "0.3", "float")
        + in_("emissive", "1, 0.5, 0")
        + in_("emissive_strength", "4", "float")
        + in_("clearcoat", "0.5", "float")
        + in_("anisotropy_strength", "0.5", "float")
        + in_("anisotropy_rotation", "1.5707963267948966", "float")
    )
    kind = Read(surface(inputs, kind="gltf_pbr"), tmp_path).kind
    assert (kind.metallic, kind.roughness) == (0.5, 1)
    assert (kind.alpha_mode, kind.alpha_cutoff, kind.base_alpha) == ("mask", 0.3, 0.75)
    assert kind.emissive == (4, 2, 0)
    assert (kind.clearcoat, kind.anisotropy) == (0.5, 0.5)
    assert kind.anisotropy_rotation == pytest.approx(90)
    lamp = in_("emission", "3", "float") + in_("emission_color", "1, 1, 0")
    kind = Read(surface(lamp, kind="surface_unlit"), tmp_path).kind
    assert kind.emissive == (3, 3, 0)
    assert (kind.base_color, kind.specular, kind.double_sided) == ((0, 0, 0), 0, True)


def test_displacement_is_noted_where_it_moves_something() -> None:
    for value, moves in (("0", False), ("0.1", True)):
        shader = f"""<displacement name="D" type="displacementshader">
          {in_("displacement", value, "float")}</displacement>"""
        text_of = surface("").replace(
            "</surfacematerial>",
            '<input name="displacementshader" type="displacementshader" nodename="D"/>'
            "</surfacematerial>",
        )
        found = document(shader + text_of).graph("M")
        assert found is not None
        assert found.displaced is moves


def test_unknown_surfaces_are_grey_with_a_note(tmp_path: Path) -> None:
    read = Read(surface("", kind="lama_surface"), tmp_path)
    assert read.kind.base_color == (0.18, 0.18, 0.18)
    assert read.notes.sentences() == ["surface 'lama_surface' is not supported: it is grey (1 use)"]


def test_normal_maps_stay_bytes(tmp_path: Path) -> None:
    pixels = np.random.default_rng(7).integers(0, 256, (4, 4, 3), np.uint8)
    write(tmp_path / "n.png", pixels)
    nodes = f"""<image name="i" type="vector3"><input name="file" type="filename" value="n.png"/>
      </image><normalmap name="n" type="vector3">{in_("in", "i", "vector3")}
      {in_("scale", "0.5", "float")}</normalmap>"""
    read = Read(surface(in_("normal", "n", "vector3"), nodes), tmp_path)
    (texture,) = read.scene.textures
    assert np.array_equal(texture.pixels, pixels)
    assert not texture.srgb
    assert read.kind.normal_scale == 0.5


def test_numbers_lie_in_the_channels_of_gltf(tmp_path: Path) -> None:
    """Each in its channel, with a third one beside green, as two would be grey and opacity."""
    write(tmp_path / "a.png", np.array([[[51]]], np.uint8))
    nodes = (
        '<image name="a" type="float"><input name="file" type="filename" value="a.png"/></image>'
    )
    for name, on, channel in (
        ("coat_roughness", "coat", 1),
        ("coat", "", 0),
        ("sheen_roughness", "sheen", 3),
        ("specular", "", 3),
        ("transmission", "", 0),
        ("subsurface", "thin_walled", 3),
    ):
        inputs = in_(name, "a", "float")
        inputs += in_(on, "1", "float") if on not in ("", "thin_walled") else ""
        inputs += in_(on, "true", "boolean") if on == "thin_walled" else ""
        read = Read(surface(inputs, nodes), tmp_path)
        pixels = read.scene.textures[-1].pixels
        texel = pixels[0, 0].tolist()
        assert len(texel) != 2, name
        assert texel[channel] == 51, name


def test_numbers_of_two_pictures_share_a_texture(tmp_path: Path) -> None:
    """Roughness in green and metalness in blue, each times its factor, as bytes."""
    rough = np.array([[[10, 11, 12], [20, 21, 22]]], np.uint8)
    metal = np.array([[[0], [255]]], np.uint8)
    write(tmp_path / "r.png", rough)
    write(tmp_path / "m.png", metal)
    nodes = f"""<image name="r" type="float"><input name="file" type="filename" value="r.png"/>
      </image><image name="m" type="float"><input name="file" type="filename" value="m.png"/>
      </image>
      <multiply name="half" type="float">{in_("in1", "r", "float")}{in_("in2", "0.5", "float")}
      </multiply>"""
    inputs = in_("specular_roughness", "half", "float") + in_("metalness", "m", "float")
    read = Read(surface(inputs, nodes), tmp_path)
    (texture,) = read.scene.textures
    assert texture.pixels.dtype == np.uint8
    assert texture.pixels[:, :, 1].tolist() == [[10, 20]]
    assert texture.pixels[:, :, 2].tolist() == [[0, 255]]
    assert (read.kind.roughness, read.kind.metallic) == (0.5, 1)


def test_a_missing_picture_shows_its_default(tmp_path: Path) -> None:
    image = f"""<image name="N" type="color3"><input name="file" type="filename" value="gone.png"/>
      {in_("default", "0.1, 0.2, 0.3")}</image>"""
    read = Read(shining(image), tmp_path)
    assert read.kind.emissive == pytest.approx((0.1, 0.2, 0.3))
    (note,) = read.notes.sentences()
    assert note.startswith("a texture whose file is missing shows its fallback value (1 use: ")
    assert note.endswith("gone.png')")


def test_a_damaged_picture_is_one_error(tmp_path: Path) -> None:
    (tmp_path / "a.png").write_bytes(b"\x89PNG\r\n\x1a\n" + b"x" * 40)
    image = (
        '<image name="N" type="color3"><input name="file" type="filename" value="a.png"/></image>'
    )
    with pytest.raises(dg.InputError, match=r"test.mtlx: line 1: <image>: .*a.png.*PNG"):
        Read(shining(image), tmp_path)


def test_materials_render(tmp_path: Path) -> None:
    """The core takes what comes out, and a picture shows the right way up."""
    pixels = np.zeros((16, 16, 3), np.uint8)
    pixels[:8, :8] = 255  # top left
    write(tmp_path / "a.png", pixels)
    image = (
        '<image name="N" type="color3"><input name="file" type="filename" value="a.png"/></image>'
    )
    lamp = in_("emission", "1", "float") + in_("emission_color", "N")
    read = Read(surface(lamp, image, kind="surface_unlit"), tmp_path)
    scene, st = read.scene, np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)
    corners = np.column_stack([2 * st - 1, np.zeros(4)])
    uv = np.column_stack([st[:, 0], 1 - st[:, 1]])
    scene.add_mesh(corners, [[0, 1, 2], [0, 2, 3]], uv=uv)
    scene.add_instance(0, 0)
    pose = np.eye(4)
    pose[2, 3] = 2
    lens = {"lens": "pinhole", "focal_length": 36, "sensor_size": (36, 36)}
    scene.add_camera("eye", dg.Camera(transform=pose, **lens))
    frame = dg.render(scene, resolution=(16, 16), spp=4)
    quarters = frame.rgb[:, :, 0].reshape(2, 8, 2, 8)[:, 2:6, :, 2:6].mean(axis=(1, 3))
    assert quarters == pytest.approx(np.array([[1, 0], [0, 0]]), abs=0.02)
