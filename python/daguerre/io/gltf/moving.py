"""Fills the motion of a scene with what its file animates."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.camera.camera import MOVABLE, Camera
from daguerre.files.json_item import Item
from daguerre.files.notes import Notes
from daguerre.motion.values import Dynamic
from daguerre.scene.lights import DirectionalLight, PointLight, SpotLight
from daguerre.scene.materials import Material
from daguerre.scene.scene import Scene
from daguerre.scene.transforms import ranks

from .animation import Animations
from .cameras import fields_of, read_camera
from .over_time import (
    LightOverTime,
    NodeOverTime,
    PartOverTime,
    PositionOverTime,
    RigidOverTime,
    ShownOverTime,
)
from .placing import Motion
from .poses import Poses

Matrices = NDArray[np.float64]
# Keys at which it is looked whether a scale presses something flat.
_MAX_LOOKS = 64


class MotionReader:
    """Knows what moves.

    Args:
        scene: Has the motion.
        animations: Those of the file.
        poses: Its nodes over time.
    """

    def __init__(self, scene: Scene, animations: Animations, poses: Poses) -> None:
        self._scene, self._animations, self._poses = scene, animations, poses

    def materials(self, read: Callable[[Item], Material], root: Item) -> None:
        """All materials that change."""
        items = root.list_of("materials")
        for index in self._animations.parts("materials"):
            channels = self._animations.of("materials", str(index))
            over = PartOverTime(channels, partial(read, items[index]))
            self._scene.motion.materials[index] = over

    def position(self, node: int, name: str) -> None:
        """Where a node is."""
        if self._poses.moves(node):
            place = PositionOverTime(NodeOverTime(self._poses, node))
            self._scene.motion.node_positions[name] = place

    def instances(
        self, node: int, copies: Matrices | None, worlds: Matrices, *, rigid: bool
    ) -> list[Motion] | None:
        """Motions of the instances of a mesh at a node; None: they stand still.

        Args:
            node: Index of the node.
            copies: Node from instance, (instances, 4, 4); None: one, the node itself.
            worlds: World from instance at the time of the scene.
            rigid: They do not follow the node, as a skin moves them.
        """
        moves = self._poses.moves(node) and not rigid
        blinks = self._poses.blinks(node)
        if not moves and not blinks:
            return None
        found = []
        for k, world in enumerate(worlds):
            place = NodeOverTime(self._poses, node, None if copies is None else copies[k])
            thin = moves and (self._poses.may_be_flat(node) or ranks(world[None, :3, :3])[0] < 3)
            shown = ShownOverTime(place, blinks, thin) if blinks or thin else None
            if thin and self._is_flat(place):
                found.append(Motion(None, shown, place))
            else:
                found.append(Motion(place if moves else None, shown))
        return found

    def _is_flat(self, place: NodeOverTime) -> bool:
        """Whether it is a plane at some key, and not only on its way from one to another."""
        times = place.breaks(-np.inf, np.inf)
        some = np.array([self._scene.time, *times[:: 1 + len(times) // _MAX_LOOKS]])
        return bool((ranks(place.many(some)[:, :3, :3]) == 2).any())

    def camera(self, camera: Camera, item: Item, node: Item) -> Camera:
        """The camera at a node, with what changes of it."""
        motion: dict[str, Dynamic] = {}
        if self._poses.moves(int(node.key)):
            motion["transform"] = RigidOverTime(NodeOverTime(self._poses, int(node.key)), node)
        channels = self._animations.of("cameras", str(item.key))
        for channel in channels:
            for name in fields_of(channel.tokens):
                if name in MOVABLE and getattr(camera, name) is not None:
                    read = partial(_parameter, item, camera.transform, name)
                    motion[name] = PartOverTime(channels, read)
        return replace(camera, motion=motion) if motion else camera

    def light(
        self, read: Callable[[], PointLight | SpotLight | DirectionalLight], item: Item, node: int
    ) -> LightOverTime | None:
        """A light and its transform over time; None if nothing of it changes."""
        channels = self._animations.of("extensions", "KHR_lights_punctual", "lights", str(item.key))
        poses = self._poses
        if not (channels or poses.moves(node) or poses.blinks(node)):
            return None
        return LightOverTime(NodeOverTime(poses, node), PartOverTime(channels, read))


def _parameter(item: Item, transform: Matrices, name: str) -> Any:
    return getattr(read_camera(item, transform, Notes()), name)
