"""A scene: meshes, textures, materials, instances, lights and cameras, built from arrays.

World frame: metres, +y up (glTF). Transforms are 4x4 matrices that act on column vectors.
"""

from __future__ import annotations

import operator
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Unpack, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daguerre.argument_checks import guarded
from daguerre.camera.camera import Camera
from daguerre.checks import (
    MAX_NUMBERS,
    MAX_RESOLUTION,
    as_readonly,
    integers,
    matrix,
    short,
    to_numbers,
    whole,
)
from daguerre.checks import color as check_color
from daguerre.checks import number as check_number
from daguerre.errors import InputError, UsageError, suggest
from daguerre.files import formats
from daguerre.files.notes import Notes
from daguerre.files.value import Value
from daguerre.motion.values import Composite, Dynamic, at, is_dynamic, moves
from daguerre.parameters.keywords import takes

from .catcher import EFFECTS, check_effects
from .curves import CURVES, CurveKeywords, curves_of, moving_curves
from .far import ZERO, recentered
from .illuminance import scale_for
from .lights import Light, check_light
from .limits import check_place, check_places, check_size
from .materials import Diffuse, Kind, Material, bounds_media, check_material, check_parts
from .media import Medium, check_fog
from .mesh import MESH, MeshKeywords, mesh_of
from .motion import SceneMotion
from .node_names import find_node, no_node
from .parts import Curves, Environment, Instance, Mesh, Plate, Texture, vertices_of


