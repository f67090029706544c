"""Transmittance of an iris on a raster: blades, arcs, or a picture, with dust on them.

The unit is the radius of the circle of equal area, as in ``core/optics/lens/stop.h``; x to the
right and y up, seen along the view.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core
from daguerre.argument_checks import guarded
from daguerre.cached import cached_property
from daguerre.errors import UsageError

if TYPE_CHECKING:
    from daguerre.camera.camera import Camera

Floats = NDArray[np.float32]


@guarded(init=True)
@dataclass(frozen=True)
class Iris:
    """An iris shape, and the dirt on it.

    Attributes:
        blades: Number of blades; 0: round.
        rotation: Rotation of the blades, degrees.
        curvature: Curvature of their edges: 1 is round, 0 straight.
        picture: Picture of the iris's transmittance instead, row 0 on top, shape (H, W).
        mask: Transmittance of dust and scratches, shape (H, W); None: clean.
        mask_half: Half of the width that the mask covers; None: the whole opening's.
    """

    blades: int = 0
    rotation: float = 0.0
    curvature: float = 0.0
    picture: Floats | None = None
    mask: Floats | None = None
    mask_half: float | None = None

    @cached_property
    def shape(self) -> _core.Iris:
        """The core's iris."""
        if self.picture is not None:
            return _core.Iris.image(np.ascontiguousarray(self.picture))
        if self.blades:
            return _core.Iris.polygon(self.blades, self.rotation, self.curvature)
        return _core.Iris()

    @property
    def outer_radius(self) -> float:
        """Radius beyond which nothing is open."""
        return float(self.shape.outer_radius)

    def amplitude(self, x: Floats, y: Floats, pitch: float) -> Floats:
        """Amplitude of a wave behind cells of a raster: 1 where the iris is open.

        Cells at an edge have their open share; grey parts the square root of their transmittance.

        Args:
            x: Centres of the cells along x.
            y: Centres of the cells along y; ``x`` and ``y`` broadcast.
            pitch: Side of a cell, which is also the width of soft edges.
        """
        try:
            np.broadcast_shapes(np.shape(x), np.shape(y))
        except ValueError:
            shapes = f"{np.shape(x)} and {np.shape(y)}"
            raise UsageError(f"amplitude: x, y: wanted shapes that match, got {shapes}") from None
        if self.picture is not None:
            pixel = float(np.sqrt(np.pi / self.picture.sum(dtype=np.float64)))
            open_share = np.sqrt(_sampled(self.picture, x / pixel, y / pixel))
        else:
            open_share = np.clip(_inside(self.shape, x, y) / np.float32(pitch) + 0.5, 0, 1)
        if self.mask is None:
            return np.asarray(open_share, np.float32)
        half = self.mask_half or self.outer_radius
        rows, columns = (np.float32(0.5 * n / half) for n in self.mask.shape)
        within = np.maximum(np.abs(x), np.abs(y)) < np.float32(half)
        dirt = np.sqrt(_sampled(self.mask, x * columns, y * rows))
        return np.asarray(open_share * np.where(within, dirt, 1), np.float32)


def iris_of(camera: Camera, mask_half: float | None = None) -> Iris:
    """Returns the iris of a camera: its blades or picture, and its mask."""
    from daguerre.setup.iris import mask_of

    picture = camera.aperture_image
    return Iris(
        camera.blades,
        camera.blade_rotation,
        camera.blade_curvature,
        None if picture is None else np.asarray(picture, np.float32),
        mask_of(camera, "iris_mask"),
        mask_half,
    )


def _inside(shape: _core.Iris, x: Floats, y: Floats) -> Floats:
    """Distance from the edge, positive where the iris is open."""
    if not shape.edges:
        return np.asarray(1 - np.hypot(x, y), np.float32)
    depth: Floats | None = None
    for ex, ey in shape.edges:
        sides = []
        if shape.bend <= 0:
            sides.append(shape.apothem - (x * np.float32(ex) + y * np.float32(ey)))
        if shape.bend:
            cx, cy = np.float32(shape.arc_center * ex), np.float32(shape.arc_center * ey)
            sides.append(shape.bend * (shape.arc_radius - np.hypot(x - cx, y - cy)))
        for side in sides:
            depth = np.asarray(side if depth is None else np.minimum(depth, side), np.float32)
    return np.asarray(depth, np.float32)


def _sampled(picture: Floats, x: Floats, y: Floats) -> Floats:
    """Samples a picture bilinearly, x right and y up from its centre, in pixels; 0 outside."""
    height, width = picture.shape
    column = np.broadcast_to(
        x + np.float32(0.5 * width + 0.5), np.broadcast_shapes(x.shape, y.shape)
    )
    row = np.broadcast_to(np.float32(0.5 * height + 0.5) - y, column.shape)
    padded = np.pad(picture, 1)
    column, row = np.clip(column, 0, width + 0.999), np.clip(row, 0, height + 0.999)
    i, j = row.astype(np.int32), column.astype(np.int32)
    v, u = row - i, column - j
    top = padded[i, j] * (1 - u) + padded[i, j + 1] * u
    below = padded[i + 1, j] * (1 - u) + padded[i + 1, j + 1] * u
    return np.asarray(top * (1 - v) + below * v, np.float32)


__all__ = ["Iris", "iris_of"]
