"""Graph of shading nodes, the same for MaterialX documents and USD's shading networks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from daguerre.motion.values import Keys

#: Limit on the nodes of one material, as definitions inside definitions multiply.
MAX_NODES = 120_000
#: Number of components of each type; other types are texts.
SIZES = {
    **{"float": 1, "integer": 1, "boolean": 1},
    **{"vector2": 2, "vector3": 3, "vector4": 4, "color3": 3, "color4": 4},
}


@dataclass(frozen=True)
class Link:
    """Connection to an output of a node; an empty name is its only output."""

    node: str
    output: str = ""


@dataclass(frozen=True)
class Constant:
    """Value of an input.

    Attributes:
        value: Numbers, a text, or keys of numbers over time.
        space: Name of the colour space of a colour or of a file's colours; empty: none is given.
        base: Folder or layer to which a file name is relative; empty: the document's folder.
    """

    value: tuple[float, ...] | str | Keys
    space: str = ""
    base: str = ""


@dataclass(frozen=True)
class Node:
    """A node of a graph.

    Attributes:
        kind: Name of the node's definition without its types, such as "image".
        type: Type of the only output, such as "color3"; empty: as in the definition.
        inputs: Constants and links by name; inputs that have no value are absent.
        place: File and element, for messages.
    """

    kind: str
    type: str = ""
    inputs: Mapping[str, Constant | Link] = field(default_factory=dict)
    place: str = ""


@dataclass(frozen=True)
class Graph:
    """Nodes of a material by name, and the name of its surface; empty: it has none.

    Attributes:
        displaced: Whether the material has a displacement.
    """

    nodes: Mapping[str, Node]
    surface: str = ""
    displaced: bool = False
