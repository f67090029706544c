"""Motion of a scene; the scene's own lists hold one moment of it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, fields

import numpy as np
from numpy.typing import NDArray

from daguerre.files.value import FixedArrays, Value
from daguerre.motion.values import Dynamic


@dataclass(frozen=True, eq=False)
class Vertices(FixedArrays):
    """The vertices of a mesh at a time.

    Attributes:
        positions: Shape (N, 3), m.
        normals: Shape (N, 3), or None if the mesh has none.
        tangents: Shape (N, 4), or None.
        uv: Shape (N, 2), or None. ``uv``, ``uv1`` and ``colors`` may differ from picture to
            picture, but must not change while the shutter is open.
        uv1: Shape (N, 2).
        colors: Shape (N, 4).
    """

    positions: NDArray[np.float32]
    normals: NDArray[np.float32] | None = None
    tangents: NDArray[np.float32] | None = None
    uv: NDArray[np.float32] | None = None
    uv1: NDArray[np.float32] | None = None
    colors: NDArray[np.float32] | None = None


@dataclass(eq=False)
class SceneMotion(Value):
    """Values over time, by the index of their owner; owners without an entry do not change.

    Attributes:
        instances: World from local, shape (4, 4), by index of the instance.
        shown: Visibility, true or false, by index of the instance.
        meshes: ``Vertices`` by index of the mesh.
        materials: ``Material`` by index.
        lights: Pairs (light, its transform) by index of the light.
        environment: ``Environment``.
        node_positions: World position (m) by name of the node.
    """

    instances: dict[int, Dynamic] = field(default_factory=dict)
    shown: dict[int, Dynamic] = field(default_factory=dict)
    meshes: dict[int, Dynamic] = field(default_factory=dict)
    materials: dict[int, Dynamic] = field(default_factory=dict)
    lights: dict[int, Dynamic] = field(default_factory=dict)
    environment: Dynamic | None = None
    node_positions: dict[str, Dynamic] = field(default_factory=dict)

    __hash__ = None  # type: ignore[assignment]  # it changes

    def __bool__(self) -> bool:
        return any(getattr(self, part.name) for part in fields(self))

    def parts(self) -> Iterator[tuple[str, Dynamic]]:
        """All values over time, each with a name such as ``instances 3``."""
        for part in fields(self):
            value = getattr(self, part.name)
            if isinstance(value, dict):
                yield from ((f"{part.name} {key}", one) for key, one in value.items())
            elif value is not None:
                yield part.name, value
