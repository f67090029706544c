"""Values of MaterialX graphs against the shaders that the package materialx makes of them.

Both are read at the same points of a square, in the middle of no texel's border, without filters:
filters and the ends of pictures are the business of the program that draws, not of the graph.
Left out are values that the shaders leave open: where they divide by 0, the renderer has 0.
"""

from __future__ import annotations

import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import daguerre as dg
from daguerre.files.notes import Notes
from daguerre.shading.arithmetic import Arithmetic
from daguerre.shading.bake import Baker
from daguerre.shading.channels import Channel, Coordinate, Texel, VertexColor
from daguerre.shading.evaluate import Context, Evaluator
from daguerre.shading.images import Images
from daguerre.shading.materialx.document import Document
from daguerre.shading.materialx.graph import Link
from daguerre.shading.operations import OPERATIONS
from tests.shading.generated_shaders import (
    COLOR,
    SIZE,
    Generator,
    Screen,
    library,
    texture_coordinates,
)
from tests.shading.random_nodes import (
    CHANNELS,
    NEEDED,
    PICTURED,
    PICTURES,
    Grower,
    Source,
    outputs_of,
    value,
)
from tests.shading.shading_scenes import shining, write

POINTS = texture_coordinates()
#: Largest difference, and largest in proportion to values above 1; and that of numbers of which
#: the package writes only six digits.
TOLERANCE, SIX_DIGITS = 5e-6, 2e-5

COORDINATES = ("texcoord", "place2d", "rotate2d", "UsdTransform2d")
NORMALS = ("normalmap", "gltf_normalmap")
IMAGES = ("image", "tiledimage", "gltf_image", "gltf_colorimage", "UsdUVTexture", *NORMALS)
GEOMETRY = ("geomcolor", "geompropvalue", "geompropvalueuniform")
#: Names of USD and of older documents, for which the package has no definition of the same name.
NAMED_OTHERWISE = {kind for kind in OPERATIONS if kind.startswith("UsdPrimvar")} | {"swizzle"}
NODES = sorted(set(OPERATIONS) - {*COORDINATES, *IMAGES, *GEOMETRY} - NAMED_OTHERWISE)
LENGTHS = ("millimeter", "centimeter", "meter", "inch", "foot", "yard")


class Comparison:
    """Compares the values of documents.

    Args:
        folder: Receives the pictures.
    """

    def __init__(self, folder: Path) -> None:
        rng = np.random.default_rng(1)
        pictures = {name: rng.uniform(*PICTURED, (4, 4, 4)).astype(np.float32) for name in PICTURES}
        for name, pixels in pictures.items():
            write(folder / name, pixels)
        self._folder = folder
        self._definitions = library()
        self._generator = Generator(self._definitions)
        self.screen = Screen(pictures)

    def definitions(self, *kinds: str) -> list[Any]:
        """Definitions of nodes whose inputs and outputs have channels, or are flags and texts."""
        taken = (*CHANNELS, "integer", "boolean", "string", "filename")
        return [
            one
            for one in self._definitions.getNodeDefs()
            if one.getNodeString() in kinds
            and outputs_of(one)
            and all(given.getType() in taken for given in one.getActiveInputs())
        ]

    def values(self, nodes: str, shown: Source, version: str = "1.39") -> tuple[Any, Any]:
        """The renderer's values and the shader's, shape (SIZE, SIZE, channels)."""
        output = f' output="{shown.output}"' if shown.output else ""
        nodes += f'<output name="out" type="{shown.type}" nodename="{shown.node}"{output}/>'
        body = shining(nodes, shown.node, shown.output)
        text = f'<materialx version="{version}">{body}</materialx>'
        drawn = self.screen.shown(self._generator.shader(text))
        return self._evaluated(text, shown), drawn[:, :, : CHANNELS[shown.type]]

    def check(
        self, nodes: str, shown: Source, version: str = "1.39", most: float = TOLERANCE
    ) -> None:
        """Fails where the renderer's values differ from the shader's."""
        ours, theirs = self.values(nodes, shown, version)
        assert np.isfinite(theirs).all(), nodes
        apart = np.abs(ours - theirs) / np.maximum(1, np.abs(theirs))
        assert apart.max() <= most, f"{apart.max()}: {ours[0, 0]}, not {theirs[0, 0]}: {nodes}"

    def _evaluated(self, text: str, shown: Source) -> NDArray[np.float64]:
        notes, scene = Notes(), dg.Scene()
        graph = Document(text.encode(), str(self._folder / "x.mtlx"), notes).graph("M")
        assert graph is not None
        images = Images(scene, lambda place, path: Path(path), notes)
        context = Context(images, notes, Arithmetic(Baker(notes)))
        found = Evaluator(graph, OPERATIONS, context).linked(Link(shown.node, shown.output))
        images.close()
        assert notes.sentences() == [], text
        assert found is not None
        assert len(found) == CHANNELS[shown.type], text
        return np.stack([_at_points(channel) for channel in found], -1)


