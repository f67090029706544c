"""Graph of shading nodes from the node tree of a material.

Groups, reroutes and muted nodes are gone from the graph; every other node has the inputs of its
sockets by identifier. The value that a linked socket would have without its link stands beside the
link under ``=identifier``, properties of the node under ``.name`` as texts.

Source: Blender Python API 5.0, ``bpy.types.NodeTree``, ``NodeLink``, ``NodeSocket``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from daguerre.errors import InputError
from daguerre.files.notes import Notes
from daguerre.shading.materialx.graph import Constant, Graph, Link, Node

from .pictures import alpha_of, space_of
from .tables import table_of

if TYPE_CHECKING:
    import bpy


#: Most nodes of a material, groups taken apart; most groups inside each other, and most links
#: through groups, reroutes and muted nodes that one socket is followed.
MAX_NODES, MAX_DEPTH, MAX_HOPS = 20_000, 64, 1000
#: Kinds of the nodes that turn a colour or a vector into a number.
GREY, MEAN = "value of a color", "value of a vector"
#: Outputs of a material by the engine for which they are, the preferred first.
_TARGETS = ("ALL", "CYCLES", "EEVEE")
_NUMBERS = ("VALUE", "INT", "BOOLEAN")

Stack = tuple[Any, ...]


@dataclass(frozen=True)
class _Place:
    """A node, and the group nodes around it from the outside in."""

    node: bpy.types.Node
    stack: Stack

    @property
    def name(self) -> str:
        return "/".join(str(one.name) for one in (*self.stack, self.node))


class Networks:
    """Reads node trees.

    Args:
        notes: Receives notes on unsupported content.
    """

    def __init__(self, notes: Notes) -> None:
        self._notes = notes
        self._links: dict[int, dict[tuple[str, str], Any]] = {}

    def graph(self, material: bpy.types.Material) -> Graph | None:
        """Graph of a material (``bpy.types.Material``); None: nothing is linked to its surface.

        Raises:
            InputError: A tree has too many nodes, or its links never end; the message names it.
        """
        self._links.clear()
        output = output_of(material.node_tree)
        if output is None:
            return None
        where = f"material {material.name!r}"
        self._noted(output)
        surface = self._source(_Place(output, ()), output.inputs["Surface"], where)
        if not isinstance(surface, _Found):
            return None
        nodes: dict[str, Node] = {}
        waiting = [surface.place]
        while waiting:
            place = waiting.pop()
            if place.name in nodes:
                continue
            if len(nodes) >= MAX_NODES:
                raise InputError(f"{where}: wanted at most {MAX_NODES} shading nodes, got more")
            waiting += self._add(place, nodes, where)
        return Graph(nodes, surface.place.name)

    def _noted(self, output: bpy.types.Node) -> None:
        for name in ("Volume", "Displacement"):
            if output.inputs[name].is_linked:
                self._notes.add(f"the {name.lower()} of a material is not supported")

    def _add(self, place: _Place, nodes: dict[str, Node], where: str) -> list[_Place]:
        """Adds a node; returns the nodes linked to its inputs."""
        inputs: dict[str, Constant | Link] = dict(properties_of(place.node))
        before = []
        for socket in place.node.inputs:
            name = str(socket.identifier)
            found = self._source(place, socket, where)
            if isinstance(found, _Found):
                inputs[name] = _converted(found, socket, nodes)
                before.append(found.place)
                found = default_of(socket)
                name = f"={name}"
            if found is not None:
                inputs[name] = found
        kind = str(place.node.bl_idname)
        nodes[place.name] = Node(kind, "", inputs, f"{where}: node {place.name!r}")
        return before

    def _source(
        self, place: _Place, socket: bpy.types.NodeSocket, where: str
    ) -> _Found | Constant | None:
        """Node and output that feed a socket, or its value; None: neither."""
        stack = place.stack
        for _ in range(MAX_HOPS):
            link = self._link(socket)
            if link is None:
                return default_of(socket)
            node, output = link.from_node, link.from_socket
            kind = node.bl_idname
            if kind == "NodeReroute":
                socket = node.inputs[0]
            elif node.mute:
                through = _through(node, output)
                if through is None:
                    return _nothing(output)
                socket = through
            elif kind == "NodeGroupInput" and stack:
                socket, stack = _named(stack[-1].inputs, output.identifier), stack[:-1]
            elif kind == "ShaderNodeGroup":
                stack = (*stack, node)
                inside = _group_output(node.node_tree)
                if inside is None or len(stack) > MAX_DEPTH:
                    self._notes.add("a node group without an output gives nothing")
                    return _nothing(output)
                socket = _named(inside.inputs, output.identifier)
            else:
                return _Found(_Place(node, stack), output)
            if socket is None:
                return _nothing(output)
        raise InputError(f"{where}: node {place.name!r}: wanted links without a cycle, got one")

    def _link(self, socket: bpy.types.NodeSocket) -> bpy.types.NodeLink | None:
        """Link to a socket; None: none that passes anything."""
        tree = socket.id_data
        known = self._links.get(tree.as_pointer())
        if known is None:
            known = {
                (str(link.to_node.name), str(link.to_socket.identifier)): link
                for link in tree.links
                if link.is_valid and not link.is_muted
            }
            self._links[tree.as_pointer()] = known
        return known.get((str(socket.node.name), str(socket.identifier)))


@dataclass(frozen=True)
class _Found:
    """Output of a node."""

    place: _Place
    output: bpy.types.NodeSocket


def output_of(tree: bpy.types.NodeTree | None) -> bpy.types.Node | None:
    """Active output of a material's tree; None: it has none."""
    if tree is None:
        return None
    found = (tree.get_output_node(target) for target in _TARGETS)
    return next((output for output in found if output is not None), None)


