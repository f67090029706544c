"""Animated parts of a glTF file as values over time.

Each evaluation calls a reader on a copy of its part of the file at that time, so that everything
that a reader supports can be animated. Evaluations write nothing, so threads may share them; none
refers to the whole file, so that a scene can be pickled.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.files.json_item import Item
from daguerre.files.value import Value
from daguerre.scene.lights import DirectionalLight, Light, PointLight, SpotLight
from daguerre.scene.motion import Vertices
from daguerre.scene.transforms import Matrix, ranks, without_scale

from .animation import Channel, breaks_of, played
from .poses import Poses

FloatArray = NDArray[np.float64]
_BLACK = (0.0, 0.0, 0.0)
_NONE = np.zeros(0)


@dataclass(frozen=True, eq=False)
class PartOverTime(Value):
    """Result of a reader over time, such as a material or a parameter of a camera.

    Attributes:
        item: Part of the file, in its state at the time of reading.
        channels: Channels that change it.
        read: Reader of the part; it can be pickled.
    """

    item: Item
    channels: Sequence[Channel]
    read: Callable[[Item], Any]

    def at(self, time_s: float) -> Any:
        """Reads the part in its state at a time, s."""
        value = played(self.item.value, self.channels, time_s)
        with np.errstate(all="ignore"):
            return self.read(self.item.holding(value))

    def breaks(self, begin: float, end: float) -> FloatArray:
        """Times of the keys."""
        return breaks_of(self.channels, begin, end)


@dataclass(frozen=True, eq=False)
class NodeOverTime(Value):
    """World from node, or world from an object in the node, over time.

    Attributes:
        poses: The nodes of the file.
        node: Index of the node.
        local: Node from object, (4, 4); None: the identity.
    """

    poses: Poses
    node: int
    local: Matrix | None = None

    def at(self, time_s: float) -> Matrix:
        """The transform at a time, s, (4, 4)."""
        return np.asarray(self.many(np.array([time_s]))[0])

    @property
    def weight(self) -> int:
        """Cost of an evaluation: number of nodes up to the root."""
        return self.poses.depth(self.node)

    def many(self, times: FloatArray) -> Matrix:
        """Transforms at many times, (T, 4, 4)."""
        worlds = self.poses.worlds(self.node, times)
        return worlds if self.local is None else worlds @ self.local

    def breaks(self, begin: float, end: float) -> FloatArray:
        """Times of the keys."""
        return self.poses.breaks(self.node, begin, end)


@dataclass(frozen=True, eq=False)
class RigidOverTime(Value):
    """Rigid transform of a camera over time, without the scale of its node.

    Attributes:
        node: Transform of its node.
        item: The node, for messages.
    """

    node: NodeOverTime
    item: Item

    def at(self, time_s: float) -> Matrix:
        """The transform at a time, s, (4, 4)."""
        rigid = without_scale(self.node.at(time_s))
        if rigid is None:
            self.item.fail(f"the node scales its camera by 0 at {time_s:g} s")
        return rigid

    def breaks(self, begin: float, end: float) -> FloatArray:
        """Times of the keys."""
        return self.node.breaks(begin, end)


@dataclass(frozen=True, eq=False)
class PositionOverTime(Value):
    """Position of a node over time."""

    node: NodeOverTime

    def at(self, time_s: float) -> Matrix:
        """The position at a time, s, (3,), m."""
        return self.node.at(time_s)[:3, 3].copy()

    def breaks(self, begin: float, end: float) -> FloatArray:
        """Times of the keys."""
        return self.node.breaks(begin, end)


@dataclass(frozen=True, eq=False)
class ShownOverTime(Value):
    """Whether a mesh is shown: its node is visible (KHR_node_visibility) and not scaled to nothing.

    Attributes:
        node: Transform of its node.
        blinks: Whether the node's visibility changes.
        vanishes: Whether the scale may be 0.
    """

    node: NodeOverTime
    blinks: bool
    vanishes: bool

    def at(self, time_s: float) -> bool:
        """Whether the mesh is shown at a time, s."""
        if self.blinks and not self.node.poses.shown(self.node.node, time_s):
            return False
        return not self.vanishes or bool(ranks(self.node.at(time_s)[None, :3, :3])[0] >= 2)

    def breaks(self, begin: float, end: float) -> FloatArray:
        """Times of the keys of visibility and scale."""
        poses, node = self.node.poses, self.node.node
        shown = poses.shown_breaks(node, begin, end) if self.blinks else _NONE
        moved = self.node.breaks(begin, end) if self.vanishes else _NONE
        return np.union1d(shown, moved)


@dataclass(frozen=True, eq=False)
class FlatOverTime(Value):
    """A mesh that its node flattens; its vertices are in the world, as there is no inverse."""

    node: NodeOverTime
    mesh: Vertices

    def at(self, time_s: float) -> Vertices:
        """Vertices in the world at a time, s."""
        world = self.node.at(time_s)
        points = self.mesh.positions @ world[:3, :3].T + world[:3, 3]
        return replace(self.mesh, positions=points.astype(np.float32))

    def breaks(self, begin: float, end: float) -> FloatArray:
        """Times of the keys."""
        return self.node.breaks(begin, end)


@dataclass(frozen=True, eq=False)
class LightOverTime(Value):
    """A light and its transform over time; it is off if its node is hidden or scaled to nothing.

    Attributes:
        node: Transform of its node.
        part: The light itself.
    """

    node: NodeOverTime
    part: PartOverTime

    def at(self, time_s: float) -> tuple[Light, Matrix]:
        """The light and its transform (4, 4) at a time, s."""
        light, poses = self.part.at(time_s), self.node.poses
        rigid = without_scale(self.node.at(time_s))
        if rigid is None or (
            poses.blinks(self.node.node) and not poses.shown(self.node.node, time_s)
        ):
            light = dark(light)
        return light, np.eye(4) if rigid is None else rigid

    def breaks(self, begin: float, end: float) -> FloatArray:
        """Times of all keys."""
        poses, node = self.node.poses, self.node.node
        nodes = np.union1d(poses.breaks(node, begin, end), poses.shown_breaks(node, begin, end))
        return np.union1d(self.part.breaks(begin, end), nodes)


def dark(light: PointLight | SpotLight | DirectionalLight) -> Light:
    """Returns the light, switched off."""
    if isinstance(light, DirectionalLight):
        return replace(light, illuminance=_BLACK)
    return replace(light, intensity=_BLACK)