def _at_points(channel: Channel) -> NDArray[np.float64]:
    """Values of a channel, shape (SIZE, SIZE)."""
    if isinstance(channel, Texel):
        a, b, c, d, e, f = channel.mapping.transform
        s, t = np.moveaxis(POINTS[channel.mapping.primvar], -1, 0)
        values = channel.values().astype(np.float64)
        height, width = values.shape
        column = np.floor((a * s + b * t + c) * width).astype(int) % width
        row = np.floor((d * s + e * t + f) * height).astype(int) % height
        return np.asarray(values[height - 1 - row, column])
    if isinstance(channel, Coordinate):
        s, t = np.moveaxis(POINTS[channel.primvar], -1, 0)
        return np.asarray(channel.a * s + channel.b * t + channel.c)
    if isinstance(channel, VertexColor):
        channel = channel.scale * COLOR[channel.channel]
    return np.full((SIZE, SIZE), channel)


@pytest.fixture(scope="module")
def compared(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Comparison]:
    made = Comparison(tmp_path_factory.mktemp("pictures"))
    yield made
    made.screen.close()


def grower(name: str, definitions: list[Any] | None = None, left_out: float = 1) -> Grower:
    return Grower(np.random.default_rng(zlib.crc32(name.encode())), definitions or [], left_out)


# --- Nodes


@pytest.mark.parametrize("kind", NODES)
def test_nodes(kind: str, compared: Comparison) -> None:
    """Every signature of a node, with numbers, pictures and defaults."""
    check_node(compared, kind, range(1))


@pytest.mark.parametrize("kind", NODES)
def test_defaults(kind: str, compared: Comparison) -> None:
    """Each input left out, where all others are given."""
    definitions = compared.definitions(kind)
    names = {one.getName(): None for found in definitions for one in found.getActiveInputs()}
    for i, name in enumerate(name for name in names if (kind, name) not in NEEDED):
        having = [one for one in definitions if one.getActiveInput(name) is not None]
        definition = having[i % len(having)]
        grown = grower(f"{kind} without {name}", left_out=0)
        node = grown.node(definition, given={name: " "})
        compared.check(grown.text, Source(node, *outputs_of(definition)[-1]))


@pytest.mark.slow
def test_nodes_at_many_values(compared: Comparison) -> None:
    for kind in NODES:
        check_node(compared, kind, range(100, 112))


def check_node(compared: Comparison, kind: str, trials: range) -> None:
    definitions = compared.definitions(kind)
    assert definitions
    for definition in definitions:
        for trial in trials:
            for type_, output in outputs_of(definition):
                grown = grower(f"{definition.getName()} {output} {trial}")
                name = grown.node(definition)
                compared.check(grown.text, Source(name, type_, output))


@pytest.mark.parametrize("seed", range(30))
def test_graphs(seed: int, compared: Comparison) -> None:
    """Random graphs of three to five nodes in a row."""
    check_graph(compared, seed)


@pytest.mark.slow
def test_many_graphs(compared: Comparison) -> None:
    for seed in range(1000, 2000):
        check_graph(compared, seed)


def check_graph(compared: Comparison, seed: int) -> None:
    grown = grower(f"graph {seed}", compared.definitions(*NODES))
    type_ = tuple(CHANNELS)[seed % len(CHANNELS)]
    shown = grown.grown(type_, 2 + seed % 3)
    compared.check(grown.text, shown)


# --- Coordinates and pictures


def placed(grown: Grower, compared: Comparison, count: int) -> Source:
    """Coordinates after some random nodes that move them."""
    index = value("index", "integer", grown.constant("integer", (0, 1)))
    found = Source(grown.add("texcoord", "vector2", index), "vector2")
    movers = compared.definitions(*COORDINATES[1:])
    for i in range(count):
        definition = movers[i % len(movers)]
        name = "texcoord" if definition.getNodeString() == "place2d" else "in"
        node = grown.node(definition, given={name: found.given_to(name)})
        found = Source(node, "vector2")
        for kind in ("multiply", "add"):
            inputs = found.given_to("in1")
            inputs += value("in2", "vector2", grown.constant("vector2", (0.3, 1.5)))
            found = Source(grown.add(kind, "vector2", inputs), "vector2")
    return found


@pytest.mark.parametrize("count", range(5))
def test_coordinates(count: int, compared: Comparison) -> None:
    """Coordinates as they are, and the pictures that they show."""
    for trial in range(6):
        grown = grower(f"coordinates {count} {trial}")
        found = placed(grown, compared, count)
        compared.check(grown.text, found)
        file = value("file", "filename", PICTURES[0])
        image = grown.add("image", "color4", file + found.given_to("texcoord"))
        compared.check(grown.text, Source(image, "color4"))


@pytest.mark.parametrize("kind", COORDINATES)
def test_nodes_of_coordinates(kind: str, compared: Comparison) -> None:
    for definition in compared.definitions(kind):
        for trial in range(6):
            grown = grower(f"{definition.getName()} {trial}")
            name, given = "texcoord" if kind == "place2d" else "in", {}
            if kind != "texcoord" and trial:  # without coordinates: those of the definition
                given[name] = placed(grown, compared, 1).given_to(name)
            node = grown.node(definition, given=given)
            (output,) = outputs_of(definition)
            compared.check(grown.text, Source(node, *output))