@guarded(
    arrays=False,
    but=("camera", "instances", "light", "material", "mesh", "motions", "shown", "steps"),
)
@dataclass(eq=False)
class Scene(Value):
    """A scene: meshes, materials, lights, cameras and environment.

    Build it from arrays with the ``add_*`` methods, or read a file with :func:`daguerre.load`.

    Transforms, vertices and the parameters of materials, lights and environment may be values over
    time (:func:`daguerre.keys`). The lists of the scene hold the state at ``time`` (s); ``motion``
    holds the values over time, and ``at`` returns the scene at another time.
    """

    path: Path | None = None
    time: float = 0.0
    meshes: list[Mesh] = field(default_factory=list)
    textures: list[Texture] = field(default_factory=list)
    materials: list[Material] = field(default_factory=list)
    instances: list[Instance] = field(default_factory=list)
    lights: list[tuple[Light, NDArray[np.float64]]] = field(default_factory=list)
    cameras: dict[str, Camera] = field(default_factory=dict)
    default_camera: str | None = None
    #: other names of cameras, such as the name of the glTF camera of a node
    camera_aliases: dict[str, str] = field(default_factory=dict)
    environment: Environment | None = None
    #: values over time
    motion: SceneMotion = field(default_factory=SceneMotion)
    #: length of the animations of a file, s
    duration: float | None = None
    #: node name -> indices of the instances of the node and its descendants, for ``focus_on``
    nodes: dict[str, list[int]] = field(default_factory=dict)
    #: node name -> world position (m), also of nodes without a mesh
    node_positions: dict[str, NDArray[np.float64]] = field(default_factory=dict)
    #: names of the variants of the file's materials, for ``load(variant=...)``
    variants: list[str] = field(default_factory=list)
    #: features of the file that the reader does not support, one sentence each, with counts
    warnings: list[str] = field(default_factory=list)
    #: photograph of the set, which objects reflect and refract
    plate: Plate | None = None
    #: medium that fills the world outside of all closed meshes
    fog: Medium | None = None
    #: width and height of the picture, px, that the file asks of a camera
    film_sizes: dict[str, tuple[int, int]] = field(default_factory=dict)
    #: begin and end of the time for which a file's motion was read, s; None: all of it was
    moments: tuple[float, float] | None = None

    __hash__ = None  # type: ignore[assignment]  # it changes

    def __repr__(self) -> str:
        names = ("mesh", "instance", "light", "camera")
        counts = [len(p) for p in (self.meshes, self.instances, self.lights, self.cameras)]
        words = [_counted(count, name) for count, name in zip(counts, names, strict=True)]
        words += ["an environment"] if self.environment is not None else []
        words += ["moving"] if self.motion else []
        return f"<Scene {self.path.name if self.path else 'of arrays'}: {', '.join(words)}>"

    def _repr_html_(self) -> str:
        from daguerre.files.html_table import html_table

        triangles = [len(mesh.indices) for mesh in self.meshes]
        placed = sum(triangles[instance.mesh] for instance in self.instances)
        lights = Counter(type(light).__name__ for light, _ in self.lights)
        curves = sum(len(mesh.ends) for mesh in self.meshes if isinstance(mesh, Curves))
        rows = {
            "meshes": f"{len(self.meshes)} ({sum(triangles)} triangles)",
            "instances": f"{len(self.instances)} ({placed} triangles)",
            "materials": str(len(self.materials)),
            "textures": str(len(self.textures)),
            "lights": ", ".join(f"{count} {kind}" for kind, count in lights.items()) or "none",
            "environment": repr(self.environment) if self.environment else "none",
            "cameras": ", ".join(self.cameras) or "none",
            "time": f"{self.time:g} s",
        }
        rows |= {"curves": str(curves)} if curves else {}
        rows |= {"animation": f"{self.duration:g} s"} if self.duration else {}
        rows |= {"variants": ", ".join(self.variants)} if self.variants else {}
        rows |= {"warnings": "; ".join(self.warnings)} if self.warnings else {}
        return html_table(f"Scene {self.path.name if self.path else 'of arrays'}", rows)

    def at(self, time: float) -> Scene:
        """Returns the scene at another time, s; both scenes share the parts that do not change."""
        time = check_number(time, "scene: time")
        check_moments(self, time, time)
        return scene_at(self, time)

    def note(self, *sentences: str) -> None:
        """Adds a warning of a reader: an unsupported feature, or a decision; one sentence."""
        self.warnings.extend(sentences)

    def set_clock(self, duration: float | None) -> None:
        """Sets the length of the file's animations, s; None: there are none."""
        self.duration = duration

    def add_variant(self, name: str) -> None:
        """Adds the name of a material variant of the file, for ``load(variant=...)``."""
        self.variants.append(name)

    def add_node(
        self, name: str, position: NDArray[np.float64], *, motion: Dynamic | None = None
    ) -> None:
        """Adds a node: a named position, which may group instances.

        Args:
            name: Unique name, for ``focus_on``, ids and boxes.
            position: World position, shape (3,), m.
            motion: World position over time.
        """
        self.node_positions[name] = position
        self.nodes.setdefault(name, [])
        if motion is not None:
            self.motion.node_positions[name] = motion

    def group_instances(self, name: str, instances: Sequence[int]) -> None:
        """Sets the instances of a node and its descendants; there may be a million.

        Raises:
            InputError: They are not whole numbers of at least 0.
        """
        found = integers(instances, f"node {name!r}", "instances", MAX_NUMBERS)
        self.nodes[name] = found.reshape(-1).tolist()

    def set_catcher(self, node: str, effects: str | Sequence[str] = EFFECTS) -> None:
        """Makes the meshes of a node and its descendants catchers: stand-ins for the plate.

        A catcher is not drawn. It hides objects behind it, and the light that objects take from it
        and add to it becomes ``Frame.catcher`` (``docs/plates.md``). Its material should match the
        real surface.

        Args:
            node: Name of the node.
            effects: Effects of objects to catch: "shadow", "reflection" and "gi" (default: all), or
                "holdout" for none of them.

        Raises:
            UsageError: No such node, a node without meshes, or an unknown effect.
        """
        named = find_node(node, self.nodes)
        if named is None:
            raise UsageError(f"catcher: {no_node(node, self.nodes)}")
        node = named
        found = check_effects(effects, f"catcher {node!r}: effects")
        if not self.nodes[node]:
            raise UsageError(f"catcher: the node {node!r} has no mesh")
        for i in self.nodes[node]:
            self.instances[i] = replace(self.instances[i], catcher=found)

    def set_plate(self, pixels: ArrayLike, camera: Camera | None = None) -> None:
        """Projects a photograph of the set onto the catchers, for objects to see.

        Mirrors and glass then show the photograph, and its light bounces onto objects. It covers
        catchers within its frame that no other catcher hides from its camera; elsewhere catchers
        have the light of their materials. Smooth mirrors and glass also see it in place of the
        environment.

        Args:
            pixels: Shape (H, W, 3), linear Rec.709, in units of a frame: 1 is a white of 1 cd/m2.
            camera: Camera that took the photograph; default: the camera that renders.

        Raises:
            InputError: Another shape, or numbers that are not finite.
        """
        given = to_numbers(pixels, "plate", "pixels", "shape (H, W, 3)")
        array = as_readonly(given, np.float32)
        if array.ndim != 3 or array.shape[2] != 3 or array.size == 0:
            raise InputError(f"plate: pixels: wanted shape (H, W, 3), got {array.shape}")
        bad = int((~np.isfinite(array)).any(axis=2).sum())
        if bad:
            raise InputError(
                f"plate: pixels: wanted finite numbers, got NaN or infinity in {bad} pixels"
            )
        if camera is not None and not isinstance(camera, Camera):
            raise UsageError(f"plate: camera: wanted a Camera, got {short(camera)}")
        self.plate = Plate(array, camera)

    def set_fog(self, medium: Medium | None) -> None:
        """Fills the world outside of all closed meshes with an endless medium; None: with nothing.

        Glass and other closed meshes that refract keep it out, unless their ``Material.interior``
        is the same medium. No light from infinity gets through endless fog, neither from the
        environment nor from directional lights; fog on a grid (``Medium.density``), or in a mesh
        of :class:`Boundary`, has an end.

        Args:
            medium: The medium; without a grid it must not emit without absorbing or scattering.

        Raises:
            InputError: It is no medium, or its light would grow without end.
        """
        check_fog(medium, "fog")
        self.fog = medium

    @property
    def has_media(self) -> bool:
        """Whether the scene has fog or a material that bounds a medium."""
        return self.fog is not None or any(bounds_media(material) for material in self.materials)

    @property
    def has_catchers(self) -> bool:
        """Whether the scene has a catcher."""
        return any(instance.catcher is not None for instance in self.instances)

    def add_texture(
        self,
        pixels: ArrayLike,
        *,
        srgb: bool = False,
        wrap: tuple[str, str] = ("repeat", "repeat"),
        filter: str = "linear",
        min_filter: str = "linear_mipmap_linear",
        name: str = "",
    ) -> int:
        """Adds an image (H, W) or (H, W, 1..4), uint8 or float; returns its index."""
        array = np.asarray(pixels)
        if array.ndim == 2:
            array = array[:, :, None]
        if array.ndim != 3 or not 1 <= array.shape[2] <= 4 or array.size == 0:
            raise InputError(
                f"texture {name!r}: pixels: wanted shape (H, W, 1..4), got {array.shape}"
            )
        array = as_readonly(array, np.uint8 if array.dtype == np.uint8 else np.float32)
        self.textures.append(Texture(array, srgb, wrap, filter, name, min_filter))
        return len(self.textures) - 1

    def add_material(
        self,
        material: Material | Kind | None = None,
        *,
        motion: Dynamic | None = None,
        **fields: object,
    ) -> int:
        """Adds a material; returns its index.

        Args:
            material: A material, or only its kind; default: a material made from ``fields``.
            motion: The material over time; ``material`` then is its state at the scene's time.
            **fields: Fields of :class:`Material`.
        """
        if material is None:
            unknown = sorted(set(fields) - set(Material.__dataclass_fields__))
            if unknown:
                known = Material.__dataclass_fields__
                raise UsageError(
                    f"material: unknown field {unknown[0]!r}{suggest(unknown[0], known)}"
                )
            material = Material(**dict[str, Any](fields))
        elif isinstance(material, Kind):
            material = Material(material)
        shown = at(material, self.time)
        where = f"material {str(getattr(shown, 'name', '')) or len(self.materials)!r}"
        check_material(shown, where)
        check_parts(shown, len(self.materials), where)
        motion = _motion_of(material) if motion is None else motion
        if motion is not None:
            self.motion.materials[len(self.materials)] = motion
        self.materials.append(shown)
        return len(self.materials) - 1

    @takes(MESH, MeshKeywords)
    def add_mesh(
        self,
        positions: ArrayLike | Dynamic,
        indices: ArrayLike,
        normals: ArrayLike | Dynamic | None = None,
        uv: ArrayLike | None = None,
        **keywords: Unpack[MeshKeywords],
    ) -> int:
        """Adds triangles or polygons; returns the index of the mesh.

        Args:
            positions: Positions of vertices, shape (N, 3), m; they may change over time.
            indices: Triangles, shape (M, 3) or (3 M,); with ``sizes``: corners of polygons.
            normals: Unit normals, shape (N, 3); default: flat shading. Normals that do not change
                are the normals at the scene's time, and turn with the surface.
            uv: Texture coordinates, set 0, shape (N, 2); (0, 0) is the top left of an image.
            {keywords}

        Raises:
            InputError: A shape, an index or a number is wrong; the message names it.
        """
        given = MESH.filled(keywords, "Scene.add_mesh")
        name, steps, motion = (given.pop(key) for key in ("name", "steps", "motion"))
        sizes, subdivision = given.pop("sizes"), given.pop("subdivision")
        where = f"mesh {name or len(self.meshes)!r}"
        moving = _dynamic(positions) if steps is None else _steps(steps, where)
        moving_normals = _dynamic(normals)
        given |= {"normals": self._now(normals), "uv": uv}
        still = moving is None and moving_normals is None and motion is None
        positions, origin = recentered(positions) if still else (positions, ZERO)
        if sizes is None and subdivision is None:
            mesh = mesh_of(self._now(positions), indices, given, where, name)
        else:
            from .polygon_mesh import Over, mesh_of_polygons, polygons_of

            over = Over(moving, moving_normals, motion)
            polygons = polygons_of(self._now(positions), indices, sizes, given, where)
            mesh, over = mesh_of_polygons(polygons, over, subdivision, name)
            moving, moving_normals, motion = over
        if motion is not None and subdivision is not None:
            mesh = replace(mesh, **vars(motion.at(self.time)))
        if moving is not None or moving_normals is not None:
            rest = vertices_of(mesh)
            path = moving or Composite(mesh.positions)
            from .point_cache import PointCache

            cache = PointCache(path, moving_normals, rest, mesh.indices, where)
            mesh, motion = replace(mesh, **vars(cache.at(self.time))), cache
        if motion is not None:
            self.motion.meshes[len(self.meshes)] = motion
        self.meshes.append(replace(mesh, origin=origin) if any(origin) else mesh)
        return len(self.meshes) - 1

    @takes(CURVES, CurveKeywords)
    def add_curves(
        self,
        points: ArrayLike | Dynamic,
        counts: ArrayLike,
        widths: ArrayLike,
        **keywords: Unpack[CurveKeywords],
    ) -> int:
        """Adds round curves, such as hair, grass or cables; returns the index of the mesh.

        All curves of a call are one mesh for ``add_instance``. Cubic curves have flat ends; linear
        curves are round at ends and corners. Curves with an emissive material shine, but light is
        not sampled from them.

        Args:
            points: Control points, curve after curve, shape (N, 3), m; they may change over time.
            counts: Number of control points of each curve, shape (C,).
            widths: Diameters, m: a single number, or a number per curve or per control point.
            {keywords}

        Raises:
            InputError: A shape, a count or a number is wrong; the message names it.
        """
        given = CURVES.filled(keywords, "Scene.add_curves")
        where = f"curves {given['name'] or len(self.meshes)!r}"
        steps = given.pop("steps")
        path = _dynamic(points) if steps is None else _steps(steps, where)
        points, origin = recentered(points) if path is None else (points, ZERO)
        curves, layout = curves_of(self._now(points), counts, widths, given, where)
        if path is not None:
            motion = moving_curves(path, curves, layout)
            curves = replace(curves, **vars(motion.at(self.time)))
            self.motion.meshes[len(self.meshes)] = motion
        self.meshes.append(replace(curves, origin=origin) if any(origin) else curves)
        return len(self.meshes) - 1

    def _now(self, value: Any) -> Any:
        """Returns a value, evaluated at the time of the scene."""
        return value.at(self.time) if is_dynamic(value) else value

    def add_instance(
        self,
        mesh: int,
        material: int | Material | Kind | None = None,
        transform: ArrayLike | Dynamic | None = None,
        *,
        name: str = "",
        shown: bool | Dynamic = True,
        motion: Dynamic | None = None,
    ) -> int:
        """Places a mesh in the world; returns the index of the instance.

        Args:
            mesh: Index from ``add_mesh``.
            material: Index from ``add_material`` or a material; default: grey diffuse.
            transform: World from local, shape (4, 4), may change over time; default: identity.
            name: Name for messages, ids and ``focus_on``.
            shown: Whether the instance is visible; it may change over time.
            motion: The transform over time; ``transform`` then is its state at the scene's time.

        Raises:
            InputError: No such mesh or material, or the transform is not a finite matrix. A
                constant transform must also have an inverse, and place the mesh within 1e18 m of
                the origin; while a moving transform does not, the instance is absent.
            UsageError: The transform is a list of (time, matrix); pass it through ``dg.keys``.
        """
        where = f"instance {name or len(self.instances)!r}"
        mesh = self._index(mesh, len(self.meshes), f"{where}: mesh")
        if _are_keys(transform):
            raise UsageError(f"{where}: transform: keys over time: wanted dg.keys(...), got a list")
        moving, presence = _dynamic(transform), None if shown is True else _dynamic(shown)
        world = matrix(transform if moving is None else moving.at(self.time), where)
        motion = moving if motion is None else motion
        visible = shown if presence is None else presence.at(self.time)
        if not isinstance(visible, bool | np.bool_ | int | float):
            raise InputError(f"{where}: shown: wanted true or false, got {short(visible)}")
        if material is None:
            material = Material(Diffuse())
        if isinstance(material, Material | Kind):
            material = self.add_material(material)
        material = self._index(material, len(self.materials), f"{where}: material")
        index = len(self.instances)
        if motion is None:
            check_place(world, self.meshes[mesh].extent, f"{where}: transform")
        else:
            self.motion.instances[index] = motion
        if presence is not None:
            self.motion.shown[index] = presence
        self.instances.append(Instance(mesh, material, world, name, bool(visible)))
        if name:
            self.nodes.setdefault(name, []).append(index)
        return index

    def add_instances(
        self,
        mesh: int,
        material: int,
        transforms: NDArray[np.float64],
        *,
        name: str = "",
        motions: Sequence[Dynamic] | None = None,
    ) -> None:
        """Places a mesh in the world many times, with one check for all: there may be a million.

        Args:
            mesh: Index from ``add_mesh``.
            material: Index from ``add_material``.
            transforms: World from local, shape (N, 4, 4).
            name: Name of all instances, as in :meth:`add_instance`.
            motions: Each transform over time, N values; ``transforms`` then are their states at the
                scene's time.

        Raises:
            InputError: No such mesh or material, a transform is wrong (:meth:`add_instance`), or
                the number of motions differs from the number of transforms.
        """
        where = f"instances {name or len(self.instances)!r}"
        mesh = self._index(mesh, len(self.meshes), f"{where}: mesh")
        material = self._index(material, len(self.materials), f"{where}: material")
        worlds = to_numbers(transforms, where, "transforms", "shape (N, 4, 4)").astype(float)
        if worlds.shape[1:] != (4, 4):
            raise InputError(f"{where}: transforms: wanted shape (N, 4, 4), got {worlds.shape}")
        if not np.isfinite(worlds).all():
            raise InputError(f"{where}: transforms: wanted finite numbers, got NaN or infinity")
        over = _motions(motions, len(worlds), where)
        if not over:
            check_places(worlds, self.meshes[mesh].extent, f"{where}: transforms")
        first = len(self.instances)
        self._place(mesh, material, worlds, name)
        self.motion.instances.update(enumerate(over, first))
        if name:
            self.nodes.setdefault(name, []).extend(range(first, len(self.instances)))

    def _place(self, mesh: int, material: int, worlds: NDArray[np.float64], name: str) -> None:
        """Appends instances of checked numbers."""
        self.instances.extend(Instance(mesh, material, world, name) for world in worlds)

    def add_light(
        self,
        light: Light,
        transform: ArrayLike | Dynamic | None = None,
        *,
        motion: Dynamic | None = None,
    ) -> int:
        """Adds a light at the origin of ``transform`` (4, 4), shining along its -z.

        ``motion`` gives both over time, as (light, transform); the arguments are then their state
        at the scene's time.
        """
        shown = at(light, self.time)
        check_light(shown)
        world = matrix(self._now(transform), f"light {shown.name!r}")
        check_size(world, f"light {shown.name!r}: transform")
        if motion is None:
            motion = _motion_of((light, _dynamic(transform) or world))
        if motion is not None:
            self.motion.lights[len(self.lights)] = motion
        self.lights.append((shown, world))
        return len(self.lights) - 1

    def add_camera(
        self,
        name: str,
        camera: Camera,
        *,
        alias: str = "",
        film_size: tuple[int, int] | None = None,
    ) -> None:
        """Adds a camera under a name; the first one becomes the default.

        Args:
            name: Name.
            camera: The camera.
            alias: Second name for it, unless another camera has it.
            film_size: Width and height, px, of the picture that the file asks of it: the default of
                ``daguerre render``.
        """
        for value, kind in ((name, str), (camera, Camera)):
            if not isinstance(value, kind):
                raise UsageError(f"add_camera: wanted a {kind.__name__}, got {short(value)}")
        if film_size is not None:
            width, height = (whole(side, "film_size", 1, MAX_RESOLUTION) for side in film_size)
            self.film_sizes[name] = width, height
        self.cameras[name] = camera
        if self.default_camera is None:
            self.default_camera = name
        if alias:
            self.camera_aliases.setdefault(alias, name)

    def set_environment(
        self,
        image: ArrayLike | str | Path | None = None,
        *,
        color: Sequence[float] | Dynamic | None = None,
        scale: float | Dynamic = 1.0,
        rotation: float | Dynamic = 0.0,
        lux: float | None = None,
    ) -> None:
        """Sets the light from infinity: an environment map or a colour; 1.0 is ``scale`` cd/m2.

        All parameters but the map may change over time.

        Args:
            image: Equirectangular map, shape (H, W, 3), row 0 at the zenith (+y), centre column
                along -z; or its file.
            color: One linear colour for the whole sky.
            scale: Luminance of a value of 1, cd/m2.
            rotation: Rotation about +y, degrees.
            lux: Illuminance of the ground, a horizontal plane that faces +y, instead of ``scale``.
        """
        if lux is not None and not (isinstance(scale, int | float) and scale == 1):
            raise UsageError("environment: wanted either scale or lux, got both")
        if (image is None) == (color is None):
            raise UsageError("environment: wanted either an image or a color")
        pixels = None
        if isinstance(image, str | Path):
            notes = Notes()
            pixels = formats.read("environment", image, notes)
            self.note(*notes.sentences())
        elif image is not None:
            pixels = _panorama(image)
        given = Environment(pixels, cast("Any", color), cast("Any", scale), cast("Any", rotation))
        now = at(given, self.time)
        rgb = None if color is None else check_color(now.color, "environment: color")
        now_scale = check_number(now.scale, "environment: scale", 0)
        now_rotation = check_number(now.rotation, "environment: rotation")
        self.environment = Environment(pixels, rgb, now_scale, now_rotation)
        if lux is not None:
            now_scale = scale_for(self.environment, lux)
            self.environment = replace(self.environment, scale=now_scale)
            given = replace(given, scale=now_scale)
        self.motion.environment = _motion_of(given)

    @staticmethod
    def _index(value: object, count: int, where: str) -> int:
        if isinstance(value, bool | str | np.ndarray) or not hasattr(value, "__index__"):
            raise InputError(f"{where}: wanted an index, got {short(value)}")
        index = operator.index(value)
        if not 0 <= index < count:
            wanted = f"wanted 0 .. {count - 1}" if count else "none was added yet"
            raise InputError(f"{where}: {wanted}, got {index}")
        return index

    def camera(self, name: str | None = None) -> Camera:
        """Returns the camera of this name; without a name, the default camera.

        Raises:
            InputError: There is no such camera; the message suggests the nearest names.
        """
        return self.cameras[self._camera_name(name)]

    def film_size(self, name: str | None = None) -> tuple[int, int] | None:
        """Width and height, px, that the file sets for pictures of a camera; None: not set.

        Raises:
            InputError: There is no such camera.
        """
        return self.film_sizes.get(self._camera_name(name))

    def _camera_name(self, name: str | None) -> str:
        if name is None:
            if self.default_camera is None:
                raise InputError(f"{self.path or 'scene'}: {self._lacking()}")
            name = self.default_camera
        if name not in self.cameras:
            name = self.camera_aliases.get(name, name)
        if name not in self.cameras:
            raise InputError(
                f"{self.path or 'scene'}: no camera named {name!r}"
                f"{suggest(name, [*self.cameras, *self.camera_aliases], few=True)}"
            )
        return name

    def _lacking(self) -> str:
        """Message for a scene without a camera."""
        if any(instance.shown for instance in self.instances):
            return "no camera: the file has none; use add_camera, or --position and --look-at"
        return "no camera and nothing visible (--position and --look-at place a camera)"


