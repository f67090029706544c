"""Reads scenes of Mitsuba: joins objects of the file, shapes, materials, lights, media, cameras.

Start reading here; each other module of this folder reads one kind of object. A fault in a file
raises an ``InputError`` with the file, the line, the element, the wanted value and the value found.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterable, Mapping
from contextlib import closing
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import UsageError
from daguerre.files.notes import Notes
from daguerre.scene.framing import bounds
from daguerre.scene.scene import Scene

from .context import Context
from .document import Document
from .emitters import Emitters
from .files import Files
from .ledger import Ledger
from .materials import Materials
from .media import Media
from .node import Node, leave_out, unread
from .parameters import defined
from .placing import Placing
from .sensors import PERSPECTIVE, read_camera
from .settings import Settings, depth_of, settings_of
from .textures import Textures
from .transforms import mirrors


def read(
    path: str | os.PathLike[str],
    *,
    time: float = 0.0,
    define: Iterable[str] | Mapping[str, object] = (),
    unit_m: float = 1.0,
    allow_dirs: Iterable[str | os.PathLike[str]] = (),
) -> Scene:
    """Reads a scene of Mitsuba: .xml.

    Args:
        path: The file.
        time: Scene time, s.
        define: Values of the file's parameters, as ``name=value`` or by name.
        unit_m: Length of a unit of the scene, m.
        allow_dirs: Folders, besides the scene's own, from which it may read files.

    Returns:
        The scene; ``warnings`` has notes on unsupported content.

    Raises:
        InputError: The file cannot be read or is invalid.
        UsageError: The file has no parameter of a name, or the unit is no length.
    """
    scene, _, _ = read_all(path, time=time, define=define, unit_m=unit_m, allow_dirs=allow_dirs)
    return scene


def read_all(
    path: str | os.PathLike[str],
    *,
    time: float = 0.0,
    define: Iterable[str] | Mapping[str, object] = (),
    unit_m: float = 1.0,
    allow_dirs: Iterable[str | os.PathLike[str]] = (),
) -> tuple[Scene, dict[str, Settings], Ledger]:
    """Reads a scene with the settings of each camera and the accounts of its elements.

    See :func:`read` for arguments and errors.
    """
    if not math.isfinite(time):
        raise UsageError(f"time: wanted a finite number of seconds, got {time}")
    if not 1e-9 <= unit_m <= 1e9:
        raise UsageError(f"unit_m: wanted a length of 1e-9 to 1e9 m, got {unit_m}")
    file, notes = Path(path), Notes()
    document = Document(file, Files(file, allow_dirs), defined(define))
    scene = Scene(path=file, time=float(time))
    # Huge finite numbers may overflow in between; results are checked.
    with np.errstate(all="ignore"):
        context = Context(document, scene, float(unit_m), notes, _mirrored(document.root))
        settings = _MitsubaReader(context).read()
    scene.note(*notes.sentences())
    return scene, settings, document.ledger


def _mirrored(root: Node) -> bool:
    """Whether the first camera that can be used is mirrored."""
    nodes = (node for _, node in root.objects("sensor") if node.plugin in PERSPECTIVE)
    first = next(nodes, None)
    return first is not None and mirrors(first.transform())


class _MitsubaReader:
    def __init__(self, context: Context) -> None:
        self._context, self._scene, self._notes = context, context.scene, context.notes
        self._textures = Textures(context)
        self._media = Media(context, self._textures)
        self._emitters = Emitters(context, self._textures)
        materials = Materials(context, self._textures)
        self._placing = Placing(context, materials, self._media, self._textures)

    def read(self) -> dict[str, Settings]:
        """Reads all objects; returns the settings of the cameras by name."""
        root = self._context.document.root
        with closing(self._textures.images):
            for _, node in root.objects("shape"):
                self._placing.add(node)
            for _, node in root.objects("emitter"):
                self._emitters.add(node)
            settings = self._cameras(root)
        for _, node in root.objects("subsurface"):
            leave_out(node, self._notes, f"a {node.kind} {node.plugin[:40]!r} is left out")
        unread(root, self._notes)
        return settings

    def _cameras(self, root: Node) -> dict[str, Settings]:
        """Adds cameras; notes the flags that render with the film and sampler of the first."""
        depth = depth_of(root, self._notes)
        made: dict[str, Settings] = {}
        for i, (_, node) in enumerate(root.objects("sensor")):
            if node.plugin not in PERSPECTIVE:
                what = f"a sensor {node.plugin[:40]!r} is left out: no lens has its projection"
                leave_out(node, self._notes, what)
                continue
            name = node.id or (f"sensor.{i + 1}" if i else "sensor")
            made[name] = settings_of(node, depth, self._notes)
            self._camera(node, made[name], name)
        if made:
            first = next(iter(made.values()))
            self._scene.note(f"flags for the file's film and sampler: {first.flags()}")
        return made

    def _camera(self, node: Node, settings: Settings, name: str) -> None:
        context = self._context
        node.use()
        camera = read_camera(node, context.world, settings, self._notes)
        self._scene.add_camera(name, camera, film_size=settings.resolution)
        far = node.number("far_clip", 1e4, above=0) * context.unit_m
        if node.has("far_clip") and farthest(self._scene, camera.transform[:3, 3]) > far:
            self._notes.add("far_clip of a sensor is ignored")
        fog = self._media.around(node.nested_one("medium"))
        if fog is not None:
            self._scene.set_fog(fog)


def farthest(scene: Scene, eye: NDArray[np.float64]) -> float:
    """Distance from a point to the farthest corner of the box around a scene, m."""
    corners = bounds(scene)
    if corners is None:
        return 0.0
    return float(np.linalg.norm(np.maximum(*(np.abs(corner - eye) for corner in corners))))
