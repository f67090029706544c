"""Parts of a scene: meshes, textures, instances, the environment."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from daguerre.cached import cached_property
from daguerre.camera.camera import Camera
from daguerre.files.array_value import ArrayValue
from daguerre.files.value import FixedArrays, Value

from .far import ZERO, Place
from .limits import largest
from .motion import Vertices


@dataclass(frozen=True, eq=False)
class Mesh(FixedArrays):
    """Triangles of one material, in local space (m).

    ``positions`` are relative to ``origin``, a point of the local space, which is 0 unless the mesh
    came with doubles far from 0.
    """

    positions: NDArray[np.float32]
    indices: NDArray[np.uint32]
    normals: NDArray[np.float32] | None = None
    uv: NDArray[np.float32] | None = None
    uv1: NDArray[np.float32] | None = None
    tangents: NDArray[np.float32] | None = None
    colors: NDArray[np.float32] | None = None
    name: str = ""
    origin: Place = ZERO

    @cached_property
    def extent(self) -> float:
        """Largest coordinate at the scene's time, with the radii of curves, m."""
        return largest(self.positions) + reach_of(self) + max(map(abs, self.origin))

    @property
    def points(self) -> NDArray[np.float64]:
        """Positions in the local space, shape (N, 3), m."""
        return self.positions.astype(np.float64) + self.origin

    def __repr__(self) -> str:
        return (
            f"<Mesh {self.name!r}: {len(self.positions)} vertices, {len(self.indices)} triangles>"
        )


@dataclass(frozen=True, eq=False)
class Curves(Mesh):
    """Round curves of one material, in local space (m): a mesh without triangles.

    ``positions`` are the control points of segments, curve after curve: 3 n + 1 of n cubic Bezier
    segments, or n + 1 of n straight segments. ``uv`` and ``colors`` have a row per position or per
    curve.

    Attributes:
        radii: Radius at each position, shape (P,), m.
        starts: First position of each segment, shape (S,).
        ends: One past the last segment of each curve, shape (C,).
        cubic: Whether the segments are cubic.
        closed: Whether each curve ends where it begins.
    """

    radii: NDArray[np.float32] = field(kw_only=True)
    starts: NDArray[np.uint32] = field(kw_only=True)
    ends: NDArray[np.uint32] = field(kw_only=True)
    cubic: bool = field(default=True, kw_only=True)
    closed: bool = field(default=False, kw_only=True)

    def __repr__(self) -> str:
        return f"<Curves {self.name!r}: {len(self.ends)} curves, {len(self.starts)} segments>"


def reach_of(mesh: Mesh) -> float:
    """How far the surface reaches beyond the positions, at most, m; 0 for triangles."""
    return float(mesh.radii.max(initial=0)) if isinstance(mesh, Curves) else 0.0


def vertices_of(mesh: Mesh) -> Vertices:
    """Vertices of a mesh at the time of its scene."""
    return Vertices(mesh.positions, mesh.normals, mesh.tangents, mesh.uv, mesh.uv1, mesh.colors)


@dataclass(frozen=True, eq=False)
class Texture(FixedArrays, ArrayValue, array="pixels"):
    """Image texture: pixels (H, W, C), uint8 or float32, row 0 on top.

    ``srgb``: the colour channels are sRGB-encoded. ``filter`` is for magnification ("linear" or
    "nearest"), ``min_filter`` for minification, with glTF's names: "linear_mipmap_linear", ..., or
    "linear" and "nearest" without mip-maps.
    """

    pixels: NDArray[np.uint8] | NDArray[np.float32]
    srgb: bool = False
    wrap: tuple[str, str] = ("repeat", "repeat")
    filter: str = "linear"
    name: str = ""
    min_filter: str = "linear_mipmap_linear"

    def __repr__(self) -> str:
        height, width, channels = self.pixels.shape
        return f"<Texture {self.name!r}: {width}x{height}, {channels} channels>"


@dataclass(frozen=True, eq=False)
class Instance(Value):
    """A mesh placed in the world.

    ``catcher``: effects of objects that it catches (``Scene.set_catcher``); None: not a catcher.
    """

    mesh: int
    material: int
    transform: NDArray[np.float64]
    name: str = ""
    shown: bool = True
    catcher: tuple[str, ...] | None = None

    def __repr__(self) -> str:
        return f"<Instance {self.name!r}: mesh {self.mesh}, material {self.material}>"


@dataclass(frozen=True, eq=False)
class Plate(FixedArrays, ArrayValue, array="pixels"):
    """A photograph of the set, shape (H, W, 3), in the units of a frame, and its camera.

    ``camera``: None means the camera that renders.
    """

    pixels: NDArray[np.float32]
    camera: Camera | None = None

    def __repr__(self) -> str:
        return "<Plate {1}x{0} pixels>".format(*self.pixels.shape)


@dataclass(frozen=True, eq=False)
class Environment(Value):
    """Light from infinity: a panorama (H, W, 3) or one colour; ``scale`` is in cd/m2."""

    image: NDArray[np.float32] | None = None
    color: tuple[float, float, float] | None = None
    scale: float = 1.0
    rotation: float = 0.0  # degrees about +y

    def __repr__(self) -> str:
        light = f"color {self.color}"
        if self.image is not None:
            light = "{1}x{0} pixels".format(*self.image.shape)
        return f"<Environment {light}, {self.scale:g} cd/m2>"
