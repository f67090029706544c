"""Reads MaterialX documents: a material by its name, as one flat graph.

Node graphs, their interfaces, and definitions of nodes within the document are resolved; nodes of
the standard libraries remain.

Source: MaterialX specification 1.39 (https://materialx.org/Specification.html), chapters
"Nodes", "Node Graph Elements" and "Custom Nodes".
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from daguerre.errors import InputError
from daguerre.files.json_item import short
from daguerre.files.notes import Notes
from daguerre.files.reading import read_bytes
from daguerre.files.xml_elements import Element, parse

from .graph import MAX_NODES, Constant, Graph, Link, Node
from .values import fail, value_of

#: Limits on definitions inside definitions, and on the links that one input follows.
_MAX_NESTING = 32
_MAX_BYTES = 1 << 28
_MAX_HOPS = 1000
#: Types of values that have a colour space.
_COLORED = ("color3", "color4", "filename")


@dataclass(frozen=True)
class _Scope:
    """A place where names have a meaning: the document, or one use of a node graph.

    Attributes:
        path: Prefix of the names of its nodes.
        element: The document or node graph.
        outer: Scope around it.
        use: Element with the inputs of the interface: the graph itself, or a node defined by it.
        defaults: Definition with the values of inputs that ``use`` does not set.
        depth: Number of scopes around it.
    """

    path: str
    element: Element
    outer: _Scope | None = None
    use: Element | None = None
    defaults: Element | None = None
    depth: int = 0


@dataclass(frozen=True)
class _Source:
    """Element of a node or value, and the scope of the names in it."""

    element: Element
    scope: _Scope


class Document:
    """A MaterialX document.

    Args:
        data: Bytes of the file.
        file: Path of the file, for messages and for the names of files in it.
        notes: Receives notes on unsupported content.

    Raises:
        InputError: The bytes are no MaterialX document.
    """

    def __init__(self, data: bytes, file: str, notes: Notes) -> None:
        self.file = file
        self._notes = notes
        root = parse(data, file)
        if root.tag != "materialx":
            raise InputError(f"{file}: XML: wanted <materialx>, got <{short(root.tag)[1:-1]}>")
        self._root = _Scope("", root)
        self._names: dict[int, dict[str, Element]] = {}
        if any(child.tag.endswith(":include") for child in root.children):
            notes.add("a MaterialX document is read without the documents that it includes")
        self._definitions = {
            child.get("name"): child for child in root.children if child.tag == "nodedef"
        }
        self._bodies = {
            child.get("nodedef"): child
            for child in root.children
            if child.tag == "nodegraph" and child.get("nodedef") in self._definitions
        }

    def materials(self) -> list[str]:
        """Names of the materials, in the order of the document."""
        found = self._root.element.children
        return [element.get("name") for element in found if element.tag == "surfacematerial"]

    def graph(self, material: str) -> Graph | None:
        """Graph of a material; None: there is no material of this name.

        Raises:
            InputError: A value is wrong, or connections never end; the message names the line.
        """
        element = self._named(self._root).get(material)
        if element is None or element.tag != "surfacematerial":
            return None
        return _Walk(self).graph(_Source(element, self._root))

    def _named(self, scope: _Scope) -> dict[str, Element]:
        """Elements of a scope by name; the first of equal names counts."""
        key = id(scope.element)
        if key not in self._names:
            named: dict[str, Element] = {}
            for child in scope.element.children:
                if child.tag not in ("input", "nodedef") and child.get("name"):
                    named.setdefault(child.get("name"), child)
            self._names[key] = named
        return self._names[key]

    def _definition(self, node: Element) -> tuple[Element, Element] | None:
        """Definition and graph in this document that make a node; None: a standard node."""
        for name, body in self._bodies.items():
            definition = self._definitions[name]
            fits = definition.get("node") == node.tag and not node.get("nodedef")
            if node.get("nodedef") == name or fits:
                return definition, body
        return None


class _Walk:
    """Follows the connections of one material from its surface."""

    def __init__(self, document: Document) -> None:
        self._document = document
        self._nodes: dict[str, Node] = {}
        self._waiting: list[tuple[str, _Source]] = []

    def graph(self, material: _Source) -> Graph:
        """Graph of the nodes that a material uses."""
        surface, displacement = (
            self._shader(material, name) for name in ("surfaceshader", "displacementshader")
        )
        while self._waiting:
            name, source = self._waiting.pop()
            self._nodes[name] = self._node(source)
        return Graph(self._nodes, surface, _displaces(self._nodes.get(displacement)))

    def _shader(self, material: _Source, name: str) -> str:
        """Name of the node of an input of a material; empty: no node."""
        for child in material.element.children:
            if child.get("name") == name:
                found = self._resolved(_Source(child, material.scope))
                return found.node if isinstance(found, Link) else ""
        return ""

    def _node(self, source: _Source) -> Node:
        element = source.element
        inputs: dict[str, Constant | Link] = {}
        for child in element.children:
            if child.tag in ("input", "parameter"):
                found = self._resolved(_Source(child, source.scope))
                if found is not None:
                    inputs[child.get("name")] = found
        place = f"{self._document.file}: line {element.line}: <{element.tag}>"
        return Node(element.tag, element.get("type"), inputs, place)

    def _resolved(self, source: _Source) -> Constant | Link | None:
        """Follows an input through interfaces and outputs to a node or a value."""
        channels, first = "", source
        for _ in range(_MAX_HOPS):
            element = source.element
            channels = channels or element.get("channels")
            interface = element.get("interfacename")
            step: _Source | Link | None
            if interface:
                step = self._interface(source, interface)
            elif element.get("nodegraph"):
                step = self._output(source, element.get("nodegraph"), element.get("output"))
            elif element.get("nodename"):
                step = self._target(source, element.get("nodename"), element.get("output"))
            elif element.get("output") and element.tag == "input":
                step = self._output(source, "", element.get("output"))
            else:
                return self._constant(source)
            if not isinstance(step, _Source):
                if step is None or not channels:
                    return step
                return self._chosen(step, channels, first.element)
            source = step
        fail(source.element, self._document.file, "connections form a cycle")
        return None

    def _chosen(self, link: Link, channels: str, user: Element) -> Link:
        """Link to channels of an output, by a node between (MaterialX before 1.39)."""
        name = f"{link.node}.{link.output}.{channels}"
        place = f"{self._document.file}: line {user.line}: <{user.tag}>"
        inputs: dict[str, Constant | Link] = {"in": link, "channels": Constant(channels)}
        self._nodes[name] = Node("swizzle", user.get("type"), inputs, place)
        return Link(name)

    def _constant(self, source: _Source) -> Constant | None:
        element = source.element
        if "value" not in element.attributes:
            return None
        text = element.get("value")
        if element.get("type") == "filename":
            text = element.inherited("fileprefix") + text
        value = value_of(element, text, self._document.file)
        colored = element.get("type") in _COLORED
        space = element.inherited("colorspace") if colored else ""
        return Constant(value, space, self._document.file)

    def _interface(self, source: _Source, name: str) -> _Source | None:
        """Input of the graph's interface, in the scope where its value has a meaning."""
        scope = source.scope
        for owner, around in ((scope.use, scope.outer), (scope.defaults, scope.outer)):
            for child in [] if owner is None else owner.children:
                if child.tag in ("input", "parameter") and child.get("name") == name:
                    return _Source(child, around or scope)
        return None

    def _output(self, source: _Source, graph: str, name: str) -> _Source | Link | None:
        """Output of a node graph, or of the document if ``graph`` is empty."""
        scope = source.scope
        if graph:
            element = self._find(source, graph)
            if element is None:
                return None
            if element.tag != "nodegraph":
                return self._target(source, graph, name)
            scope = _Scope(f"{scope.path}{graph}/", element, scope, element, None, scope.depth + 1)
        outputs = [child for child in scope.element.children if child.tag == "output"]
        for output in outputs:
            if output.get("name") == name or (not name and len(outputs) == 1):
                return _Source(output, scope)
        fail(source.element, self._document.file, f"output: there is no output {name!r}")
        return None

    def _target(self, source: _Source, name: str, output: str) -> _Source | Link | None:
        """Node of this name; for a node that the document defines, the output of its graph."""
        element = self._find(source, name)
        if element is None:
            return None
        if element.tag == "nodegraph":
            return self._output(source, name, output)
        if element.tag == "output":
            return _Source(element, source.scope)
        scope, own = source.scope, self._document._definition(element)
        if own is None:
            return self._link(_Source(element, scope), name, output)
        definition, body = own
        if scope.depth >= _MAX_NESTING:
            fail(element, self._document.file, f"wanted at most {_MAX_NESTING} nested graphs")
        inner = _Scope(f"{scope.path}{name}/", body, scope, element, definition, scope.depth + 1)
        return self._output(_Source(source.element, inner), "", output)

    def _link(self, node: _Source, name: str, output: str) -> Link:
        path = node.scope.path + name
        if path not in self._nodes:
            if len(self._nodes) >= MAX_NODES:
                fail(node.element, self._document.file, f"wanted at most {MAX_NODES} nodes")
            self._nodes[path] = Node(node.element.tag)
            self._waiting.append((path, node))
        return Link(path, output)

    def _find(self, source: _Source, name: str) -> Element | None:
        """Element of this name in the scope; a note if missing."""
        element = self._document._named(source.scope).get(name)
        if element is None:
            self._document._notes.add("MaterialX: a connection to a missing node is left out")
        return element


def _displaces(node: Node | None) -> bool:
    """Whether a node of displacement moves anything: it has a picture, or a number but 0."""
    found = None if node is None else node.inputs.get("displacement")
    if isinstance(found, Constant):
        return isinstance(found.value, tuple) and any(found.value)
    return found is not None


def read(path: Path, notes: Notes) -> Document:
    """Reads a document.

    Raises:
        InputError: The file cannot be read, or is no MaterialX document.
    """
    return Document(read_bytes(path, _MAX_BYTES), str(path), notes)
