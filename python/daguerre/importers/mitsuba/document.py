"""Reads a scene file of Mitsuba, and the files that it includes, into objects with properties.

``<default>`` and parameters, ``<include>``, ``<path>``, ``<alias>`` and ``<ref>`` are resolved
here, and names of old versions are replaced (:mod:`.upgrade`), as Mitsuba's own loader does.

Source: Mitsuba 3, documentation of the scene format
(https://mitsuba.readthedocs.io/en/stable/src/key_topics/scene_format.html).
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from pathlib import Path

from daguerre.errors import asked_by
from daguerre.files.budget import Budget
from daguerre.files.includes import Includes
from daguerre.files.json_item import Item, short
from daguerre.files.reading import read_bytes
from daguerre.files.xml_elements import MAX_BYTES, MAX_ELEMENTS, Element, parse

from .files import Files
from .ledger import Entry, Ledger
from .node import Node, Property
from .parameters import MAX_NAME, Parameters
from .transforms import product
from .upgrade import upgraded
from .values import VALUES, known, label_of, needed

#: Objects inside each other, references and included files among them.
MAX_DEPTH = 64
#: Files that include each other.
MAX_INCLUDES = 15
#: Elements of objects, and the kind of each.
OBJECTS = {
    **{
        kind: kind
        for kind in (
            *("scene", "bsdf", "emitter", "film", "integrator", "medium", "phase", "rfilter"),
            *("sampler", "sensor", "shape", "subsurface", "texture", "volume"),
        )
    },
    "luminaire": "emitter",  # names before Mitsuba 0.4
    "camera": "sensor",
}
_VERSION = re.compile(r"\s*(\d{1,6})(?:\.(\d{1,6}))?(?:\.(\d{1,6}))?\s*\Z", re.ASCII)
Version = tuple[int, int, int]


class Document:
    """A scene file with all that it includes.

    Args:
        file: The file.
        files: Folders of the files that it names.
        define: Values of parameters.

    Attributes:
        root: The scene, with all references resolved.
        ledger: All elements.
        includes: Counts the files that it includes.

    Raises:
        InputError: A file is no scene of Mitsuba; the message names file, line, column and element.
        UsageError: The file lacks a parameter of ``define``.
    """

    def __init__(self, file: Path, files: Files, define: Mapping[str, str]) -> None:
        self.ledger = Ledger()
        self.parameters = Parameters(define)
        self.references: list[tuple[Property, str]] = []
        self._ids: dict[str, Node] = {}
        self._budget = Budget(MAX_ELEMENTS, "elements in all files")
        self._files: dict[int, Files] = {}
        self.includes = Includes()
        self.root = _DocumentReader(self, files, str(file), 0, 0).root(read_bytes(file, MAX_BYTES))
        if self.root.kind != "scene":
            self.root.fail("the root element must be <scene>")
        self._resolve()
        self.parameters.check_used()

    def files_of(self, node: Node) -> Files:
        """Folders for names of files in an object."""
        return self._files[id(node)]

    def entry(self, file: str, element: Element) -> Entry:
        """Adds an element to the accounts."""
        self._budget.spend(1, Item(None, file))
        return self.ledger.add(file, (element.line, element.column), label_of(element))

    def add(self, node: Node, files: Files) -> None:
        """Adds an object under its id."""
        self._files[id(node)] = files
        if node.id:
            self.name(node.id, node, node.entry)

    def name(self, name: str, node: Node, entry: Entry) -> None:
        """Gives an object an id."""
        if name in self._ids:
            entry.fail(f"the id {short(name)} appears twice")
        self._ids[name] = node

    def named(self, name: str, entry: Entry) -> Node:
        """Object of an id."""
        if name not in self._ids:
            entry.fail(f"no object has the id {short(name)}")
        return self._ids[name]

    def _resolve(self) -> None:
        """Puts objects in the place of references to them."""
        for reference, name in self.references:
            reference.value = self.named(name, reference.entry)
        _check_depth(self.root)


def _check_depth(root: Node) -> None:
    """Checks that objects are not inside themselves, nor too deep, by way of references.

    Raises:
        InputError: An object contains itself, or objects are nested too deeply.
    """
    height: dict[int, int] = {}
    waiting: list[tuple[Node, bool]] = [(root, False)]
    inside: set[int] = set()
    while waiting:
        node, is_done = waiting.pop()
        below = [item.value for item in node.properties if isinstance(item.value, Node)]
        if is_done:
            inside.discard(id(node))
            height[id(node)] = 1 + max((height[id(child)] for child in below), default=0)
            if height[id(node)] > MAX_DEPTH:
                node.fail(f"nested too deeply: the limit is {MAX_DEPTH} objects")
        elif id(node) in inside:
            node.fail("references form a cycle: the object contains itself")
        elif id(node) not in height:
            inside.add(id(node))
            waiting.append((node, True))
            for child in below:
                if id(child) in inside:
                    child.fail("references form a cycle: the object contains itself")
                waiting.append((child, False))


class _DocumentReader:
    """Reads one file.

    Args:
        document: Receives the content of the file.
        files: Folders of the files that it names.
        name: Path of the file, for messages.
        includes: Number of files around it.
        depth: Number of objects around it.
    """

    def __init__(
        self, document: Document, files: Files, name: str, includes: int, depth: int
    ) -> None:
        self._document, self._files, self._name = document, files, name
        self._includes, self._depth = includes, depth
        self._version: Version = (3, 0, 0)

    def root(self, data: bytes) -> Node:
        """Reads the object at the top of the file."""
        root = parse(data, self._name)
        entry = self._document.entry(self._name, root)
        if root.tag not in OBJECTS:
            entry.fail("not an object of Mitsuba's scene format")
        self._version = _version(root, entry)
        entry.used = True
        return self._object(root, entry, top=True)

    def _object(self, element: Element, entry: Entry, *, top: bool = False) -> Node:
        """Object of an element, with its properties."""
        known(element, entry, "type", "id", "name", *(("version",) if top else ()))
        kind = OBJECTS.get(element.tag, "texture")  # or a <spectrum> with a type
        plugin = element.get("type") or ("scene" if kind == "scene" else "")
        if not plugin:
            entry.fail("the attribute 'type' is missing")
        node = Node(kind, plugin, entry, element.get("id"))
        self._document.add(node, self._files)
        self._depth += 1
        if self._depth > MAX_DEPTH:
            entry.fail(f"nested too deeply: the limit is {MAX_DEPTH} objects")
        for child in element.children:
            self._child(node, child)
        self._depth -= 1
        if self._version < (2, 0, 0):
            upgraded(node)
        _check_once(node)
        return node

    def _child(self, node: Node, element: Element) -> None:
        entry = self._begun(element)
        tag = element.tag
        if tag in OBJECTS or (tag == "spectrum" and "type" in element.attributes):
            child = self._object(element, entry)
            node.properties.append(Property(element.get("name"), "object", child, entry))
        elif tag == "transform":
            node.properties.append(self._transform(element, entry))
        elif tag in _DIRECTIVES:
            _leaf(element, entry)
            _DIRECTIVES[tag](self, node, element, entry)
        elif tag in VALUES:
            _leaf(element, entry)
            value = VALUES[tag](element, entry)
            if not element.get("name"):
                entry.fail("the attribute 'name' is missing")
            node.properties.append(Property(element.get("name"), tag, value, entry))
        else:
            entry.fail("not an element of Mitsuba's scene format")

    def _begun(self, element: Element) -> Entry:
        """Adds an element to the accounts, and puts the values of parameters into it."""
        entry = self._document.entry(self._name, element)
        for name, value in element.attributes.items():
            element.attributes[name] = self._document.parameters.fill(value, entry)
        return entry

    # Directives -----------------------------------------------------------------------------------

    def _default(self, node: Node, element: Element, entry: Entry) -> None:
        name, value = needed(element, entry, "name", "value")
        if not name:
            entry.fail("the name is empty")
        if len(name) > MAX_NAME:
            entry.fail(f"the name is too long: the limit is {MAX_NAME} characters")
        self._document.parameters.default(name, value)
        entry.used = True

    def _include(self, node: Node, element: Element, entry: Entry) -> None:
        known(element, entry, "filename", "name")
        if self._includes >= MAX_INCLUDES:
            entry.fail(f"too many nested includes: the limit is {MAX_INCLUDES}")
        path = self._files.need(element.get("filename"), entry)
        inside = self._files.within(path.parent)
        reader = _DocumentReader(self._document, inside, str(path), self._includes + 1, self._depth)
        with asked_by(entry):
            data = read_bytes(path, MAX_BYTES)
        self._document.includes.count(path, len(data), entry)
        found = reader.root(data)
        entry.used = True
        if found.kind == "scene":
            node.properties.extend(found.properties)
        else:
            node.properties.append(Property(element.get("name"), "object", found, entry))

    def _path(self, node: Node, element: Element, entry: Entry) -> None:
        (value,) = needed(element, entry, "value")
        if node.kind != "scene":
            entry.fail(f"allowed only at the top of a scene, not in {node.entry.label}")
        self._files.prepend(value, entry)
        entry.used = True

    def _alias(self, node: Node, element: Element, entry: Entry) -> None:
        name, other = needed(element, entry, "id", "as")
        self._document.name(other, self._document.named(name, entry), entry)
        entry.used = True

    def _ref(self, node: Node, element: Element, entry: Entry) -> None:
        known(element, entry, "id", "name")
        found = Property(element.get("name"), "object", None, entry)
        node.properties.append(found)
        self._document.references.append((found, element.get("id")))

    # Transforms -----------------------------------------------------------------------------------

    def _transform(self, element: Element, entry: Entry) -> Property:
        (name,) = needed(element, entry, "name")
        parts = [self._begun(child) for child in element.children]
        for child, part in zip(element.children, parts, strict=True):
            _leaf(child, part)
        steps = [(child.tag, child.attributes) for child in element.children]
        return Property(name, "transform", product(steps, parts), entry, parts)


_DIRECTIVES: dict[str, Callable[[_DocumentReader, Node, Element, Entry], None]] = {
    "default": _DocumentReader._default,
    "include": _DocumentReader._include,
    "path": _DocumentReader._path,
    "alias": _DocumentReader._alias,
    "ref": _DocumentReader._ref,
}


def _version(root: Element, entry: Entry) -> Version:
    found = _VERSION.match(root.get("version"))
    if not found:
        entry.fail(f"wanted a version such as 3.0.0, got {short(root.get('version'))}")
    if int(found[1]) > 3:
        entry.fail(f"wanted a version of at most 3, got {short(root.get('version'))}")
    return int(found[1]), int(found[2] or 0), int(found[3] or 0)


def _leaf(element: Element, entry: Entry) -> None:
    """Checks that an element has no elements inside."""
    if element.children:
        entry.fail(f"no element is allowed inside, got {label_of(element.children[0])}")


def _check_once(node: Node) -> None:
    """Checks that each name of a property occurs once."""
    seen: set[str] = set()
    for item in node.properties:
        if item.name and item.name in seen:
            item.entry.fail(f"the property {short(item.name)} appears twice")
        seen.add(item.name)
