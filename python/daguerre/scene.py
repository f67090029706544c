"""A scene: meshes, textures, materials, instances, lights and cameras. Arrays in, nothing hidden.

World frame: metres, +y up (glTF); transforms are 4x4 matrices that act on column vectors.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .camera import Camera
from .errors import InputError, UsageError, suggest
from .lights import DirectionalLight, PointLight, SphereLight, SpotLight
from .materials import Diffuse, Material

Light = PointLight | SpotLight | DirectionalLight | SphereLight


@dataclass(frozen=True)
class Mesh:
    """Triangles of one material, in their own space (m)."""

    positions: NDArray[np.float32]
    indices: NDArray[np.uint32]
    normals: NDArray[np.float32] | None = None
    uv: NDArray[np.float32] | None = None
    uv1: NDArray[np.float32] | None = None
    tangents: NDArray[np.float32] | None = None
    colors: NDArray[np.float32] | None = None
    name: str = ""


@dataclass(frozen=True)
class Texture:
    """Pixels (H, W, C), uint8 or float32, row 0 on top; ``srgb`` decodes the colour channels."""

    pixels: NDArray[np.uint8] | NDArray[np.float32]
    srgb: bool = False
    wrap: tuple[str, str] = ("repeat", "repeat")
    filter: str = "linear"
    name: str = ""


@dataclass(frozen=True)
class Instance:
    """A mesh in the world."""

    mesh: int
    material: int
    transform: NDArray[np.float64]
    name: str = ""


@dataclass(frozen=True)
class Environment:
    """Light from infinity: an equirectangular picture (H, W, 3) or one colour, times ``scale`` cd/m2."""

    image: NDArray[np.float32] | None = None
    color: tuple[float, float, float] | None = None
    scale: float = 1.0
    rotation: float = 0.0  # degrees about +y


@dataclass
class Scene:
    """What the camera looks at.

    Build it from arrays with the ``add_*`` methods, or read a file with :func:`daguerre.load`.
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
    #: other names by which ``camera`` finds one, such as that of the camera in its node
    camera_aliases: dict[str, str] = field(default_factory=dict)
    environment: Environment | None = None
    #: node name -> indices of its instances (its own and its descendants'), for ``focus_on``
    nodes: dict[str, list[int]] = field(default_factory=dict)
    #: node name -> world position (m), also of nodes without a mesh
    node_positions: dict[str, NDArray[np.float64]] = field(default_factory=dict)
    #: what the reader met and did not understand, one sentence each, with counts
    warnings: list[str] = field(default_factory=list)

    def add_texture(
        self,
        pixels: ArrayLike,
        *,
        srgb: bool = False,
        wrap: tuple[str, str] = ("repeat", "repeat"),
        filter: str = "linear",
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
        if array.dtype != np.uint8:
            array = array.astype(np.float32)
        self.textures.append(
            Texture(np.ascontiguousarray(array), srgb, wrap, filter, name)
        )
        return len(self.textures) - 1

    def add_material(self, material: Material | None = None, **kind: object) -> int:
        """Adds a material; returns its index."""
        self.materials.append(material if material is not None else Material(**kind))  # type: ignore[arg-type]
        return len(self.materials) - 1

    def add_mesh(
        self,
        positions: ArrayLike,
        indices: ArrayLike,
        normals: ArrayLike | None = None,
        uv: ArrayLike | None = None,
        *,
        uv1: ArrayLike | None = None,
        tangents: ArrayLike | None = None,
        colors: ArrayLike | None = None,
        name: str = "",
    ) -> int:
        """Adds triangles; returns the index of the mesh.

        Args:
            positions: Vertices, shape (N, 3), m.
            indices: Triangles, shape (M, 3) or (3 M,).
            normals: Unit normals, shape (N, 3); absent: flat shading.
            uv: Texture coordinates, set 0, shape (N, 2); (0, 0) is the top left of an image.
            uv1: The same, set 1.
            tangents: Shape (N, 4), w is the handedness.
            colors: Linear RGB or RGBA, shape (N, 3) or (N, 4).
            name: For messages.

        Raises:
            InputError: A shape, an index or a number is wrong; the message names it.
        """
        where = f"mesh {name or len(self.meshes)!r}"
        points = _array(positions, where, "positions", 3)
        triangles = np.asarray(indices)
        if triangles.dtype.kind not in "iu":
            raise InputError(f"{where}: indices: wanted integers, got {triangles.dtype}")
        if triangles.size % 3:
            raise InputError(f"{where}: indices: wanted a multiple of 3, got {triangles.size}")
        triangles = triangles.reshape(-1, 3)
        if triangles.size and (triangles.min() < 0 or triangles.max() >= len(points)):
            raise InputError(
                f"{where}: indices: wanted 0 .. {len(points) - 1}, "
                f"got {triangles.min()} .. {triangles.max()}"
            )
        if colors is not None and np.asarray(colors).shape[-1:] == (3,):
            rgb = np.asarray(colors, np.float32)
            colors = np.concatenate([rgb, np.ones((len(rgb), 1), np.float32)], axis=1)
        n = len(points)
        self.meshes.append(
            Mesh(
                points,
                np.ascontiguousarray(triangles, np.uint32),
                _optional(normals, where, "normals", 3, n),
                _optional(uv, where, "uv", 2, n),
                _optional(uv1, where, "uv1", 2, n),
                _optional(tangents, where, "tangents", 4, n),
                _optional(colors, where, "colors", 4, n),
                name,
            )
        )
        return len(self.meshes) - 1

    def add_instance(
        self,
        mesh: int,
        material: int | Material | None = None,
        transform: ArrayLike | None = None,
        *,
        name: str = "",
    ) -> int:
        """Puts a mesh into the world; returns the index of the instance.

        Args:
            mesh: Index from ``add_mesh``.
            material: Index from ``add_material`` or a material; absent: grey diffuse.
            transform: World from local, shape (4, 4); absent: identity.
            name: For messages, ids and ``focus_on``.
        """
        where = f"instance {name or len(self.instances)!r}"
        if not 0 <= mesh < len(self.meshes):
            raise InputError(f"{where}: mesh: wanted 0 .. {len(self.meshes) - 1}, got {mesh}")
        if material is None:
            material = Material(Diffuse())
        if isinstance(material, Material):
            material = self.add_material(material)
        if not 0 <= material < len(self.materials):
            raise InputError(
                f"{where}: material: wanted 0 .. {len(self.materials) - 1}, got {material}"
            )
        self.instances.append(Instance(mesh, material, _matrix(transform, where), name))
        index = len(self.instances) - 1
        if name:
            self.nodes.setdefault(name, []).append(index)
        return index

    def add_light(self, light: Light, transform: ArrayLike | None = None) -> int:
        """Adds a light at the origin of ``transform`` (4, 4), shining along its -z."""
        self.lights.append((light, _matrix(transform, f"light {light.name!r}")))
        return len(self.lights) - 1

    def add_camera(self, name: str, camera: Camera) -> None:
        """Adds a camera under a name; the first one becomes the default."""
        self.cameras[name] = camera
        if self.default_camera is None:
            self.default_camera = name

    def set_environment(
        self,
        image: ArrayLike | None = None,
        *,
        color: Sequence[float] | None = None,
        scale: float = 1.0,
        rotation: float = 0.0,
    ) -> None:
        """Sets the light from infinity: a picture (H, W, 3) or a colour; 1.0 is ``scale`` cd/m2.

        Args:
            image: Equirectangular, row 0 at the zenith (+y), centre column along -z.
            color: One linear colour for the whole sky.
            scale: cd/m2 of a value of 1.
            rotation: Degrees about +y.
        """
        if (image is None) == (color is None):
            raise UsageError("environment: wanted either an image or a color")
        pixels = None
        if image is not None:
            pixels = np.ascontiguousarray(image, np.float32)
            if pixels.ndim != 3 or pixels.shape[2] < 3:
                raise InputError(f"environment: wanted shape (H, W, 3), got {pixels.shape}")
            pixels = np.ascontiguousarray(pixels[:, :, :3])
            bad = int((~np.isfinite(pixels)).sum())
            if bad:
                raise InputError(f"environment: wanted finite pixels, got {bad} NaN or Inf")
        rgb = None if color is None else (float(color[0]), float(color[1]), float(color[2]))
        self.environment = Environment(pixels, rgb, float(scale), float(rotation))

    def camera(self, name: str | None = None) -> Camera:
        """The camera of that name, or the default one.

        Raises:
            InputError: There is none; the message suggests the nearest names.
        """
        if name is None:
            if self.default_camera is None:
                raise InputError(f"{self.path or 'scene'}: no camera in it; name a view yourself")
            name = self.default_camera
        if name not in self.cameras:
            name = self.camera_aliases.get(name, name)
        if name not in self.cameras:
            raise InputError(
                f"{self.path or 'scene'}: no camera named {name!r}{suggest(name, self.cameras)}"
            )
        return self.cameras[name]


def _array(values: ArrayLike, where: str, what: str, columns: int) -> NDArray[np.float32]:
    array = np.ascontiguousarray(values, np.float32)
    if array.ndim != 2 or array.shape[1] != columns:
        raise InputError(f"{where}: {what}: wanted shape (N, {columns}), got {array.shape}")
    bad = np.flatnonzero(~np.isfinite(array).all(axis=1))
    if bad.size:
        raise InputError(
            f"{where}: {what}[{bad[0]}]: wanted finite numbers, got {array[bad[0]].tolist()} "
            f"({bad.size} such elements)"
        )
    return array


def _optional(
    values: ArrayLike | None, where: str, what: str, columns: int, count: int
) -> NDArray[np.float32] | None:
    if values is None:
        return None
    array = _array(values, where, what, columns)
    if len(array) != count:
        raise InputError(f"{where}: {what}: wanted {count} elements, got {len(array)}")
    return array


def _matrix(transform: ArrayLike | None, where: str) -> NDArray[np.float64]:
    if transform is None:
        return np.eye(4)
    matrix = np.array(transform, np.float64)
    if matrix.shape != (4, 4):
        raise InputError(f"{where}: transform: wanted shape (4, 4), got {matrix.shape}")
    if not np.isfinite(matrix).all():
        raise InputError(f"{where}: transform: wanted finite numbers, got {matrix.tolist()}")
    return matrix
