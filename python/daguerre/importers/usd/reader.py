"""Reads stages of OpenUSD: joins stage, prims, meshes, materials, lights and cameras.

Start reading here; each other module of this folder reads one kind of prim. A fault in a file
raises an ``InputError`` with the file, the prim, the wanted value and the value found.
"""

from __future__ import annotations

import math
import os
from collections import Counter
from collections.abc import Iterable, Sequence
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from pxr import Usd, UsdGeom, UsdSkel

from daguerre.checks import numbers, short
from daguerre.errors import UsageError, suggest
from daguerre.files.notes import Notes
from daguerre.scene.over_time.operations import Matrix, Place, Transform
from daguerre.scene.packed.gathered import Gathered
from daguerre.scene.scene import Scene
from daguerre.shading.images import Images

from .bindings import Bindings
from .bound_collections import BoundCollections
from .cameras import read_camera
from .curves import read_curves
from .instancers import read_copies
from .lighting import Lighting
from .lights import is_light
from .materials import Materials
from .meshes import Meshes
from .nesting import Totals
from .placing import Placing, Spots, single, times
from .points import read_points
from .prims import PURPOSES, PrimWalk, Visit
from .shapes import SIZES, is_solid, solid_of
from .skeletons import Skeletons
from .spheres import read_spheres
from .stage import Opened, duration, open_stage, typed, usd_errors
from .stage_facts import StageFacts
from .topology import scheme_of
from .transforms import position, rigid
from .values import Moments

#: Limit of entries in all lists of ``Scene.nodes``, which grow with the depth of the tree.
_MAX_NODE_ENTRIES = 8_000_000


def read(
    path: str | os.PathLike[str],
    *,
    time: float = 0.0,
    variant: str | Sequence[str] = (),
    allow_dirs: Iterable[str | os.PathLike[str]] = (),
    purpose: Sequence[str] = ("render",),
    camera_units: float | None = None,
    moments: tuple[float, float] | None = None,
    into: Gathered | None = None,
) -> Scene:
    """Reads a stage in this process; :func:`.wall.read` has the arguments, result and errors.

    ``into`` is an empty scene to read into, which is packed at once: large arrays stay in the
    memory of the stage, its ``owner``. Default: a new scene.
    """
    if not math.isfinite(time):
        raise UsageError(f"time: wanted a finite number of seconds, got {time}")
    for name in purpose:
        if name not in PURPOSES:
            raise UsageError(
                f"purpose: wanted {', '.join(PURPOSES)}, got {name!r}{suggest(name, PURPOSES)}"
            )
    drawn = None if moments is None else _moments(moments, time)
    file, notes = Path(path), Notes()
    chosen = (variant,) if isinstance(variant, str) else tuple(variant)
    # Huge finite numbers may overflow in between; results are checked.
    with np.errstate(all="ignore"), usd_errors(str(file)):
        opened = open_stage(file, float(time), chosen, allow_dirs, notes)
        clock = replace(opened.clock, moments=drawn, borrows=into is not None)
        opened = replace(opened, clock=clock)
        made = Scene() if into is None else into
        made.path, made.time = file, float(time)
        scene = _UsdReader(opened, made, notes).read(purpose, camera_units)
    if into is not None:
        into.owner = opened.stage
    if drawn is not None and drawn.left_out:
        made.moments = drawn.begin, drawn.end
    scene.note(*notes.sentences())
    return scene


def _moments(given: tuple[float, float], time: float) -> Moments:
    begin, end = numbers(given, "moments", 2, "two times, s")
    if not begin <= time <= end:
        raise UsageError(
            f"moments: wanted an interval with the time {time:g} s, got {short(given)}"
        )
    return Moments(begin, end)


#: World from local of skeletons, by path.
Worlds = dict[str, Matrix | Transform]


