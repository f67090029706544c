"""Reads the hair of particle systems: strands through the points that Blender computes.

Source: Blender's Python API, ParticleSystem.co_hair and ParticleSettings (diameters of strands).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from daguerre.files.notes import Notes
from daguerre.scene.scene import Scene

from .meshes import Materials, Parts, slots_of

if TYPE_CHECKING:
    import bpy


FloatArray = NDArray[np.float64]


class ParticleHair:
    """Hair of particle systems, each added once for all copies of its object.

    Args:
        scene: Receives the curves.
        materials: Materials by slot.
        notes: Receives notes on unsupported content.
        rendering: Whether strands have the detail of renders, not of the viewport.
    """

    def __init__(
        self, scene: Scene, materials: Materials, notes: Notes, *, rendering: bool
    ) -> None:
        self._scene, self._materials, self._notes = scene, materials, notes
        self._rendering = rendering
        self._made: dict[int, Parts] = {}

    def index(self, thing: bpy.types.Object) -> Parts:
        """Pairs (mesh, material) of the hair of an evaluated object, in its own frame."""
        if not len(thing.particle_systems):
            return []
        key = thing.original.as_pointer()
        if key not in self._made:
            found = [self._add(thing, system) for system in thing.particle_systems]
            self._made[key] = [part for part in found if part is not None]
        return self._made[key]

    def _add(
        self, thing: bpy.types.Object, system: bpy.types.ParticleSystem
    ) -> tuple[int, int] | None:
        settings = system.settings
        if settings.type != "HAIR" or settings.render_type != "PATH":
            return None  # its particles are copies, or nothing
        points = self._strands(thing, system)
        if not len(points):
            return None
        if settings.shape != 0:
            self._notes.add("the shape of particle hair is drawn as an even taper")
        mesh = self._scene.add_curves(
            points.reshape(-1, 3),
            np.full(len(points), points.shape[1]),
            np.tile(_widths(settings, points.shape[1]), len(points)),
            basis="catmull-rom",
            wrap="pinned",
            name=system.name,
        )
        slots = slots_of(thing)
        slot = min(max(settings.material - 1, 0), len(slots) - 1)
        return mesh, self._materials.index(slots[slot])

    def _strands(self, thing: bpy.types.Object, system: bpy.types.ParticleSystem) -> FloatArray:
        """Points of strands in the frame of the object, shape (strands, points, 3)."""
        settings = system.settings
        parents, children = len(system.particles), len(system.child_particles)
        first = parents if children and not settings.use_parent_particles else 0
        steps = settings.render_step if self._rendering else settings.display_step
        places = [
            system.co_hair(object=thing, particle_no=strand, step=step)
            for strand in range(first, parents + children)
            for step in range((1 << steps) + 1)
        ]
        world = np.array(places, np.float64).reshape(-1, 3)
        local = np.linalg.inv(np.array(thing.matrix_world, np.float64))
        points = world @ local[:3, :3].T + local[:3, 3]
        return np.asarray(points.reshape(-1, (1 << steps) + 1, 3))


def _widths(settings: bpy.types.ParticleSettings, points: int) -> FloatArray:
    """Diameters along a strand, in units of the scene, shape (points,)."""
    widths = np.linspace(settings.root_radius, settings.tip_radius, points)
    if settings.use_close_tip:
        widths[-1] = 0
    return np.asarray(widths * settings.radius_scale)
