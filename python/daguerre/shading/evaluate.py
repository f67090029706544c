"""Evaluates a graph of shading nodes from the inputs of its surface.

Each node is evaluated once, without recursion, so that graphs may be deep. A node that is not
supported counts as not connected: the input that it feeds keeps the input's default, and one note
names the node.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any, Protocol

import numpy as np

from daguerre.color import srgb
from daguerre.color.encodings import Encoding, encoding_of, rec709_from
from daguerre.errors import InputError
from daguerre.files.json_item import short
from daguerre.files.notes import Notes
from daguerre.motion.values import Keys
from daguerre.shading.materialx.graph import SIZES, Constant, Graph, Link, Node

from .arithmetic import Arithmetic
from .channels import Coordinate, UnsupportedError, Value, broadcast

Outputs = Value | Mapping[str, Value] | None


class Pictures(Protocol):
    """Source of pictures; for example :class:`daguerre.shading.images.Images`."""

    def picture(self, place: str, path: str, *, is_data: bool = False) -> Any:
        """Decodes the picture of an asset path; None: missing."""

    def keep(self, value: object) -> None:
        """Keeps an array alive, so that its identity stays a key."""


@dataclass
class Context:
    """State that nodes share besides their inputs.

    Attributes:
        images: Source of pictures.
        notes: Receives notes on unsupported content.
        math: Arithmetic with the budget of computed pictures.
        has: Names of the primvars that the surface has; None: all.
        time_s: Time at which keys are evaluated, s.
        cache: Prepared pictures by content, shared by the materials of a stage.
    """

    images: Pictures
    notes: Notes
    math: Arithmetic
    has: frozenset[str] | None = None
    time_s: float = 0.0
    cache: dict[Any, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Arguments:
    """Inputs of one node."""

    node: Node
    context: Context
    values: Mapping[str, Value | None]

    @property
    def size(self) -> int:
        """Number of channels of the node's output; 0: its type says nothing."""
        return SIZES.get(self.node.type, 0)

    def given(self, name: str) -> Value | None:
        """Value of an input; None: no value."""
        found = self.node.inputs.get(name)
        if isinstance(found, Link):
            return self.values.get(name)
        if found is None or isinstance(found.value, str):
            return None
        return constant(found, self.context, self.node.place)

    def value(self, name: str, default: Value | float) -> Value:
        """Value of an input, with as many channels as a default of several."""
        found = self.given(name)
        if isinstance(default, float):
            return (default,) if found is None else found
        if found is None:
            return default
        return broadcast(found, len(default)) if len(default) > 1 else found

    def numbers(self, name: str, default: tuple[float, ...]) -> tuple[float, ...]:
        """Constant numbers of an input.

        Raises:
            UnsupportedError: The input is a picture.
        """
        found = self.value(name, default)
        numbers = tuple(channel for channel in found if isinstance(channel, float))
        if len(numbers) != len(found):
            raise UnsupportedError(f"{self.node.kind}: a picture in '{name}'")
        return numbers[:1] if len(default) == 1 else numbers

    def number(self, name: str, default: float) -> float:
        """A constant number of an input."""
        return self.numbers(name, (default,))[0]

    def text(self, name: str, default: str = "") -> str:
        """Text of an input."""
        found = self.node.inputs.get(name)
        if isinstance(found, Constant) and isinstance(found.value, str):
            return found.value
        return default


Operation = Callable[[Arguments], Outputs]


def constant(found: Constant, context: Context, place: str) -> Value:
    """Numbers of a constant at the time of the context, in linear Rec.709 if it is a colour."""
    numbers = found.value.at(context.time_s) if isinstance(found.value, Keys) else found.value
    row = tuple(float(n) for n in (numbers if isinstance(numbers, tuple) else (numbers,)))
    if not all(math.isfinite(number) for number in row):
        raise InputError(f"{place}: wanted finite numbers, got {short(row)}")
    if len(row) < 3 or not found.space:
        return row
    encoding = known_encoding(found.space, context.notes)
    if encoding.srgb:
        row = (*(float(srgb.to_linear(np.array(n))) for n in row[:3]), *row[3:])
    return in_rec709(row, encoding, context.math)


