"""Finds the motion of parts of a glTF file."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.camera.camera import Camera
from daguerre.camera.parameters import MOVABLE
from daguerre.files.json_item import Item
from daguerre.files.notes import Notes
from daguerre.motion.values import Dynamic
from daguerre.scene.lights import DirectionalLight, PointLight, SpotLight
from daguerre.scene.materials import Material
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
# Number of keys at which flat scales are searched.
_MAX_LOOKS = 64


class MotionReader:
    """Finds motion of materials, nodes, instances, cameras and lights.

    Args:
        root: The JSON object of the file.
        animations: Animations of the file.
        poses: Nodes over time.
        time: Time of reading, s.
    """

    def __init__(self, root: Item, animations: Animations, poses: Poses, time: float) -> None:
        self._materials = root.list_of("materials")
        self._animations, self._poses, self._time = animations, poses, time

    def material(self, index: int, read: Callable[[Item], Material]) -> PartOverTime | None:
        """Material over time, read by ``read``; None: constant."""
        channels = self._animations.of("materials", str(index))
        return PartOverTime(self._materials[index], channels, read) if channels else None

    def position(self, node: int) -> PositionOverTime | None:
        """Position of a node over time; None: constant."""
        moves = self._poses.moves(node)
        return PositionOverTime(NodeOverTime(self._poses, node)) if moves else None

    def instances(
        self, node: int, copies: Matrices | None, worlds: Matrices, *, rigid: bool
    ) -> list[Motion] | None:
        """Motions of the instances of a mesh at a node; None: constant.

        Args:
            node: Index of the node.
            copies: Node from instance, (instances, 4, 4); None: one instance, the node itself.
            worlds: World from instance at the time of reading, (instances, 4, 4).
            rigid: Whether a skin moves the mesh, so that the node's transform is ignored.
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
        """Whether an instance is flat at a key, and not only between keys."""
        times = place.breaks(-np.inf, np.inf)
        looked_at = np.array([self._time, *times[:: 1 + len(times) // _MAX_LOOKS]])
        return bool((ranks(place.many(looked_at)[:, :3, :3]) == 2).any())

    def camera(self, camera: Camera, item: Item, node: Item) -> Camera:
        """Returns the camera of a node with its motion."""
        motion: dict[str, Dynamic] = {}
        if self._poses.moves(int(node.key)):
            motion["transform"] = RigidOverTime(NodeOverTime(self._poses, int(node.key)), node)
        channels = self._animations.of("cameras", str(item.key))
        for channel in channels:
            for name in fields_of(channel.tokens):
                if name in MOVABLE and getattr(camera, name) is not None:
                    read = partial(_parameter, name=name, transform=camera.transform)
                    motion[name] = PartOverTime(item, channels, read)
        return replace(camera, motion=motion) if motion else camera

    def light(
        self,
        read: Callable[[Item], PointLight | SpotLight | DirectionalLight],
        item: Item,
        node: int,
    ) -> LightOverTime | None:
        """Light and its transform over time; None: nothing changes."""
        channels = self._animations.of("extensions", "KHR_lights_punctual", "lights", str(item.key))
        poses = self._poses
        if not (channels or poses.moves(node) or poses.blinks(node)):
            return None
        return LightOverTime(NodeOverTime(poses, node), PartOverTime(item, channels, read))


def _parameter(item: Item, name: str, transform: Matrices) -> Any:
    return getattr(read_camera(item, transform, Notes()), name)
