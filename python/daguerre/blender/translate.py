"""Translates Blender's scene to a ``Scene``: joins geometry, materials, lights and cameras."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from daguerre.camera.camera import Camera
from daguerre.files.notes import Notes, Silence
from daguerre.motion.values import keys
from daguerre.scene.limits import check_size
from daguerre.scene.scene import Scene

from . import materials
from .cameras import camera_of
from .frames import metres_per_unit, world_from_blender
from .hair import Hair
from .lights import add_light, note_visibility
from .meshes import Materials, Meshes
from .motion import FrameSet, Motion, exposure_of, motion_of
from .objects import UNDRAWN, Seen, descendants, walk
from .over_time import move_lights, moving_camera
from .particles import ParticleHair
from .placing import Placing
from .world import set_world

if TYPE_CHECKING:
    import bpy


Matrix = NDArray[np.float64]


@dataclass(frozen=True)
class Rooms:
    """Translators of parts.

    Attributes:
        materials: Makes the materials of a scene.
        add_light: Adds a light: (scene, world from light, ``bpy.types.Light``, name, notes).
        set_world: Sets the light from infinity: (scene, ``bpy.types.World``, notes).
        camera_of: Makes a camera: (object, ``bpy.types.RenderSettings``, world from camera, notes).
    """

    materials: Callable[[Scene, Notes], Materials]
    add_light: Callable[[Scene, Matrix, Any, str, Notes], None]
    set_world: Callable[[Scene, Any, Notes], None]
    camera_of: Callable[[Any, Any, Matrix, Notes], Camera]


def rooms(unit_m: float) -> Rooms:
    """Translators of this package, for scenes with a unit of this length, m."""
    lamps = partial(add_light, metres_per_unit=unit_m)
    return Rooms(materials.Materials, lamps, set_world, camera_of)


def scene_of(
    depsgraph: bpy.types.Depsgraph,
    *,
    time: float = 0.0,
    shutter: tuple[float, float] | None = None,
    frame_set: FrameSet | None = None,
    by: Rooms | None = None,
) -> Scene:
    """Translates the scene of a dependency graph at its frame.

    Args:
        depsgraph: Evaluated ``bpy.types.Depsgraph``.
        time: Time of the frame, s.
        shutter: When the shutter opens and closes, s from the frame, for motion between; both 0:
            nothing moves. Default: the exposure of the scene's camera.
        frame_set: Goes to a frame and a fraction; default: ``Scene.frame_set``. Inside of a render
            pass ``RenderEngine.frame_set``.
        by: Translators of parts; default: the translators of this package.

    Returns:
        The scene; its warnings name the unsupported content.

    Raises:
        InputError: Something has numbers that cannot be drawn; the message names it.
    """
    scene, notes = Scene(time=time), Notes()
    work = _Translation(scene, depsgraph, by or rooms(metres_per_unit(depsgraph.scene)), notes)
    shot = depsgraph.scene_eval
    opened = exposure_of(shot, shot.camera) if shutter is None else shutter
    if opened is not None and opened[1] > opened[0]:
        work.motion = motion_of(depsgraph, opened, time, work.probe, notes, frame_set)
    for seen in walk(depsgraph):
        work.add(seen)
    work.finish()
    scene.note(*notes.sentences())
    return scene


class _Translation:
    """One translation of a dependency graph.

    Args:
        scene: Receives everything.
        depsgraph: Evaluated.
        by: Translators of parts.
        notes: Receives notes.
    """

    def __init__(
        self, scene: Scene, depsgraph: bpy.types.Depsgraph, by: Rooms, notes: Notes
    ) -> None:
        self.motion = Motion()
        self._scene, self._depsgraph = scene, depsgraph
        self._by, self._notes = by, notes
        materials = by.materials(scene, notes)
        self._meshes, self._hair = Meshes(scene, materials, notes), Hair(scene, materials, notes)
        rendering = depsgraph.mode == "RENDER"
        self._fur = ParticleHair(scene, materials, notes, rendering=rendering)
        self._placing = Placing(scene, notes)
        self._base = world_from_blender(depsgraph.scene)
        self._cameras: dict[str, Camera] = {}
        self._effects: dict[str, str] = {}

    def probe(self, seen: Seen) -> Scene | Camera | None:
        """A light as a scene of its own, or a camera; None for all else."""
        world, quiet = self._base @ seen.matrix, Silence()
        if seen.object.type == "LIGHT":
            alone = Scene()
            self._by.add_light(alone, world, seen.object.data, seen.name, quiet)
            return alone
        if seen.object.type == "CAMERA" and seen.own:
            return self._by.camera_of(seen.object, self._depsgraph.scene.render, world, quiet)
        return None

    def add(self, seen: Seen) -> None:
        """Adds one thing to the scene."""
        kind, world = seen.object.type, self._base @ seen.matrix
        check_size(world, f"object {seen.name!r}: transform")
        path = self._path(seen)
        if seen.own:
            over = None if path is None else keys([(t, place[:3, 3]) for t, place in path])
            self._scene.add_node(seen.name, world[:3, 3], motion=over)
            self._note_effects(seen)
        if kind == "MESH" and seen.copy.show_particles:
            self._placing.add(self._fur.index(seen.object), seen.name, world, path)
        if kind == "CAMERA" and seen.own:
            self._add_camera(seen, world)
        elif not seen.surface:
            return
        elif kind in ("MESH", "CURVES"):
            self._add_shape(seen, world, path)
        elif kind == "LIGHT":
            self._add_light(seen, world)
        elif kind in UNDRAWN:
            self._notes.add(f"{UNDRAWN[kind]} are left out")

    def _path(self, seen: Seen) -> list[tuple[float, Matrix]] | None:
        """World from the thing over time; None: it rests."""
        moves = self.motion.matrices and self.motion.matrices.get(seen.identity)
        if not moves:
            return None
        check_size(np.array([place for _, place in moves]), f"object {seen.name!r}: transform")
        return [(t, self._base @ place) for t, place in moves]

    def _add_shape(
        self, seen: Seen, world: Matrix, path: list[tuple[float, Matrix]] | None
    ) -> None:
        steps = self.motion.points.get(seen.identity) if self.motion.points else None
        if seen.object.type == "MESH":
            parts = self._meshes.index(seen.object, steps, seen.matrix)
        else:
            parts = self._hair.index(seen.object, steps)
        self._placing.add(parts, seen.name, world, path)

    def _add_light(self, seen: Seen, world: Matrix) -> None:
        scene = self._scene
        first = len(scene.lights), len(scene.instances)
        self._by.add_light(scene, world, seen.object.data, seen.name, self._notes)
        note_visibility(seen.object, self._notes)
        moments = self.motion.probed.get(seen.identity) if self.motion.probed else None
        if moments and not move_lights(scene, first, moments):
            self._notes.add(
                "a light that changes its kind while the shutter is open is drawn without motion"
            )

    def _add_camera(self, seen: Seen, world: Matrix) -> None:
        render = self._depsgraph.scene.render
        camera = self._by.camera_of(seen.object, render, world, self._notes)
        moments = self.motion.probed.get(seen.identity) if self.motion.probed else None
        if moments:
            camera = moving_camera(camera, moments, self._scene.time)
        self._cameras[seen.name] = camera

    def _note_effects(self, seen: Seen) -> None:
        thing = seen.object
        if thing.type == "LIGHT":
            return  # its flags choose the shadows that catchers take, not its appearance
        if thing.is_holdout:
            self._effects[seen.name] = "holdout"
        elif thing.is_shadow_catcher:
            self._effects[seen.name] = "shadow"
        if seen.object.type == "MESH" and not thing.visible_camera:
            self._notes.add("an object hidden from the camera only is drawn")

    def finish(self) -> None:
        """Adds instances, cameras and the world, and groups of objects below others."""
        scene, shot = self._scene, self._depsgraph.scene_eval
        self._placing.finish()
        active = shot.camera.name_full if shot.camera is not None else None
        for name in sorted(self._cameras, key=lambda name: name != active):
            scene.add_camera(name, self._cameras[name])
        self._by.set_world(scene, shot.world, self._notes)
        for name, effects in self._effects.items():
            if scene.nodes.get(name):
                scene.set_catcher(name, effects)
        own = {name: list(found) for name, found in scene.nodes.items()}
        for name, below in descendants(self._depsgraph).items():
            if name in own:
                found = [i for one in (name, *below) for i in own.get(one, ())]
                scene.group_instances(name, found)
