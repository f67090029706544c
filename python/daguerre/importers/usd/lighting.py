"""Adds lights to the scene: lamps, meshes that emit, and the environment."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import UsdLux

from daguerre.errors import InputError
from daguerre.files.notes import Notes
from daguerre.motion.values import MAX_TIME, is_dynamic
from daguerre.scene.light_profile import LightProfile
from daguerre.scene.lights import DirectionalLight, PointLight, SphereLight
from daguerre.scene.materials import Diffuse, Gltf, Material, TextureSlot
from daguerre.scene.over_time.operations import Rigid
from daguerre.scene.scene import Scene
from daguerre.scene.shapes import ShapeMesh
from daguerre.scene.transforms import without_scale
from daguerre.shading.images import Images
from daguerre.shading.picture_bytes import is_known

from .domes import Dome, is_dome, is_latlong, read_panorama, set_environment, turn_of
from .light_shapes import area, cylinder, disk, rectangle
from .lights import Lamp, cone_size, times
from .placing import Placing, Spots
from .prims import Visit
from .shapes import ball
from .shaping import is_shaped, read_profile
from .stage import Opened

Matrix = NDArray[np.float64]
Make = Callable[[Visit, Spots, Lamp], None]
_BLACK = Diffuse((0.0, 0.0, 0.0))
_DARK = (0.0, 0.0, 0.0)
#: Keys of a moving lamp that are looked at for a change of its scale.
_SOME_KEYS = 100


class Lighting:
    """Lights of a stage.

    Args:
        scene: Receives the lights.
        opened: The stage.
        placing: Places meshes.
        images: Pictures of the stage.
        notes: Receives notes on unsupported content.
    """

    def __init__(
        self, scene: Scene, opened: Opened, placing: Placing, images: Images, notes: Notes
    ) -> None:
        self._scene = scene
        self._opened = opened
        self._placing = placing
        self._images = images
        self._notes = notes
        self._domes: list[Dome] = []
        self._meshes: dict[str, int] = {}
        self._makers: dict[Any, Make] = {
            UsdLux.DistantLight: self._distant,
            UsdLux.SphereLight: self._sphere,
            UsdLux.RectLight: self._rectangle,
            UsdLux.DiskLight: self._disk,
            UsdLux.CylinderLight: self._cylinder,
        }

    def add(self, visit: Visit, spots: Spots) -> None:
        """Adds a light of a prim, at its places."""
        prim = visit.prim
        make: Make | None = self._dome if is_dome(prim) else None
        for kind, maker in self._makers.items():
            make = maker if prim.IsA(kind) else make
        if make is None:
            self._notes.add(f"a light of type {prim.GetTypeName() or 'unknown'} is left out")
            return
        regular = np.array([without_scale(world) is not None for world in spots.still], bool)
        if not regular.all():
            self._notes.add(
                "a light whose prim is scaled to zero is left out", int((~regular).sum())
            )
        if regular.any():
            lamp = Lamp(prim, self._opened.clock, self._notes)
            make(visit, _part(spots, np.flatnonzero(regular)), lamp)

    def glowing(self, visit: Visit, spots: Spots, meshes: Sequence[int], material: int) -> int:
        """Material of a mesh light: the bound material, with the emission of the light.

        Args:
            visit: The mesh.
            spots: Places of the mesh.
            meshes: All meshes of the prim, one per material; they share its power.
            material: Material of one of the meshes.
        """
        lamp = Lamp(visit.prim, self._opened.clock, self._notes)
        if lamp.normalized and len(list(_by_size(spots))) > 1:
            self._notes.add("copies of a normalized mesh light are as bright as the first one")
        size = sum(self._area(mesh, spots.still[0]) for mesh in meshes) if lamp.normalized else 1.0
        bound = self._scene.materials[material]
        if glows(bound):  # USD's default: the glow of the material tints the light
            self._notes.add("a mesh light with an emissive material emits the light only")
            bound = replace(bound, kind=unlit(bound.kind))
        emission: Any = lamp.emission(size, True)
        profile = self._profile(lamp)
        return self._scene.add_material(replace(bound, emission=emission, profile=profile))

    def finish(self) -> None:
        """Sets the environment from all domes."""
        set_environment(self._scene, self._domes, self._notes)

    def _dome(self, visit: Visit, spots: Spots, lamp: Lamp) -> None:
        if spots.moving is not None:
            self._notes.add("a dome light that turns stays as at the scene's time")
        if len(spots) > 1:
            self._notes.add("a dome light of a point instancer is read once")
        if visit.prim.GetRelationship("portals").HasAuthoredTargets():
            self._notes.add("portals of a dome light are ignored")
        path = self._picture(lamp)
        if path is not None and not is_latlong(visit.prim):
            self._notes.add(
                "a dome light with a picture that is not a latlong panorama has one colour"
            )
            path = None
        image = None if path is None else self._panorama(path)
        emission = lamp.emission(1.0, visit.shown)
        self._domes.append(Dome(emission, image, turn_of(visit.prim, spots.still[0])))

    def _panorama(self, path: Path) -> Any:
        """Picture of a dome; None, with a note, if its format is unknown."""
        try:
            return read_panorama(path, self._notes)
        except InputError:
            if is_known(path.name.rstrip("]")):
                raise
            self._notes.add("a picture of a light in an unknown format is left out")
            return None

    def _profile(self, lamp: Lamp) -> LightProfile | None:
        """Factor on the light by its direction; None: the same in all directions."""
        return read_profile(lamp, self._opened.assets, self._notes)

    def _picture(self, lamp: Lamp) -> Path | None:
        """File of the picture of a light; None, with a note, if it is missing."""
        name = "inputs:texture:file"
        attribute = lamp.prim.GetAttribute(name)
        asset = self._opened.clock.now(attribute)
        if asset is None or not asset.path:
            return None
        place = f"{lamp.prim.GetPath()}.{name}"
        path = self._opened.assets.resolve(place, asset, attribute)
        if path is None:
            missing = "a picture of a light is missing: the light has one colour"
            self._notes.add(missing, name=asset.path)
        return path

    def _distant(self, visit: Visit, spots: Spots, lamp: Lamp) -> None:
        degrees = min(max(lamp.still("inputs:angle"), 0.0), 360.0)
        if is_shaped(visit.prim):
            self._notes.add("the shaping of a distant light is left out")
        lux, size = cone_size(degrees)
        emission = times(lamp.emission(size, visit.shown), lux)
        make = _maker(DirectionalLight, name=visit.name, angle=degrees)
        self._lamps(spots, make, emission)

    def _sphere(self, visit: Visit, spots: Spots, lamp: Lamp) -> None:
        radius = lamp.size("radius")
        if radius == 0 or lamp.flag("treatAsPoint"):
            self._points(visit, spots, lamp, radius)
            return
        for group in _by_size(spots):
            scale = _scale_of(group.still[0])
            if np.ptp(scale) > 1e-4 * scale.max() or _changes_scale(group, scale):
                self._mesh(visit, group, lamp, ball(radius))
                continue
            real = float(radius * scale.mean())
            emission = lamp.emission(4 * np.pi * real**2, visit.shown)
            make = _maker(SphereLight, radius=real, name=visit.name, profile=self._profile(lamp))
            self._lamps(group, make, emission)

    def _points(self, visit: Visit, spots: Spots, lamp: Lamp, radius: float) -> None:
        """Points of the mean intensity of a ball: a quarter of its area times its luminance.

        Without a size it is 1 cd for each unit of intensity, if it is not normalized.
        """
        solid = ball(radius)
        for group in _by_size(spots):
            size = 0.0 if solid is None else area(solid.positions, solid.triangles, group.still[0])
            bare = 0.25 if lamp.normalized else 1.0
            emission = times(lamp.emission(size, visit.shown), size / 4 if size > 0 else bare)
            make = _maker(PointLight, name=visit.name, profile=self._profile(lamp))
            self._lamps(group, make, emission)

    def _rectangle(self, visit: Visit, spots: Spots, lamp: Lamp) -> None:
        solid = rectangle(lamp.size("width"), lamp.size("height"))
        self._mesh(visit, spots, lamp, solid, self._picture(lamp))

    def _disk(self, visit: Visit, spots: Spots, lamp: Lamp) -> None:
        self._mesh(visit, spots, lamp, disk(lamp.size("radius")))

    def _cylinder(self, visit: Visit, spots: Spots, lamp: Lamp) -> None:
        if lamp.flag("treatAsLine"):
            self._notes.add("a cylinder light that may be treated as a line keeps its radius")
        self._mesh(visit, spots, lamp, cylinder(lamp.size("length"), lamp.size("radius")))

    def _lamps(self, spots: Spots, make: Callable[[Any], Any], emission: object) -> None:
        """Adds a lamp at each place."""
        if emission == _DARK:
            return
        self._placing.spend(len(spots), "lights")
        worlds: Any = spots.still if spots.moving is None else spots.moving
        for world in worlds:
            placed = Rigid(world) if is_dynamic(world) else without_scale(world)
            self._scene.add_light(make(emission), placed)

    def _mesh(
        self,
        visit: Visit,
        spots: Spots,
        lamp: Lamp,
        solid: ShapeMesh | None,
        path: Path | None = None,
    ) -> None:
        """Adds a mesh that emits, at each place."""
        if solid is None:
            self._notes.add("a light without area is left out")
            return
        for group in _by_size(spots) if lamp.normalized else (spots,):
            size = area(solid.positions, solid.triangles, group.still[0])
            emission = lamp.emission(size, True)
            if emission != _DARK:
                mesh = self._mesh_of(visit, solid)
                made = self._material(visit.path, emission, path)
                material = self._scene.add_material(replace(made, profile=self._profile(lamp)))
                self._placing.add(mesh, material, group, visit.name, visit.shown)

    def _mesh_of(self, visit: Visit, solid: ShapeMesh) -> int:
        if visit.source not in self._meshes:
            self._meshes[visit.source] = self._scene.add_mesh(
                solid.positions, solid.triangles, solid.normals, solid.uv, name=visit.path
            )
        return self._meshes[visit.source]

    def _material(self, name: str, emission: Any, path: Path | None) -> Material:
        index = None
        if path is not None:
            index = self._images.add(name, str(path), srgb=True, wrap=("clamp", "clamp"))
        if index is None:
            return Material(_BLACK, name=name, emission=emission)
        slot = TextureSlot(index)
        kind = Gltf(_DARK, metallic=0.0, specular=0.0, emissive=emission, emissive_texture=slot)
        return Material(kind, name=name)

    def _area(self, index: int, world: Matrix) -> float:
        mesh = self._scene.meshes[index]
        return area(mesh.positions, mesh.indices, world)


def _maker(kind: Any, **fields: Any) -> Callable[[Any], Any]:
    return lambda rgb: kind(rgb, **fields)


def glows(material: Material) -> bool:
    """Whether a material emits light itself."""
    emissive = material.kind.emissive if isinstance(material.kind, Gltf) else _DARK
    return max(*material.emission, *emissive) > 0


def unlit(kind: object) -> Any:
    """The same kind of surface without emission."""
    return replace(kind, emissive=_DARK, emissive_texture=None) if isinstance(kind, Gltf) else kind


def _part(spots: Spots, chosen: NDArray[np.int64]) -> Spots:
    moving = None if spots.moving is None else [spots.moving[i] for i in chosen]
    return Spots(spots.still[chosen], moving, spots.name)


def _by_size(spots: Spots) -> Iterator[Spots]:
    """Groups places where a mesh has equal size and shape: equal products of transform axes."""
    if len(spots) == 1:
        yield spots
        return
    linear = spots.still[:, :3, :3]
    products = (np.swapaxes(linear, 1, 2) @ linear).reshape(-1, 9)
    tops = products.max(axis=1, keepdims=True)
    alike = np.hstack([np.log(tops), products / np.where(tops > 0, tops, 1.0)]).round(5)
    _, group = np.unique(alike, axis=0, return_inverse=True)
    order = np.argsort(group.reshape(-1), kind="stable")
    edges = np.flatnonzero(np.diff(group.reshape(-1)[order])) + 1
    for chosen in np.split(order, edges):
        yield _part(spots, chosen)


def _scale_of(world: Matrix) -> Matrix:
    """Lengths of the axes of a transform, m for each unit of the prim, shape (3,)."""
    lengths: Matrix = np.linalg.norm(world[:3, :3], axis=0)
    return lengths


def _changes_scale(spots: Spots, scale: Matrix) -> bool:
    """Whether the scale of a moving light changes over time."""
    for world in (spots.moving or ())[:_SOME_KEYS]:
        if not isinstance(world, np.ndarray):
            times_s = list(world.breaks(-MAX_TIME, MAX_TIME))[:_SOME_KEYS]
            if not all(np.allclose(_scale_of(world.at(t)), scale, rtol=1e-4) for t in times_s):
                return True
    return False