def in_rec709(color: Value, encoding: Encoding, arithmetic: Arithmetic) -> Value:
    """Undoes gamma and primaries of a colour; opacity, and sRGB's curve, are left as they are."""
    rgb, rest = color[:3], color[3:]
    if encoding.gamma != 1.0:
        rgb = arithmetic.power(arithmetic.clamp(rgb, (0.0,), (math.inf,)), (encoding.gamma,))
    if not encoding.is_rec709:
        rgb = tuple(
            arithmetic.baker.combined(partial(_row, row), *rgb) for row in rec709_from(encoding)
        )
    return (*rgb, *rest)


def known_encoding(space: str, notes: Notes) -> Encoding:
    """Encoding of a named colour space; a note, and linear Rec.709, if the name is unknown."""
    encoding = encoding_of(space)
    if encoding is None:
        notes.add(f"colour space {short(space)} is unknown: read as linear Rec.709")
        return Encoding()
    return encoding


def _row(row: tuple[float, float, float], r: Any, g: Any, b: Any) -> Any:
    return row[0] * r + row[1] * g + row[2] * b


class Evaluator:
    """Values of a graph.

    Args:
        graph: The graph.
        operations: Functions of the nodes, by kind.
        context: State that nodes share.
        kept: Values that earlier evaluations found, of nodes that do not change over time.
    """

    def __init__(
        self,
        graph: Graph,
        operations: Mapping[str, Operation],
        context: Context,
        kept: dict[str, Outputs] | None = None,
    ) -> None:
        self._graph = graph
        self._operations = operations
        self._context = context
        self._done: dict[str, Outputs] = dict(kept or {})

    def surface(self) -> Arguments | None:
        """The surface with its inputs; None: the material has none."""
        return self.arguments(self._graph.surface)

    def arguments(self, name: str) -> Arguments | None:
        """A node with its inputs, which are evaluated on access; None: no such node."""
        node = self._graph.nodes.get(name)
        return None if node is None else Arguments(node, self._context, _Lazy(self, node))

    def note(self, sentence: str) -> None:
        """Adds a note."""
        self._context.notes.add(sentence)

    def still(self, moving: frozenset[str]) -> dict[str, Outputs]:
        """Values of nodes that do not move."""
        return {name: found for name, found in self._done.items() if name not in moving}

    def linked(self, link: Link) -> Value | None:
        """Value of an output; None: its node is missing or not supported."""
        self._evaluate(link.node)
        found = self._done.get(link.node)
        if isinstance(found, Mapping):
            return found.get(link.output) if link.output else next(iter(found.values()), None)
        return found

    def _evaluate(self, name: str) -> None:
        """Evaluates a node after all that it depends on."""
        waiting, entered = [name], set[str]()
        while waiting:
            top = waiting[-1]
            node = self._graph.nodes.get(top)
            if top in self._done or node is None:
                waiting.pop()
                continue
            links = [value.node for value in node.inputs.values() if isinstance(value, Link)]
            missing = [
                name for name in links if name not in self._done and name in self._graph.nodes
            ]
            if missing and top not in entered:
                entered.add(top)
                waiting += missing
                if any(name in entered for name in missing):
                    raise InputError(f"{node.place}: connections form a cycle")
                continue
            waiting.pop()
            self._done[top] = self._applied(node)

    def _applied(self, node: Node) -> Outputs:
        operation = self._operations.get(node.kind)
        if operation is None:
            self._context.notes.add(f"shading node {short(node.kind)} is not supported")
            return None
        values = {
            name: self.linked(link) for name, link in node.inputs.items() if isinstance(link, Link)
        }
        try:
            return _filled(operation(Arguments(node, self._context, values)), node)
        except UnsupportedError as error:
            self._context.notes.add(f"shading: {error} is not supported")
            return None


def _filled(found: Outputs, node: Node) -> Outputs:
    """Outputs of a node; a number is repeated in all channels of its type."""
    if isinstance(found, tuple) and len(found) == 1:
        return found * SIZES.get(node.type, 1)
    return found


class _Lazy(Mapping[str, "Value | None"]):
    """Inputs of a surface that are linked, evaluated when they are read."""

    def __init__(self, evaluator: Evaluator, node: Node) -> None:
        self._evaluator = evaluator
        self._links = {name: link for name, link in node.inputs.items() if isinstance(link, Link)}

    def __getitem__(self, name: str) -> Value | None:
        found = self._evaluator.linked(self._links[name])
        if found is None or not any(isinstance(channel, Coordinate) for channel in found):
            return found
        self._evaluator.note("texture coordinates as the value of a surface are not supported")
        return None

    def __iter__(self) -> Iterator[str]:
        return iter(self._links)

    def __len__(self) -> int:
        return len(self._links)
