"""Objects ("things") of a scene and their categories, by the names of nodes.

Without a file each node with a mesh is an object, and copies share a category: ``Chair``,
``Chair.001`` and ``Chair_2`` are chairs. A file sets other rules::

    {"Chair*": "chair", "Lamp?": {"name": "lamp", "id": 7, "supercategory": "light"}, "Floor": null}

The keys are patterns of names (``*``, ``?``, ``[ab]``). The first pattern in the file that matches
a node decides. A node is one object together with its descendants. Nodes that map to null, or that
no pattern matches, are not objects.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path

from daguerre.argument_checks import guarded
from daguerre.errors import UsageError, suggest
from daguerre.files.json_item import Item, short
from daguerre.files.json_text import parse
from daguerre.files.reading import read_bytes
from daguerre.scene.scene import Scene

#: Endings that programs append to the names of copies.
_COPY = re.compile(r"(?:[ ._-]\d+|\s*\(\d+\))$")
_MAX_BYTES = 1_000_000


@dataclass(frozen=True)
class Category:
    """Category of objects; ids begin at 1, as in COCO."""

    name: str
    id: int
    supercategory: str = ""


@dataclass(frozen=True)
class Thing:
    """Object: instances of a scene that belong together."""

    name: str
    category: Category
    instances: tuple[int, ...]


@dataclass(frozen=True)
class Rule:
    """Category of the nodes that match a pattern; None: they are not objects."""

    pattern: str
    category: Category | None


@guarded(init=True)
@dataclass(frozen=True)
class Categories:
    """Rules that assign categories to nodes of a scene.

    Attributes:
        rules: Rules in order of precedence; None: each name of a node is a category.
        where: Start of messages.
    """

    rules: Sequence[Rule] | None = None
    where: str = "categories"

    @classmethod
    def read(cls, path: str | Path) -> Categories:
        """Reads a file of patterns.

        Raises:
            InputError: The file cannot be used; the message names file and JSON path.
        """
        path = Path(path)
        return cls(_rules(parse(read_bytes(path, _MAX_BYTES), str(path))), str(path))

    def all(self, scene: Scene) -> list[Category]:
        """All categories by id, whether a picture shows them or not."""
        if self.rules is None:
            return list(_by_name(scene).values())
        found = {rule.category.name: rule.category for rule in self.rules if rule.category}
        return sorted(found.values(), key=lambda category: category.id)

    def things(self, scene: Scene) -> list[Thing]:
        """Finds the objects of a scene.

        Raises:
            UsageError: A pattern matches no node.
        """
        if self.rules is None:
            known = _by_name(scene)
            return [
                Thing(name, known[base_name(name)], tuple(instances))
                for name, instances in _nodes(scene).items()
            ]
        self._check(scene)
        return list(self._ruled(scene, self.rules))

    def _ruled(self, scene: Scene, rules: Sequence[Rule]) -> Iterator[Thing]:
        taken: set[int] = set()
        for name, instances in scene.nodes.items():  # parents before children
            rule = next((r for r in rules if fnmatchcase(name, r.pattern)), None)
            left = tuple(i for i in instances if i not in taken) if rule else ()
            taken.update(left)
            if rule is not None and rule.category is not None and left:
                yield Thing(name, rule.category, left)

    def _check(self, scene: Scene) -> None:
        names = list(scene.nodes)
        for rule in self.rules or ():
            if not any(fnmatchcase(name, rule.pattern) for name in names):
                raise UsageError(
                    f"{self.where}: {rule.pattern!r}: no node has a name that "
                    f"matches{suggest(rule.pattern, names)}"
                )


def base_name(name: str) -> str:
    """Name of a node without the number of a copy; a name that is only a number stays."""
    base = name
    while (shorter := _COPY.sub("", base)) != base and shorter:
        base = shorter
    return base.rstrip(" ._-") or name


def _nodes(scene: Scene) -> dict[str, list[int]]:
    """Instances of each node by name; each instance without a node is its own object."""
    nodes: dict[str, list[int]] = {}
    for i, instance in enumerate(scene.instances):
        nodes.setdefault(instance.name or f"instance {i}", []).append(i)
    return nodes


def _by_name(scene: Scene) -> dict[str, Category]:
    names = sorted({base_name(name) for name in _nodes(scene)})
    return {name: Category(name, i + 1) for i, name in enumerate(names)}


def _rules(root: Item) -> list[Rule]:
    members = root.members()
    if not members:
        root.fail("empty, wanted patterns of names with their categories")
    given = [(str(member.key), _category(member)) for member in members]
    known: dict[str, Category] = {}
    for member, (_, category) in zip(members, given, strict=True):
        if category is None:
            continue
        before = known.setdefault(category.name, category)
        if category.id and before.id and category.id != before.id:
            member.fail(
                f"wanted one id for {short(category.name)}, got {before.id} and {category.id}"
            )
        if category.id and not before.id:
            known[category.name] = category
    numbered = _numbered(root, known)
    return [Rule(pattern, category and numbered[category.name]) for pattern, category in given]


def _category(item: Item) -> Category | None:
    """Reads a category; its id is 0 if the file gives none."""
    if item.value is None:
        return None
    if isinstance(item.value, str):
        return Category(item.text(), 0)
    members = ("name", "id", "supercategory")
    for member in item.members():
        if member.key not in members:
            member.fail(f"unknown member{suggest(str(member.key), members, few=True)}")
    number, above = item.get("id"), item.get("supercategory")
    return Category(
        item.need("name").text(),
        0 if number is None else number.integer(1, 2**31 - 1),
        "" if above is None else above.text(),
    )


def _numbered(root: Item, known: dict[str, Category]) -> dict[str, Category]:
    """Assigns free ids from 1 on to categories without id, in the order of the file."""
    taken: dict[int, str] = {}
    for category in known.values():
        if category.id and taken.setdefault(category.id, category.name) != category.name:
            root.fail(
                f"wanted an id for each category, got {category.id} for "
                f"{short(taken[category.id])} and {short(category.name)}"
            )
    free = (i for i in range(1, 2**31) if i not in taken)
    return {
        name: category if category.id else Category(name, next(free), category.supercategory)
        for name, category in known.items()
    }
