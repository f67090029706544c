"""Motion of a scene, beside the plain lists that show one moment of it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, fields, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .motion import Dynamic

if TYPE_CHECKING:
    from .scene import Scene


@dataclass(frozen=True)
class Vertices:
    """The vertices of a mesh at a time.

    Attributes:
        positions: Shape (N, 3), m.
        normals: Shape (N, 3), or None where the mesh has none.
        tangents: Shape (N, 4), likewise.
        uv: Shape (N, 2), likewise. This, ``uv1`` and ``colors`` may differ from picture to picture,
            but do not change while a shutter is open.
        uv1: Shape (N, 2).
        colors: Shape (N, 4).
    """

    positions: NDArray[np.float32]
    normals: NDArray[np.float32] | None = None
    tangents: NDArray[np.float32] | None = None
    uv: NDArray[np.float32] | None = None
    uv1: NDArray[np.float32] | None = None
    colors: NDArray[np.float32] | None = None


@dataclass
class SceneMotion:
    """Values over time, by the index of what they belong to; what is absent stays.

    Attributes:
        instances: World from local, (4, 4).
        shown: Whether an instance is there, true or false.
        meshes: ``Vertices``.
        materials: ``Material``.
        lights: (light, its transform).
        environment: ``Environment``.
        node_positions: World position (m) of a node, by its name.
    """

    instances: dict[int, Dynamic] = field(default_factory=dict)
    shown: dict[int, Dynamic] = field(default_factory=dict)
    meshes: dict[int, Dynamic] = field(default_factory=dict)
    materials: dict[int, Dynamic] = field(default_factory=dict)
    lights: dict[int, Dynamic] = field(default_factory=dict)
    environment: Dynamic | None = None
    node_positions: dict[str, Dynamic] = field(default_factory=dict)

    def __bool__(self) -> bool:
        return any(getattr(self, part.name) for part in fields(self))

    def parts(self) -> Iterator[tuple[str, Dynamic]]:
        """All that changes, each with a name such as ``instances 3``."""
        for part in fields(self):
            value = getattr(self, part.name)
            if isinstance(value, dict):
                yield from ((f"{part.name} {key}", one) for key, one in value.items())
            elif value is not None:
                yield part.name, value


def scene_at(scene: Scene, time: float) -> Scene:
    """The scene with its lists evaluated anew; its motion is shared, and what stays, too."""
    motion = scene.motion
    moved: dict[str, Any] = {
        "materials": _replaced(scene.materials, motion.materials, time),
        "lights": _replaced(scene.lights, motion.lights, time),
        "cameras": {name: camera.moved_to(time) for name, camera in scene.cameras.items()},
    }
    meshes = list(scene.meshes)
    for i, vertices in motion.meshes.items():
        meshes[i] = replace(meshes[i], **vars(vertices.at(time)))
    instances = list(scene.instances)
    for i, transform in motion.instances.items():
        instances[i] = replace(instances[i], transform=transform.at(time))
    for i, shown in motion.shown.items():
        instances[i] = replace(instances[i], shown=bool(shown.at(time)))
    positions = dict(scene.node_positions)
    for name, position in motion.node_positions.items():
        positions[name] = position.at(time)
    if motion.environment is not None:
        moved["environment"] = motion.environment.at(time)
    return replace(
        scene, time=time, meshes=meshes, instances=instances, node_positions=positions, **moved
    )


def _replaced(values: list[Any], motion: dict[int, Dynamic], time: float) -> list[Any]:
    new = list(values)
    for i, value in motion.items():
        new[i] = value.at(time)
    return new
