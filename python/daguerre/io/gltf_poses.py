"""Where the nodes of a file stand at any time, and whether they are shown.

Only nodes that move are worked out, each once for a time, for some times at once.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Sequence
from functools import cached_property

from .gltf_animation import Animations, Channel, breaks_of
from .gltf_nodes import Tree, is_visible
from .gltf_samplers import FloatArray
from .gltf_transforms import Matrix

#: Times whose poses are kept.
_MAX_POSES = 64
#: Scales below this leave no volume, or may mirror on their way.
_THIN = 1e-6
_PLACE = ("translation", "rotation", "scale")


class Poses:
    """The nodes of a file over time.

    Args:
        tree: The nodes, as they are at the time of reading.
        animations: What changes them.
    """

    def __init__(self, tree: Tree, animations: Animations) -> None:
        self._tree = tree
        self._own: dict[int, list[Channel]] = {}
        self._shown: dict[int, list[Channel]] = {}
        for node in animations.parts("nodes"):
            channels = animations.of("nodes", str(node))
            own = [c for c in channels if c.target.key in _PLACE and len(c.tokens) == 3]
            shown = [c for c in channels if c.target.is_flag]
            self._own |= {node: own} if own else {}
            self._shown |= {node: shown} if shown else {}
        self._worlds: OrderedDict[float, dict[int, Matrix]] = OrderedDict()

    @cached_property
    def _moving(self) -> set[int]:
        return self._below(self._own)

    @cached_property
    def _blinking(self) -> set[int]:
        return self._below(self._shown)

    @cached_property
    def _thin(self) -> set[int]:
        """Nodes that a scale may press flat on the way."""
        return self._below(
            {
                node
                for node, channels in self._own.items()
                if any(c.target.key == "scale" and c.track.lowest < _THIN for c in channels)
            }
        )

    def _below(self, nodes: dict[int, list[Channel]] | set[int]) -> set[int]:
        """The nodes and all their descendants."""
        found, stack = set(), list(nodes)
        while stack:
            node = stack.pop()
            if node not in found:
                found.add(node)
                stack.extend(self._tree.children[node])
        return found

    def moves(self, node: int) -> bool:
        """Whether the node's place changes."""
        return node in self._moving

    def may_be_flat(self, node: int) -> bool:
        """Whether a scale may press the node flat at some time."""
        return node in self._thin

    def blinks(self, node: int) -> bool:
        """Whether the node is shown at some times only; what hides it always wins."""
        if node not in self._blinking:
            return False
        return all(n in self._shown or is_visible(self._tree.items[n]) for n in self._chain(node))

    def world(self, node: int, time: float) -> Matrix:
        """World from node at a time, s, shape (4, 4)."""
        worlds = self._at(time)
        chain = []
        while node >= 0 and node not in worlds and node in self._moving:
            chain.append(node)
            node = self._tree.parents[node]
        world = worlds[node] if node in worlds else self._still(node)
        for below in reversed(chain):
            values = {str(c.target.key): c.track.at(time) for c in self._own.get(below, ())}
            world = self._tree.joined(world, below, values)
            worlds[below] = world
        assert world is not None
        return world

    def shown(self, node: int, time: float) -> bool:
        """Whether a node that blinks is shown at a time, s."""
        return all(c.track.at(time) for n in self._chain(node) for c in self._shown.get(n, ()))

    def breaks(self, node: int, begin: float, end: float) -> FloatArray:
        """Times of all keys that move the node, inside of (begin, end), s."""
        return self.breaks_of_all([node], begin, end)

    def breaks_of_all(self, nodes: Sequence[int], begin: float, end: float) -> FloatArray:
        """Likewise of several nodes."""
        chains = dict.fromkeys(n for node in nodes for n in self._chain(node))
        return breaks_of([c for n in chains for c in self._own.get(n, ())], begin, end)

    def shown_breaks(self, node: int, begin: float, end: float) -> FloatArray:
        """Likewise of keys that show or hide it."""
        return breaks_of([c for n in self._chain(node) for c in self._shown.get(n, ())], begin, end)

    def _chain(self, node: int) -> list[int]:
        """The node and its ancestors."""
        chain = []
        while node >= 0:
            chain.append(node)
            node = self._tree.parents[node]
        return chain

    def _still(self, node: int) -> Matrix | None:
        return None if node < 0 else self._tree.world(node)

    def _at(self, time: float) -> dict[int, Matrix]:
        if time not in self._worlds:
            while len(self._worlds) >= _MAX_POSES:
                self._worlds.popitem(last=False)
            self._worlds[time] = {}
        return self._worlds[time]
