"""The node tree of glTF: checked, named and flattened without recursion, however deep it is.

Source: glTF 2.0 specification, chapters 3.5 and 3.11 (a node that is animated has no matrix).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .json_item import Item

Matrix = NDArray[np.float64]
#: Lengths beyond this (m) overflow when a renderer squares them in float.
MAX_SIZE = 1e18
_DEFAULTS = {
    "translation": (0.0, 0.0, 0.0),
    "rotation": (0.0, 0.0, 0.0, 1.0),
    "scale": (1.0, 1.0, 1.0),
}


@dataclass(frozen=True)
class Placed:
    """A node of the scene.

    Attributes:
        index: Its index in the file.
        world: World from node, shape (4, 4).
        end: The node's descendants are the placed nodes from the next one up to this position.
    """

    index: int
    world: Matrix
    end: int


class Tree:
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
        for node, item in enumerate(self.items):
            self.children.append([])
            for child_item in item.list_of("children"):
                child = child_item.index(len(self.items), "nodes")
                if self.parents[child] >= 0 or child == node:
                    other = node if child == node else self.parents[child]
                    child_item.fail(
                        f"wanted a tree of nodes, got node {child} that is already "
                        f"a child of node {other}"
                    )
                self.parents[child] = node
                self.children[node].append(child)
        self._refuse_cycles()

    def _refuse_cycles(self) -> None:
        # With one parent each, what no root reaches hangs in a ring.
        stack = [node for node, parent in enumerate(self.parents) if parent < 0]
        reached = [False] * len(self.items)
        while stack:
            node = stack.pop()
            reached[node] = True
            stack.extend(self.children[node])
        if not all(reached):
            node = reached.index(False)
            self.items[node].fail("wanted a tree of nodes, got a node that is its own ancestor")

    def roots(self, scene: Item | None) -> list[int]:
        """Root nodes of a scene, or of the whole file."""
        if scene is None:
            return [node for node, parent in enumerate(self.parents) if parent < 0]
        roots: dict[int, None] = {}
        for item in scene.list_of("nodes"):
            node = item.index(len(self.items), "nodes")
            if node in roots:
                item.fail(f"wanted each node once, got node {node} again")
            if self.parents[node] >= 0:
                item.fail(
                    f"wanted a root node, got node {node}, a child of node {self.parents[node]}"
                )
            roots[node] = None
        return list(roots)

    def place(self, roots: list[int], poses: dict[tuple[int, str], Matrix]) -> list[Placed]:
        """World transforms, parents before their children, a subtree in one piece."""
        order: list[tuple[int, Matrix]] = []
        ends: list[int] = []
        stack: list[tuple[int, Matrix | None, int]] = [(r, None, -1) for r in reversed(roots)]
        while stack:
            node, above, closes = stack.pop()
            if closes >= 0:
                ends[closes] = len(order)
                continue
            local = self.local(node, poses)
            world = local if above is None else above @ local
            size = float(np.abs(world).max())
            if not size < MAX_SIZE:  # NaN is not smaller than anything
                self.items[node].fail(
                    f"world transform: wanted numbers below {MAX_SIZE:g}, got {size:g}"
                )
            stack.append((node, None, len(order)))
            order.append((node, world))
            ends.append(0)
            stack.extend((child, world, -1) for child in reversed(self.children[node]))
        return [Placed(n, w, end) for (n, w), end in zip(order, ends, strict=True)]

    def local(self, node: int, poses: dict[tuple[int, str], Matrix]) -> Matrix:
        """Parent from node at the time of the poses."""
        item = self.items[node]
        animated = any((node, path) in poses for path in _DEFAULTS)
        matrix = item.get("matrix")
        if matrix is None:
            t, q, s = (
                poses[node, path] if (node, path) in poses else item.numbers_of(path, default)
                for path, default in _DEFAULTS.items()
            )
            return _compose(np.asarray(t), np.asarray(q), np.asarray(s), item)
        if animated or any(path in item.value for path in _DEFAULTS):
            matrix.fail("wanted either a matrix or translation, rotation and scale, got both")
        values = np.array(matrix.numbers(16)).reshape(4, 4).T  # stored by columns
        if not np.allclose(values[3], (0, 0, 0, 1), atol=1e-6):
            matrix.fail(f"wanted 0, 0, 0, 1 as its last row, got {values[3].tolist()}")
        values[3] = (0, 0, 0, 1)
        return values


def _compose(t: Matrix, q: Matrix, s: Matrix, item: Item) -> Matrix:
    """Translation x rotation x scale; the quaternion is x, y, z, w and made a unit first."""
    length = float(np.sqrt(q @ q))
    if not 1e-9 < length < np.inf:
        rotation = Item(q.tolist(), "rotation", item)
        rotation.fail(f"wanted a quaternion of length 1, got length {length:g}")
    x, y, z, w = (q / length).tolist()
    matrix = np.eye(4)
    matrix[:3, :3] = (
        (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
        (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
        (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
    )
    matrix[:3, :3] *= s
    matrix[:3, 3] = t
    return matrix


def without_scale(world: Matrix) -> Matrix | None:
    """The rigid part of a transform: place, -z and +y kept; None if there is no direction left.

    Cameras and lights ignore the scale of their node (glTF 2.0, 3.10; KHR_lights_punctual).
    """
    z, y = world[:3, 2], world[:3, 1]
    x = np.cross(y, z)
    lengths = np.linalg.norm(z), np.linalg.norm(x)
    if lengths[0] < 1e-20 or lengths[1] < 1e-30:
        return None
    rigid = np.eye(4)
    rigid[:3, 2] = z / lengths[0]
    rigid[:3, 0] = x / lengths[1]
    rigid[:3, 1] = np.cross(rigid[:3, 2], rigid[:3, 0])
    rigid[:3, 3] = world[:3, 3]
    return rigid


def unique_names(tree: Tree, meshes: list[Item], cameras: list[Item]) -> list[str]:
    """A name for each node, none twice: its own, else that of what it carries, else its index."""
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