@pytest.mark.parametrize("kind", IMAGES)
def test_pictures(kind: str, compared: Comparison) -> None:
    """Every signature, with random placements."""
    definitions = compared.definitions(kind)
    assert definitions
    for definition in definitions:
        for trial in range(4):
            for type_, output in outputs_of(definition):
                grown = grower(f"{definition.getName()} {trial}")
                given = {"file": value("file", "filename", PICTURES[trial % 2])}
                for name in ("texcoord", "st"):  # the package always replaces constants
                    given[name] = " "
                    if trial % 2 or name == "st":
                        given[name] = placed(grown, compared, 1).given_to(name)
                if kind == "normalmap":
                    given = {"in": grown.picture("vector3").given_to("in")}
                    size = grown.constant("float", (0.3, 2))
                    type_of = definition.getActiveInput("scale").getType()
                    text = ", ".join([size] * CHANNELS[type_of])
                    given["scale"] = value("scale", type_of, text)
                    given |= dict.fromkeys(("normal", "tangent", "bitangent"), " ")
                node = grown.node(definition, given=given)
                shown = Source(node, type_, output)
                if kind not in NORMALS:
                    compared.check(grown.text, shown)
                    continue
                ours, theirs = compared.values(grown.text, shown)
                length = np.linalg.norm(ours, axis=-1, keepdims=True)
                assert np.abs(ours / length - theirs).max() <= TOLERANCE, grown.text


def test_colours_of_vertices(compared: Comparison) -> None:
    geometry = [
        ("geomcolor", "color3", ""),
        ("geomcolor", "color4", ""),
        ("geompropvalue", "color3", "displayColor"),
        ("geompropvalue", "float", "displayOpacity"),
        ("geompropvalue", "vector2", "st1"),
    ]
    for kind, type_, name in geometry:
        grown = grower(kind)
        node = grown.add(kind, type_, value("geomprop", "string", name) if name else "")
        compared.check(grown.text, Source(node, type_))
        factor = Source(node, type_).given_to("in1") + value("in2", "float", "0.7")
        if type_ != "float":
            node = grown.add("multiply", type_, factor)
            compared.check(grown.text, Source(node, type_))


# --- Values in documents


def test_colour_spaces(compared: Comparison) -> None:
    """Pictures and numbers in all spaces that the package converts."""
    end = "_to_lin_rec709"
    kinds = {one.getNodeString() for one in library().getNodeDefs()}
    spaces = sorted(kind.removesuffix(end) for kind in kinds if kind.endswith(end))
    assert len(spaces) >= 10
    for space in spaces:
        named = f' colorspace="{space}"'
        for type_ in ("color3", "color4"):
            grown = grower(space + type_)
            file = value("file", "filename", PICTURES[0], named)
            numbers = value("value", type_, grown.constant(type_, PICTURED), named)
            for kind, inputs in (("image", file), ("constant", numbers)):
                node = grown.add(kind, type_, inputs)
                compared.check(grown.text, Source(node, type_), most=SIX_DIGITS)


@pytest.mark.parametrize("unit", LENGTHS)
def test_units_of_length(unit: str, compared: Comparison) -> None:
    grown = grower(unit)
    given = f' unittype="distance" unit="{unit}"'
    node = grown.add("add", "vector2", value("in1", "vector2", "0.123, -0.873", given))
    compared.check(grown.text, Source(node, "vector2"), most=SIX_DIGITS)
    inputs = value("file", "filename", PICTURES[0]) + value("uvtiling", "vector2", "100, 70")
    inputs += value("realworldtilesize", "vector2", "0.123, 0.873", given)
    node = grown.add("tiledimage", "color3", inputs)
    compared.check(grown.text, Source(node, "color3"))


@pytest.mark.parametrize("unit", ["degree", "radian"])
def test_units_of_angle(unit: str, compared: Comparison) -> None:
    grown = grower(unit)
    inputs = placed(grown, compared, 0).given_to("in")
    inputs += value("amount", "float", "1.234", f' unittype="angle" unit="{unit}"')
    node = grown.add("rotate2d", "vector2", inputs)
    compared.check(grown.text, Source(node, "vector2"))


def test_channels_of_older_documents(compared: Comparison) -> None:
    """Swizzles, and channels of a connection, which the package replaces by other nodes."""
    for type_, channels in (
        ("color3", "bgr"),
        ("color3", "rrg"),
        ("color4", "abg1"),
        ("vector2", "ra"),
        ("float", "g"),
        ("vector3", "0r1"),
    ):
        for kind in ("swizzle", "dot"):
            grown = grower(channels)
            source = grown.picture("color4")
            if kind == "swizzle":
                inputs = source.given_to("in") + value("channels", "string", channels)
            else:
                more = f' channels="{channels}"/>'
                inputs = source.given_to("in", type_).replace("/>", more)
            node = grown.add(kind, type_, inputs)
            compared.check(grown.text, Source(node, type_), version="1.38")
