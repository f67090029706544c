"""Moving parts of a scene in the core's form, over the interval of one picture."""

from __future__ import annotations

from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core
from daguerre.checks import freeze_in_place, given_matrix
from daguerre.errors import InputError, core_errors
from daguerre.motion.resample import resample_shown, resample_transform
from daguerre.motion.subdivision import MAX_BREAKS, MAX_KEYS
from daguerre.motion.values import Dynamic, Keys, Spin
from daguerre.scene.motion import Vertices
from daguerre.scene.parts import Instance, Mesh, reach_of, vertices_of
from daguerre.scene.scene import Scene

from .vertices import MAX_STEPS, resample_vertices, same_array

FloatArray = NDArray[np.float64]
#: Maximum number of a file's keys that are used, for all transforms together. Each keeps at least a
#: few, or none if even that is too much work: halving then finds the motion, less exactly.
MAX_ALL_BREAKS = 1 << 18
_MIN_BREAKS = 8


class MovingParts:
    """The moving parts of a scene over an interval.

    Args:
        scene: Scene with the motion.
        interval: Begin and end, s.
        notes: List that gets a sentence for each error bound that is missed.
    """

    def __init__(self, scene: Scene, interval: tuple[float, float], notes: list[str]) -> None:
        self._scene, self.interval, self.notes = scene, interval, notes
        self._corners: dict[int, FloatArray] = {}
        self._crowded: list[tuple[str, int, int]] = []
        # A part at the end of a long chain costs as much as the whole of it.
        work = sum(getattr(d, "weight", 1) for d in scene.motion.instances.values())
        shared = MAX_ALL_BREAKS // max(1, work)
        self._most = max(_MIN_BREAKS, min(MAX_BREAKS, shared)) if shared else 0

    def vertices(self, index: int) -> Vertices:
        """Vertices of a mesh: at one moment, (N, ...), or at even steps, (S, N, ...)."""
        mesh = self._scene.meshes[index]
        dynamic = self._scene.motion.meshes.get(index)
        if dynamic is None:
            return vertices_of(mesh)
        steps, keeps = resample_vertices(dynamic, *self.interval)
        if not keeps:
            self.notes.append(
                f"mesh {mesh.name or index!r} moves too unevenly for {MAX_STEPS} steps: "
                f"{len(steps)} steps approximate it"
            )
        if len(steps) == 1:
            return steps[0]
        for name in ("uv", "uv1", "colors"):
            if not all(same_array(getattr(s, name), getattr(steps[0], name)) for s in steps):
                raise InputError(
                    f"mesh {mesh.name or index!r}: {name}: changes while the shutter is open, "
                    "which cannot be blurred; keep it constant, or set shutter_time=0"
                )
        moved = {name: _stacked(steps, name) for name in ("positions", "normals", "tangents")}
        return replace(steps[0], **moved)

    def transform(self, index: int) -> Any:
        """World from local of an instance, (4, 4), or a motion of the core."""
        instance = self._scene.instances[index]
        dynamic = self._scene.motion.instances.get(index)
        if dynamic is None:
            return instance.transform
        begin, end = self.interval
        if begin == end:  # a motion all the same: it may have no inverse now, and then is not there
            return _core.Motion.still(given_matrix(dynamic.at(begin), _where(instance, index)))
        if isinstance(dynamic, Keys | Spin):  # as they were meant, without a key too many
            return dynamic.motion
        return self._resampled(dynamic, instance, index)

    def _resampled(self, dynamic: Dynamic, instance: Instance, index: int) -> _core.Motion:
        if instance.mesh not in self._corners:
            self._corners[instance.mesh] = corners(self._scene.meshes[instance.mesh])
        box, where = self._corners[instance.mesh], _where(instance, index)
        try:
            self._count(dynamic, where, self._most)
        except TypeError as error:  # its breaks are no list
            raise InputError(f"{where}: transform: {error}") from None
        with core_errors(InputError, f"{where}: transform"):
            return resample_transform(dynamic, *self.interval, box, self._most, where)

    def _count(self, dynamic: Dynamic, where: str, most: int) -> None:
        many = len(dynamic.breaks(*self.interval))
        if many > most:
            self._crowded.append((where, many, most))

    def finish(self) -> None:
        """Adds one note about parts with more keys than are used."""
        motion = self._scene.motion
        kinds = {"shown": motion.shown, "material": motion.materials, "light": motion.lights}
        for kind, dynamics in kinds.items():
            for i, dynamic in dynamics.items():
                where = f"{kind} {i}" if kind != "shown" else f"instance {i}: shown"
                self._count(dynamic, where, MAX_KEYS if kind == "shown" else MAX_BREAKS)
        if motion.environment is not None:
            self._count(motion.environment, "environment", MAX_BREAKS)
        if self._crowded:
            where, many, most = self._crowded[0]
            others = len(self._crowded) - 1
            self.notes.append(
                f"{where} has {many} keys while the shutter is open; at most {most} are used"
                + (f" ({others} others likewise)" if others else "")
            )

    def shown(self, index: int) -> list[tuple[float, float]] | None:
        """Intervals in which an instance is visible, s; None: always."""
        dynamic = self._scene.motion.shown.get(index)
        if dynamic is None:
            return None if self._scene.instances[index].shown else []
        begin, end = self.interval
        found = resample_shown(dynamic, begin, end)
        # The last moment belongs to the picture, and the end of a stretch does not belong to it.
        held = [(a, b if b < end else np.inf) for a, b in found]
        return None if held == [(begin, np.inf)] else held


def _stacked(steps: list[Vertices], name: str) -> Any:
    """Stacks the arrays of all steps; None if a step has none."""
    arrays = [getattr(step, name) for step in steps]
    return None if any(a is None for a in arrays) else freeze_in_place(np.stack(arrays))


def corners(mesh: Mesh) -> FloatArray:
    """Corners of the box around a mesh, shape (8, 3), m."""
    if not len(mesh.positions):
        return np.zeros((8, 3))
    reach = reach_of(mesh)
    ends = mesh.positions.min(axis=0) - reach, mesh.positions.max(axis=0) + reach
    found = [[ends[k[i]][i] for i in range(3)] for k in product((0, 1), repeat=3)]
    return np.array(found, float) + mesh.origin


def _where(instance: Instance, index: int) -> str:
    return f"instance {instance.name or index!r}"