class _UsdReader:
    def __init__(self, opened: Opened, scene: Scene, notes: Notes) -> None:
        self._opened, self.scene, self._notes = opened, scene, notes
        self._clock = opened.clock
        self._placing = Placing(scene, opened.file, notes)
        self._skeletons = Skeletons(opened.clock, notes)
        self._totals = Totals(opened.clock)
        self._images = images = Images(scene, opened.assets.file_of, notes)
        materials = Materials(scene, images, opened.clock, notes, opened.metres)
        collections = BoundCollections(opened.file) if opened.binds_collections else None
        self._bindings = Bindings(materials, opened.clock, notes, collections)
        self._lighting = Lighting(scene, opened, self._placing, images, notes)
        self._shapes: dict[str, int | None] = {}
        scene.set_clock(duration(opened))

    def read(self, purposes: Sequence[str], camera_millimetres: float | None) -> Scene:
        opened = self._opened
        self._walk = PrimWalk(self._clock, opened.root, purposes, self._notes)
        visits = list(self._walk.below(opened.stage.GetPseudoRoot(), opened.root))
        self._add_skeletons(visits)
        worlds = _skeleton_worlds(visits)
        with typed(opened.file, "meshes"):
            faces = self._smooth_faces(visits)
        self._meshes = Meshes(self.scene, self._clock, faces, self._notes)
        with closing(self._images), closing(self._meshes):
            firsts = self._nodes(visits, worlds)
        self._group(visits, [*firsts, len(self.scene.instances)])
        self._cameras(visits, camera_millimetres)
        self._lighting.finish()
        return self.scene

    def _add_skeletons(self, visits: list[Visit]) -> None:
        for visit in visits:
            if visit.prim.IsA(UsdSkel.Root):
                self._skeletons.add_root(visit.prim)

    def _smooth_faces(self, visits: list[Visit]) -> int:
        """Number of faces of all subdivision meshes, which share a budget of detail."""
        total, counted = 0, set()
        for visit in visits:
            if visit.prim.IsA(UsdGeom.Mesh) and visit.source not in counted:
                counted.add(visit.source)
                mesh = UsdGeom.Mesh(visit.prim)
                if scheme_of(mesh, self._clock) != "none":
                    total += len(mesh.GetFaceVertexCountsAttr().Get(self._clock.code) or ())
        return total

    def _nodes(self, visits: list[Visit], worlds: Worlds) -> list[int]:
        """Adds all nodes; returns the first instance of each. Pictures are decoded meanwhile."""
        with typed(self._opened.file, "materials"):
            self._bindings.prefetch(
                visit.prim
                for visit in visits
                if visit.prim.IsA(UsdGeom.Gprim) and visit.drawn and visit.shown is not False
            )
        firsts = []
        for visit in visits:
            firsts.append(len(self.scene.instances))
            self._node(visit, worlds)
        return firsts

    def _node(self, visit: Visit, worlds: Worlds) -> None:
        if not UsdGeom.Imageable(visit.prim) and visit.prim.GetTypeName():
            return
        motion = Place(visit.world) if isinstance(visit.world, Transform) else None
        where = position(visit.world, self.scene.time)
        self.scene.add_node(visit.name, where, motion=motion)
        if visit.shown is not False and visit.drawn:
            with typed(self._opened.file, visit.path):
                self._draw(visit, single(self._posed(visit, worlds), self.scene.time))

    def _posed(self, visit: Visit, worlds: Worlds) -> Matrix | Transform:
        """World from a prim's points: the skeleton's transform if skinned, else the prim's."""
        skeleton = self._skeletons.skeleton_of(visit.prim)
        own = visit.world
        return own if skeleton is None else worlds.get(str(skeleton.GetPath()), own)

    def _draw(self, visit: Visit, spots: Spots) -> None:
        """Draws a prim, without its children, at its places."""
        prim = visit.prim
        if is_light(prim) and not prim.IsA(UsdGeom.Gprim):
            self._lighting.add(visit, spots)
        elif prim.IsA(UsdGeom.PointInstancer):
            self._copies(visit, spots)
        elif prim.IsA(UsdGeom.Mesh):
            self._mesh(visit, spots)
        elif is_solid(prim):
            self._solid(visit, spots)
        elif prim.IsA(UsdGeom.Points):
            self._spheres(visit, spots)
        elif prim.IsA(UsdGeom.BasisCurves):
            self._curves(visit, spots)
        elif prim.IsA(UsdGeom.Gprim):
            self._notes.add(f"a prim of type {prim.GetTypeName()} is left out")

    def _copies(self, visit: Visit, spots: Spots) -> None:
        name = spots.name or visit.name
        self._placing.check(len(spots) * self._totals.of(visit.prim), visit.path)
        for copies in read_copies(visit.prim, self._clock, self._notes):
            below = list(self._walk.whole(copies.prototype, np.eye(4), visit.shown))
            self._add_skeletons(below)
            worlds = _skeleton_worlds(below)
            for inner in below:
                if inner.shown is False or not inner.drawn or not UsdGeom.Imageable(inner.prim):
                    continue
                world = self._posed(inner, worlds)
                self._draw(inner, times(spots, copies, world, name, self.scene.time))

    def _mesh(self, visit: Visit, spots: Spots) -> None:
        prim, source = visit.prim, visit.source
        source += self._skeletons.animation_of(prim)
        faces = len(UsdGeom.Mesh(prim).GetFaceVertexCountsAttr().Get(self._clock.code) or ())

        def points() -> Any:
            found = read_points(UsdGeom.Mesh(prim), self._clock, self._notes)
            return self._skeletons.skinned(prim, found), found

        found = []
        for part in self._bindings.parts(prim, faces):
            mesh = self._meshes.index(source, prim, points, part.choice, part.faces)
            if mesh is not None:
                found.append((mesh, part.material))
        for mesh, material in found:
            if is_light(prim):
                meshes = [mesh for mesh, _ in found]
                material = self._lighting.glowing(visit, spots, meshes, material)
            self._placing.add(mesh, material, spots, visit.name, visit.shown)

    def _solid(self, visit: Visit, spots: Spots) -> None:
        if visit.source not in self._shapes:
            self._shapes[visit.source] = self._add_solid(visit.prim)
        mesh = self._shapes[visit.source]
        if mesh is not None:
            material = self._bindings.whole(visit.prim)
            if is_light(visit.prim):
                material = self._lighting.glowing(visit, spots, [mesh], material)
            self._placing.add(mesh, material, spots, visit.name, visit.shown)

    def _add_solid(self, prim: Usd.Prim) -> int | None:
        solid = solid_of(prim, self._clock)
        if solid is None:
            return None
        if any(
            prim.GetAttribute(name).ValueMightBeTimeVarying()
            for name in SIZES
            if prim.HasAttribute(name)
        ):
            self._notes.add(
                "a solid whose size changes over time keeps its size at the scene's time"
            )
        return self.scene.add_mesh(
            solid.positions, solid.triangles, solid.normals, solid.uv, name=str(prim.GetPath())
        )

    def _spheres(self, visit: Visit, spots: Spots) -> None:
        read_spheres(visit, spots, self.scene, self._bindings, self._placing, self._notes)

    def _curves(self, visit: Visit, spots: Spots) -> None:
        if visit.source not in self._shapes:
            colored = not self._bindings.bound(visit.prim)
            self._shapes[visit.source] = read_curves(
                visit.prim, self.scene, self._clock, self._notes, colored=colored
            )
        mesh = self._shapes[visit.source]
        if mesh is not None:
            colored = self.scene.meshes[mesh].colors is not None
            material = self._bindings.whole(visit.prim, colored=colored)
            self._placing.add(mesh, material, spots, visit.name, visit.shown)

    def _cameras(self, visits: list[Visit], millimetres: float | None) -> None:
        opened = self._opened
        facts = StageFacts(
            opened.file,
            self._clock,
            opened.metres,
            millimetres,
            opened.assets.file_of,
            fps=opened.fps,
        )
        found = [visit for visit in visits if visit.prim.IsA(UsdGeom.Camera)]
        names = Counter(visit.prim.GetName() for visit in found)
        for visit in found:
            world = rigid(visit.world)
            if world is None:
                self._notes.add("a camera that is scaled to zero is left out")
                continue
            camera = read_camera(visit.prim, world, facts, self._notes)
            if camera is not None:
                base = str(visit.prim.GetName())
                name = base if names[base] == 1 else visit.name.replace("/", ".")
                self.scene.add_camera(name, camera, alias=visit.path)

    def _group(self, visits: list[Visit], firsts: list[int]) -> None:
        """Groups instances of each node and its descendants, which are contiguous."""
        waiting: list[tuple[int, int]] = []
        left = _MAX_NODE_ENTRIES
        for i, visit in enumerate([*visits, None]):
            depth = 0 if visit is None else visit.depth
            while waiting and waiting[-1][1] >= depth:
                start, _ = waiting.pop()
                found = range(firsts[start], firsts[i])
                left -= len(found)
                if left < 0:
                    self._notes.add(
                        "the name of a prim high in the tree selects its own meshes only"
                    )
                elif visits[start].name in self.scene.nodes:
                    self.scene.group_instances(visits[start].name, found)
            waiting.append((i, depth))


def _skeleton_worlds(visits: list[Visit]) -> Worlds:
    return {visit.path: visit.world for visit in visits if visit.prim.IsA(UsdSkel.Skeleton)}
