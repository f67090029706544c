"""Checks, names and flattens the node tree of glTF without recursion, at any depth.

Source: glTF 2.0 specification, chapters 3.5 and 3.11 (animated nodes have no matrix).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from daguerre.files.json_item import Item
from daguerre.files.value import Value
from daguerre.scene.limits import MAX_SIZE, largest
from daguerre.scene.transforms import Matrix, affine, compose

#: Parts of a node's transform, with their defaults.
_DEFAULTS = {
    "translation": (0.0, 0.0, 0.0),
    "rotation": (0.0, 0.0, 0.0, 1.0),
    "scale": (1.0, 1.0, 1.0),
}


@dataclass(frozen=True)
class Placed:
    """A node of the scene.

    Attributes:
        index: Index of the node in the file.
        world: World from node, shape (4, 4).
        visible: Whether its meshes and lights are shown.
        end: Position after its descendants, which follow the node in the list of placed nodes.
    """

    index: int
    world: Matrix
    visible: bool
    end: int


class Tree(Value):
    """The nodes of a file.

    Args:
        root: The JSON object of the file.

    Raises:
        InputError: A child is out of range, has two parents, or is its own ancestor.
    """

    def __init__(self, root: Item) -> None:
        self.items = root.list_of("nodes")
        self.children: list[list[int]] = []
        self.parents = [-1] * len(self.items)
        self._worlds: dict[int, Matrix] = {}
        self._placed: set[int] = set()
        for node, item in enumerate(self.items):
            self.children.append([])
            for child_item in item.list_of("children"):
                child = child_item.index(len(self.items), "nodes")
                if self.parents[child] >= 0 or child == node:
                    other = node if child == node else self.parents[child]
                    child_item.fail(
                        f"node {child} is already a child of node {other}: a node has at most "
                        f"one parent"
                    )
                self.parents[child] = node
                self.children[node].append(child)
        self._refuse_cycles()

    def _refuse_cycles(self) -> None:
        # Each node has one parent, so nodes that no root reaches form a cycle.
        stack = [node for node, parent in enumerate(self.parents) if parent < 0]
        reached = [False] * len(self.items)
        while stack:
            node = stack.pop()
            reached[node] = True
            stack.extend(self.children[node])
        if not all(reached):
            node = reached.index(False)
            self.items[node].fail("the node is its own ancestor")

    def roots(self, scene: Item | None) -> list[int]:
        """Root nodes of a scene, or of the whole file."""
        if scene is None:
            return [node for node, parent in enumerate(self.parents) if parent < 0]
        roots: dict[int, None] = {}
        for item in scene.list_of("nodes"):
            node = item.index(len(self.items), "nodes")
            if node in roots:
                item.fail(f"node {node} appears twice")
            if self.parents[node] >= 0:
                item.fail(
                    f"wanted a root node, but node {node} is a child of node {self.parents[node]}"
                )
            roots[node] = None
        return list(roots)

    def place(self, roots: list[int]) -> list[Placed]:
        """Places roots and descendants: parents before children, each subtree in one piece."""
        order: list[tuple[int, bool]] = []
        ends: list[int] = []
        stack: list[tuple[int, bool, int]] = [(root, True, -1) for root in reversed(roots)]
        while stack:
            node, visible, closes = stack.pop()
            if closes >= 0:
                ends[closes] = len(order)
                continue
            visible = visible and is_visible(self.items[node])
            stack.append((node, visible, len(order)))
            order.append((node, visible))
            ends.append(0)
            self.world(node)
            stack.extend((child, visible, -1) for child in reversed(self.children[node]))
        self._placed.update(node for node, _ in order)
        return [Placed(n, self.world(n), v, end) for (n, v), end in zip(order, ends, strict=True)]

    def is_placed(self, node: int) -> bool:
        """Whether the node is in the scene."""
        return node in self._placed

    def world(self, node: int) -> Matrix:
        """World from node, also for nodes outside of the scene."""
        chain = []
        while node >= 0 and node not in self._worlds:
            chain.append(node)
            node = self.parents[node]
        for below in reversed(chain):
            parent = self.parents[below]
            local = self.local(below)
            world = local if parent < 0 else self._worlds[parent] @ local
            self.check_size(below, world)
            self._worlds[below] = world
        return self._worlds[chain[0] if chain else node]

    def check_size(self, node: int, world: Matrix) -> None:
        """Checks transforms (..., 4, 4) for NaN and numbers of ``MAX_SIZE`` and beyond."""
        size = largest(world)
        if not size < MAX_SIZE:  # also catches NaN
            self.items[node].fail(
                f"world transform: wanted numbers below {MAX_SIZE:g}, got {size:g}"
            )

    def local(self, node: int) -> Matrix:
        """Parent from node."""
        item = self.items[node]
        matrix = item.get("matrix")
        if matrix is None:
            return compose(*self.parts(node))
        if any(path in item.value for path in _DEFAULTS):  # animated nodes have these, too
            matrix.fail("wanted either a matrix or translation, rotation and scale, got both")
        return affine(np.array(matrix.numbers(16)).reshape(4, 4).T, matrix)  # stored by columns

    def parts(self, node: int) -> tuple[Matrix, Matrix, Matrix]:
        """Translation (3,), rotation (4,; unit x, y, z, w) and scale (3,) of a node."""
        item = self.items[node]
        t, q, s = (np.array(item.numbers_of(path, d)) for path, d in _DEFAULTS.items())
        length = float(np.sqrt(q @ q))
        if not 1e-9 < length < np.inf:
            item.need("rotation").fail(f"wanted a quaternion of length 1, got length {length:g}")
        return t, q / length, s


def is_visible(item: Item) -> bool:
    """KHR_node_visibility of a node; it also applies to the node's descendants."""
    extension = item.extension("KHR_node_visibility")
    visible = None if extension is None else extension.get("visible")
    return visible is None or visible.flag()


def unique_names(tree: Tree, meshes: list[Item], cameras: list[Item]) -> list[str]:
    """Unique name of each node: the node's, else its mesh's or camera's, else from its index."""
    taken: set[str] = set()
    counters: dict[str, int] = {}
    names: list[str] = []
    for index, item in enumerate(tree.items):
        base = item.name()
        for key, carried in (("mesh", meshes), ("camera", cameras)):
            use = item.get(key)
            if use is not None and not base:
                base = carried[use.index(len(carried), key + "s")].name()
        base = base or f"node{index}"
        name = base
        while name in taken:
            counters[base] = counters.get(base, 0) + 1
            name = f"{base}.{counters[base]:03d}"
        taken.add(name)
        names.append(name)
    return names