def default_of(socket: bpy.types.NodeSocket) -> Constant | None:
    """Value of a socket without a link; None: it has none, as shaders."""
    value = getattr(socket, "default_value", None)
    if isinstance(value, str):
        return Constant(value)
    if isinstance(value, bool | int | float):
        return Constant((float(value),))
    if value is None or not hasattr(value, "__len__") or socket.type == "ROTATION":
        return None
    if socket.type == "VECTOR" and getattr(socket, "hide_value", False):
        return None  # stands for the normal, the tangent or the coordinates of the surface
    return Constant(tuple(float(number) for number in value[:3]))


def properties_of(node: bpy.types.Node) -> dict[str, Constant]:
    """Choices of a node as texts, by ``.name``; its numbers, curves and ramp as tables."""
    import bpy

    shared = bpy.types.ShaderNode.bl_rna.properties
    found: dict[str, Constant] = {}
    for one in node.bl_rna.properties:
        if one.identifier in shared or one.is_hidden:
            continue
        if one.type in ("ENUM", "STRING") and not getattr(one, "is_enum_flag", False):
            found[f".{one.identifier}"] = Constant(str(getattr(node, one.identifier)))
        elif one.type == "BOOLEAN" and not one.is_array:
            found[f".{one.identifier}"] = Constant("1" if getattr(node, one.identifier) else "")
        elif one.type in ("INT", "FLOAT") and not one.is_array:
            found[f".{one.identifier}"] = Constant((float(getattr(node, one.identifier)),))
    found |= {name: Constant(numbers) for name, numbers in table_of(node).items()}
    found |= _special(node)
    return found


def _special(node: bpy.types.Node) -> dict[str, Constant]:
    """Values that a node keeps on its output, and its picture."""
    if node.bl_idname == "ShaderNodeValue":
        return {".value": Constant((float(node.outputs[0].default_value),))}
    if node.bl_idname == "ShaderNodeRGB":
        return {".value": Constant(tuple(float(c) for c in node.outputs[0].default_value[:3]))}
    if node.bl_idname == "ShaderNodeTexCoord" and node.object is not None:
        rows = [float(one) for row in node.object.matrix_world for one in row]
        return {".object_matrix": Constant(tuple(rows))}
    image = getattr(node, "image", None)
    if image is None:
        return {}
    alpha = node.outputs.get("Alpha")
    return {
        "file": Constant(str(image.name_full), space_of(image)),
        ".alpha": Constant(alpha_of(image)),
        ".uses_alpha": Constant("1" if alpha is not None and alpha.is_linked else ""),
    }


def _converted(found: _Found, socket: bpy.types.NodeSocket, nodes: dict[str, Node]) -> Link:
    """Link to an output, through a node that converts it if the socket takes a number."""
    name, output = found.place.name, str(found.output.identifier)
    kind = {"RGBA": GREY, "VECTOR": MEAN}.get(str(found.output.type))
    if kind is None or socket.type not in _NUMBERS:
        return Link(name, output)
    between = f"{name}>{output}"
    nodes[between] = Node(kind, "float", {"in": Link(name, output)}, between)
    return Link(between)


def _through(node: bpy.types.Node, output: bpy.types.NodeSocket) -> bpy.types.NodeSocket | None:
    """Input that a muted node passes to an output."""
    for link in node.internal_links:
        if link.to_socket.identifier == output.identifier:
            return link.from_socket
    return None


def _nothing(output: bpy.types.NodeSocket) -> Constant | None:
    """Value of an output that nothing feeds."""
    if output.type == "SHADER":
        return None
    return Constant((0.0,) if output.type in _NUMBERS else (0.0, 0.0, 0.0))


def _group_output(tree: bpy.types.NodeTree | None) -> bpy.types.Node | None:
    outputs = [one for one in tree.nodes if one.bl_idname == "NodeGroupOutput"] if tree else []
    active = [one for one in outputs if one.is_active_output]
    return next(iter(active or outputs), None)


def _named(sockets: Sequence[Any], identifier: str) -> bpy.types.NodeSocket | None:
    return next((one for one in sockets if one.identifier == identifier), None)