def _counted(count: int, name: str) -> str:
    return f"{count} {name}" + ("" if count == 1 else "es" if name == "mesh" else "s")


def _steps(steps: object, where: str) -> Dynamic:
    from .point_cache import steps_of

    return steps_of(steps, where)


def _dynamic(value: object) -> Dynamic | None:
    return value if is_dynamic(value) else None


def _motion_of(value: object) -> Dynamic | None:
    """Returns the value over time, or None if it does not change."""
    return _dynamic(value) or (Composite(value) if moves(value) else None)


def _are_keys(transform: object) -> bool:
    """Whether a value looks like [(time, matrix), ...]."""
    return (
        isinstance(transform, list | tuple)
        and len(transform) > 0
        and all(
            isinstance(key, list | tuple) and len(key) == 2 and np.ndim(key[0]) == 0
            for key in transform
        )
    )


def _motions(given: object, count: int, where: str) -> Sequence[Dynamic]:
    """Checks values over time, as many as transforms; none if None is given.

    Raises:
        InputError: Others.
    """
    if given is None:
        return ()
    if not isinstance(given, list | tuple) or len(given) != count:
        got = len(given) if isinstance(given, list | tuple) else short(given)
        raise InputError(f"{where}: motions: wanted {count} values over time, got {got}")
    odd = next((i for i, motion in enumerate(given) if not is_dynamic(motion)), None)
    if odd is not None:
        raise InputError(
            f"{where}: motions[{odd}]: wanted a value over time, got {short(given[odd])}"
        )
    return given


