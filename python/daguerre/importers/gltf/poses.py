"""Computes transforms and visibility of the nodes of a file at any time.

Only moving nodes are computed, for many times at once.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Sequence
from contextlib import suppress
from typing import Any

import numpy as np

from daguerre.cached import cached_property
from daguerre.files.value import Value
from daguerre.scene.transforms import Matrix, compose

from .animation import Animations, Channel, breaks_of
from .nodes import Tree, is_visible
from .samplers import FloatArray

#: Limits of the cache of poses, which serves the children of a node: entries, and matrices (8 MB).
#: It is small, as poses of finished frames are not needed again.
_MAX_KNOWN, _MAX_MATRICES = 512, 65536
#: Scales below this leave no volume, or may become negative.
_THIN = 1e-6
_PLACE = ("translation", "rotation", "scale")


class Poses(Value):
    """The nodes of a file over time.

    Args:
        tree: The nodes, in their state at the time of reading.
        animations: Animations that change them.
    """

    def __init__(self, tree: Tree, animations: Animations) -> None:
        self._tree = tree
        self._own: dict[int, list[Channel]] = {}
        self._shown: dict[int, list[Channel]] = {}
        for node in animations.parts("nodes"):
            channels = animations.of("nodes", str(node))
            moving = [c for c in channels if c.tokens[-1] in _PLACE and len(c.tokens) == 3]
            shown = [c for c in channels if c.is_flag]
            self._own |= {node: moving} if moving else {}
            self._shown |= {node: shown} if shown else {}
        self._known: OrderedDict[tuple[int, bytes], Matrix] = OrderedDict()

    def __getstate__(self) -> dict[str, Any]:
        return super().__getstate__() | {"_known": OrderedDict()}

    @cached_property
    def _moving(self) -> set[int]:
        return self._below(self._own)

    @cached_property
    def _blinking(self) -> set[int]:
        return self._below(self._shown)

    @cached_property
    def _thin(self) -> set[int]:
        """Nodes that a scale may flatten at some time."""
        return self._below(
            {
                node
                for node, channels in self._own.items()
                if any(c.tokens[-1] == "scale" and c.track.lowest < _THIN for c in channels)
            }
        )

    def _below(self, nodes: dict[int, list[Channel]] | set[int]) -> set[int]:
        """Set of the nodes and all their descendants."""
        found, stack = set(), list(nodes)
        while stack:
            node = stack.pop()
            if node not in found:
                found.add(node)
                stack.extend(self._tree.children[node])
        return found

    def moves(self, node: int) -> bool:
        """Whether the node's transform changes."""
        return node in self._moving

    def may_be_flat(self, node: int) -> bool:
        """Whether a scale may flatten the node at some time."""
        return node in self._thin

    def blinks(self, node: int) -> bool:
        """Whether the node's visibility changes; False if something hides it at all times."""
        if node not in self._blinking:
            return False
        return all(n in self._shown or is_visible(self._tree.items[n]) for n in self._chain(node))

    def world(self, node: int, time: float) -> Matrix:
        """World from node at a time, s, shape (4, 4)."""
        return np.asarray(self.worlds(node, np.array([time]))[0])

    def worlds(self, node: int, times: FloatArray) -> Matrix:
        """World from node at many times, shape (T, 4, 4)."""
        if node not in self._moving:
            return np.asarray(np.broadcast_to(self._tree.world(node), (len(times), 4, 4)))
        moment = times.tobytes()
        chain = []
        world: Matrix | None = None  # one lookup, as other threads may remove entries
        while node in self._moving and (world := self._known.get((node, moment))) is None:
            chain.append(node)
            node = self._tree.parents[node]
        if world is None and node >= 0:
            world = self._tree.world(node)
        for below in reversed(chain):
            local = self._locals(below, times)
            world = local if world is None else world @ local
            self._tree.check_size(below, world)
            self._keep(below, moment, world)
        assert world is not None
        return world

    def _locals(self, node: int, times: FloatArray) -> Matrix:
        """Parent from node, (T, 4, 4), or (4, 4) if the node itself does not move."""
        if node not in self._own:
            return self._tree.local(node)
        moved = {c.tokens[-1]: c.track for c in self._own[node]}
        parts = (
            moved[path].many(times) if path in moved else np.broadcast_to(p, (len(times), len(p)))
            for path, p in zip(_PLACE, self._tree.parts(node), strict=True)
        )
        return compose(*parts)

    def _keep(self, node: int, moment: bytes, world: Matrix) -> None:
        most = max(min(_MAX_KNOWN, _MAX_MATRICES * 16 // max(world.size, 16)), 1)
        with suppress(KeyError):  # another thread may have emptied it
            while len(self._known) >= most:
                self._known.popitem(last=False)
        self._known[node, moment] = world

    def shown(self, node: int, time: float) -> bool:
        """Whether a node with changing visibility is shown at a time, s."""
        return all(c.track.at(time) for n in self._chain(node) for c in self._shown.get(n, ()))

    def breaks(self, node: int, begin: float, end: float) -> FloatArray:
        """Times of all keys that move the node, inside of (begin, end), s."""
        return self.breaks_of_all([node], begin, end)

    def breaks_of_all(self, nodes: Sequence[int], begin: float, end: float) -> FloatArray:
        """Times of all keys that move any of the nodes, inside of (begin, end), s."""
        chains = dict.fromkeys(n for node in nodes for n in self._chain(node))
        return breaks_of([c for n in chains for c in self._own.get(n, ())], begin, end)

    def shown_breaks(self, node: int, begin: float, end: float) -> FloatArray:
        """Times of all keys that show or hide the node, inside of (begin, end), s."""
        return breaks_of([c for n in self._chain(node) for c in self._shown.get(n, ())], begin, end)

    def depth(self, node: int) -> int:
        """Number of nodes from the root to this node, both included."""
        return len(self._chain(node))

    def _chain(self, node: int) -> list[int]:
        """The node and its ancestors."""
        chain = []
        while node >= 0:
            chain.append(node)
            node = self._tree.parents[node]
        return chain
