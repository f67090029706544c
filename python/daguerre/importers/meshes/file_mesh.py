"""A mesh with the polygons of its file."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.checks import freeze_in_place
from daguerre.errors import InputError
from daguerre.files.value import FixedArrays
from daguerre.scene.far import single_if_near
from daguerre.scene.polygons import weld
from daguerre.scene.scene import Scene

Floats = NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class FileMesh(FixedArrays):
    """Polygons of a file.

    Attributes:
        positions: Shape (N, 3), in the units of the file; doubles if single precision would move
            them (:mod:`daguerre.scene.far`).
        corners: Vertex of each corner, face after face, shape (C,).
        sizes: Corners of each face, at least 3, shape (F,); None: all are triangles.
        normals: Shape (N, 3), or None.
        uv: Texture coordinates as the file has them, shape (N, 2), or None.
        colors: Linear RGB or RGBA, shape (N, 3) or (N, 4), or None.
        face_colors: The same of faces, shape (F, 3) or (F, 4), or None.
        name: Name in the file.
    """

    positions: NDArray[np.floating]
    corners: NDArray[np.uint32]
    sizes: NDArray[np.uint32] | None = None
    normals: Floats | None = None
    uv: Floats | None = None
    colors: Floats | None = None
    face_colors: Floats | None = None
    name: str = ""

    def __repr__(self) -> str:
        faces = len(self.corners) // 3 if self.sizes is None else len(self.sizes)
        return f"<FileMesh {self.name!r}: {len(self.positions)} vertices, {faces} faces>"

    def add_to(self, scene: Scene, name: str = "", *, colors: bool = False) -> int:
        """Adds the mesh to a scene; returns its index there.

        Args:
            scene: The scene.
            name: Name for messages; default: that in the file.
            colors: Whether vertex colours are used.

        Raises:
            InputError: The arrays do not fit together.
        """
        return scene.add_mesh(
            self.positions,
            self.corners,
            self.normals,
            self.uv,
            colors=self.colors if colors else None,
            sizes=self.sizes,
            name=name or self.name,
        )


def with_corner_uv(mesh: FileMesh, uv: Floats) -> FileMesh:
    """A mesh with texture coordinates of corners, shape (C, 2): vertices become several."""
    leaders, index = weld(mesh.corners, uv)
    rows = mesh.corners[leaders]

    def picked(values: Floats | None) -> Floats | None:
        return None if values is None else freeze_in_place(values[rows])

    return replace(
        mesh,
        positions=freeze_in_place(mesh.positions[rows]),
        corners=freeze_in_place(index.astype(np.uint32)),
        normals=picked(mesh.normals),
        uv=freeze_in_place(uv[leaders]),
        colors=picked(mesh.colors),
    )


def check_corners(corners: NDArray[Any], vertices: int, where: str) -> NDArray[np.uint32]:
    """Checks indices of vertices, of any type of numbers.

    Raises:
        InputError: An index is not 0 .. ``vertices`` - 1; the message names the first such corner.
    """
    with np.errstate(invalid="ignore"):
        if len(corners) == 0 or (corners.min() >= 0 and corners.max() < vertices):
            if corners.dtype == np.int32:  # the same bits
                return corners.view(np.uint32)
            found = corners.astype(np.uint32, copy=False)
            if corners.dtype.kind != "f" or (found == corners).all():
                return found
        fits = (corners >= 0) & (corners < vertices) & (np.floor(corners) == corners)
    bad = int(np.argmin(fits))
    raise InputError(
        f"{where}: corner {bad}: wanted a vertex of 0 .. {vertices - 1}, got {corners[bad]}"
    )


def checked_positions(values: NDArray[np.floating], where: str, what: str) -> NDArray[np.floating]:
    """Positions of a file, read-only: in single precision, unless it would move them.

    Raises:
        InputError: A number is not finite in single precision.
    """
    found = single_if_near(values)
    check_finite(found, where, what)
    return freeze_in_place(found)


def check_finite(values: NDArray[Any], where: str, what: str) -> None:
    """Checks that numbers of vertices or corners, shape (N, K), are finite.

    Raises:
        InputError: A number is not finite in single precision; the message names the first.
    """
    with np.errstate(all="ignore"):
        # A sum is fast, and NaN or infinite if any number is; it may also overflow.
        if not len(values) or np.isfinite(values.sum()):
            return
    fits = np.isfinite(values).all(axis=1)
    if not fits.all():
        bad = int(np.argmin(fits))
        raise InputError(
            f"{where}: {what} {bad}: wanted finite numbers, got {values[bad].tolist()}"
        )