def _panorama(image: ArrayLike) -> NDArray[np.float32]:
    numbers = to_numbers(image, "environment", "image", "shape (H, W, 3)")
    if numbers.ndim != 3 or numbers.shape[2] < 3 or numbers.size == 0:
        raise InputError(f"environment: wanted shape (H, W, 3), got {numbers.shape}")
    pixels = np.ascontiguousarray(numbers[:, :, :3], np.float32)
    bad = int((~np.isfinite(pixels) | (pixels < 0)).sum())
    if bad:
        raise InputError(f"environment: pixels must be finite and at least 0, but {bad} are not")
    return pixels


def check_moments(scene: Scene, begin: float, end: float) -> None:
    """Checks that the motion of a scene was read for an interval, s.

    Raises:
        UsageError: It was not: ``load(moments=...)`` left it out.
    """
    first, last = scene.moments or (begin, end)
    if begin < first or end > last:
        got = f"{begin:g}" if begin == end else f"{begin:g} .. {end:g}"
        raise UsageError(
            f"scene: time: wanted {first:g} .. {last:g} s, the moments that were loaded, got {got}"
        )


def scene_at(scene: Scene, time: float) -> Scene:
    """Returns the scene with its lists evaluated at a time; shares motion and constant parts."""
    motion = scene.motion
    moved: dict[str, Any] = {
        "materials": _replaced(scene.materials, motion.materials, time),
        "lights": _replaced(scene.lights, motion.lights, time),
        "cameras": {name: camera.evaluated_at(time) for name, camera in scene.cameras.items()},
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
