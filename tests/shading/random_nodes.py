"""Random nodes of MaterialX's libraries, as XML: constants, pictures and graphs that suit them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

#: Types of values that have one to four channels, and their number.
CHANNELS = {
    **{"float": 1, "vector2": 2, "vector3": 3, "vector4": 4, "color3": 3, "color4": 4},
}
#: Range of the values of pictures, and their names.
PICTURED = (0.1, 0.9)
PICTURES = ("p.exr", "q.exr")

Range = tuple[float, float]
_FREE: Range = (-1, 1)
_WIDE: Range = (-2, 2)
_PLACEMENT: dict[str, Range] = {
    **{"rotate": (-180, 180), "rotation": (-180, 180), "amount": (-180, 180)},
    **{"scale": (0.3, 2), "uvtiling": (0.3, 3)},
    **{"realworldimagesize": (0.3, 2), "realworldtilesize": (0.3, 2)},
}
#: Nodes that place pictures: the renderer takes their inputs as constants.
PLACING = ("place2d", "rotate2d", "UsdTransform2d", "tiledimage", "normalmap")
PLACING += ("gltf_image", "gltf_colorimage", "gltf_normalmap")
#: Ranges of inputs that not all numbers suit, as values end, jump or grow there. Such an input is
#: a constant, or a picture if that lies in the range.
RANGES: dict[str, dict[str, Range]] = {
    "divide": {"in2": (0.1, 2)},
    "modulo": {"in1": _WIDE, "in2": (0.1, 2)},
    "power": {"in1": (0.1, 2), "in2": _WIDE},
    "safepower": {"in1": _WIDE, "in2": (0.1, 3)},
    "sqrt": {"in": (0, 4)},
    "ln": {"in": (0.1, 4)},
    "exp": {"in": _WIDE},
    "tan": {"in": (-1.2, 1.2)},
    "normalize": {"in": (0.1, 2)},
    **{kind: {"in": _WIDE} for kind in ("floor", "ceil", "round", "fract", "sign", "rgbtohsv")},
    "hsvtorgb": {"in": (0.1, 0.9)},
    "clamp": {"low": (-1, 0.3), "high": (0.5, 1.5)},
    "smoothstep": {"low": (-1, 0.3), "high": (0.5, 1.5)},
    "remap": {"inlow": (-1, 0.05), "inhigh": (0.95, 1.5)},
    **{kind: {"value1": _WIDE, "value2": _WIDE} for kind in ("ifgreater", "ifgreatereq")},
    "ifequal": {"value1": (0, 1), "value2": (0, 1)},
    "switch": {"which": (-1, 11)},
    **dict.fromkeys(PLACING, _PLACEMENT),
}
#: Inputs whose default has no result, or does not tell how many channels it has.
NEEDED = {("normalize", "in"), ("convert", "in"), ("power", "in1")}
_OPTIONS = ("out", "constant", "picture", "node")


@dataclass(frozen=True)
class Source:
    """Output of a node; an empty output is the only one."""

    node: str
    type: str
    output: str = ""

    def given_to(self, name: str, type_: str = "") -> str:
        """Input that this output is connected to."""
        output = f' output="{self.output}"' if self.output else ""
        return f'<input name="{name}" type="{type_ or self.type}" nodename="{self.node}"{output}/>'


def value(name: str, type_: str, text: str, more: str = "") -> str:
    """Input with a constant."""
    return f'<input name="{name}" type="{type_}" value="{text}"{more}/>'


class Grower:
    """Makes nodes, each after those that it uses.

    Args:
        rng: Random numbers.
        definitions: Definitions of the nodes that inputs may be connected to.
        left_out: How often an input is left out, where constants have 2 and pictures 3.
    """

    def __init__(
        self, rng: np.random.Generator, definitions: Sequence[Any] = (), left_out: float = 1
    ) -> None:
        self.text = ""
        self._rng, self._left_out = rng, left_out
        self._makers: dict[str, list[tuple[Any, str]]] = {}
        self._pictures: dict[tuple[str, str], Source] = {}
        self._count = 0
        for definition in definitions:
            for type_, output in outputs_of(definition):
                self._makers.setdefault(type_, []).append((definition, output))

    def add(self, kind: str, type_: str, inputs: str, more: str = "") -> str:
        """Adds a node with some inputs; its name."""
        self._count += 1
        name = f"n{self._count}"
        self.text += f'<{kind} name="{name}" type="{type_}"{more}>{inputs}</{kind}>\n'
        return name

    def node(self, definition: Any, depth: int = 0, given: Mapping[str, str] | None = None) -> str:
        """Adds a node with random inputs; its name.

        Args:
            definition: Its definition.
            depth: Number of nodes that may lie behind one of its inputs.
            given: Inputs that are not random, as XML by name.
        """
        kind, fixed = definition.getNodeString(), given or {}
        inputs = "".join(
            fixed.get(one.getName()) or self._input(definition, one, depth)
            for one in definition.getActiveInputs()
        )
        return self.add(kind, definition.getType(), inputs, f' nodedef="{definition.getName()}"')

    def picture(self, type_: str) -> Source:
        """A picture; shaders take few, so that equal ones are one node."""
        name = str(self._rng.choice(PICTURES))
        if (type_, name) not in self._pictures:
            made = self.add("image", type_, value("file", "filename", name))
            self._pictures[type_, name] = Source(made, type_)
        return self._pictures[type_, name]

    def constant(self, type_: str, within: Range = _FREE) -> str:
        """Text of a random value.

        It has few digits, as the package writes no more than six, and the last is one with which
        no number lies where nodes jump.
        """
        if type_ == "boolean":
            return str(self._rng.choice(["true", "false"]))
        if type_ == "integer":
            return str(self._rng.integers(np.ceil(within[0]), np.floor(within[1]) + 1))
        numbers = self._rng.uniform(*within, CHANNELS[type_])
        return ", ".join(f"{number:.2f}3" for number in numbers)

    def _input(self, definition: Any, one: Any, depth: int) -> str:
        kind, name, type_ = definition.getNodeString(), one.getName(), one.getType()
        if type_ not in (*CHANNELS, "integer", "boolean"):
            return ""
        limited = RANGES.get(kind, {}).get(name)
        low, high = limited or _FREE
        still = type_ not in CHANNELS or kind in PLACING or one.getIsUniform() or name == "which"
        lit = low <= PICTURED[0] and high >= PICTURED[1] and kind != "ifequal"
        allowed = ((kind, name) not in NEEDED, True, not still and (lit or not limited))
        deep = depth > 0 and not still and not limited and type_ in self._makers
        weights = np.array([*allowed, deep]) * [self._left_out, 2, 3, 8]
        option = self._rng.choice(_OPTIONS, p=weights / weights.sum())
        if option == "out":
            return ""
        if option == "picture":
            return self.picture(type_).given_to(name)
        if option == "node":
            return self.grown(type_, depth - 1).given_to(name)
        if name == "index":  # of a channel, or of one of two sets of coordinates
            source = definition.getActiveInput("in")
            low, high = 0, 1 if source is None else CHANNELS[source.getType()] - 1
        return value(name, type_, self.constant(type_, (low, high)))

    def grown(self, type_: str, depth: int) -> Source:
        """Adds a random node of a type, and those behind it."""
        makers = self._makers[type_]
        definition, output = makers[self._rng.integers(len(makers))]
        return Source(self.node(definition, depth), type_, output)


def outputs_of(definition: Any) -> list[tuple[str, str]]:
    """Type and name of the outputs of a definition that have channels; one alone has no name."""
    found = [(one.getType(), one.getName()) for one in definition.getActiveOutputs()]
    if len(found) == 1:
        found = [(found[0][0], "")]
    return [(type_, name) for type_, name in found if type_ in CHANNELS]
