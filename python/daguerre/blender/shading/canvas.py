"""Canvas: texels of a surface and their coordinates, at which patterns are computed.

A pattern of texture coordinates alone needs the range of coordinates that a surface uses. Any other
pattern needs the position on the surface at each texel, so its texture must cover the surface
without overlap.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.blender.raster import Raster
from daguerre.checks import freeze_in_place
from daguerre.shading.channels import Channel, Coordinate, Mapping, Plane, Texel, Value
from daguerre.shading.lookup import looked_up

from .surfaces import MaterialFaces

Array = NDArray[Any]
#: Longer side of the trial canvas of a material; only trial canvases are measured.
TRIAL = 128
#: Quantile of the steps between texels that sets the size of a canvas.
_MOST_STEPS = 80
#: Least extent of a range of coordinates.
_LEAST = 1e-6


class Canvas(ABC):
    """Texels of a surface.

    Args:
        surface: The surface.
        primvar: Texture coordinates that the canvas lies on.
        span: Least and largest of these, shape (2, 2).
        size: Rows and columns.

    Attributes:
        mapping: How the canvas lies on the surface.
        size: Rows and columns.
        need: Texels that patterns and pictures want, per texel and axis, if this is a trial.
    """

    def __init__(
        self, surface: MaterialFaces, primvar: str, span: Array, size: tuple[int, int]
    ) -> None:
        self._surface = surface
        self.size = size
        self.need = 0.0
        low, extent = span[0], np.maximum(span[1] - span[0], _LEAST)
        across, up = (float(one) for one in 1 / extent)
        transform = (across, 0.0, float(-low[0] * across), 0.0, up, float(-low[1] * up))
        self.mapping = Mapping(primvar, transform, ("clamp", "clamp"))

    @abstractmethod
    def uv(self, primvar: str) -> tuple[Array, Array]:
        """Texture coordinates at all texels, each (H, W)."""

    @abstractmethod
    def vector(self, name: str) -> Value | None:
        """Coordinates of three axes at all texels: "Generated", "Object" or "Position"."""

    @property
    def inside(self) -> Array | None:
        """Texels that lie on the surface; None: all."""
        return None

    def placed(self, channel: Channel) -> Channel:
        """Coordinates, or a picture that lies otherwise, as texels of this canvas."""
        if isinstance(channel, Coordinate):
            u, v = self.uv(channel.primvar)
            return self.texel(channel.a * u + channel.b * v + channel.c)
        if not isinstance(channel, Texel) or channel.mapping == self.mapping:
            return channel
        u, v = self.uv(channel.mapping.primvar)
        self._measure_picture(channel, u, v)
        return self.texel(looked_up(channel, u, v))

    def texel(self, values: Array) -> Texel:
        """Texels of values, shape (H, W)."""
        pixels = np.ascontiguousarray(np.broadcast_to(values, self.size), np.float32)
        return Texel(Plane(freeze_in_place(pixels), name="pattern"), self.mapping)

    def _measure_picture(self, texel: Texel, u: Array, v: Array) -> None:
        a, b, _, d, e, _ = texel.mapping.transform
        height, width = texel.plane.pixels.shape
        self._measured([(a * u + b * v) * width, (d * u + e * v) * height], 1.0)

    def measure(self, point: Value, texels: float) -> None:
        """Notes how fine a pattern is.

        Args:
            point: Its coordinates, in units of its cells.
            texels: Texels that a cell needs.
        """
        arrays = [one.values() for one in point if isinstance(one, Texel)]
        self._measured([one for one in arrays if one.shape == self.size], texels)

    def _measured(self, arrays: list[Array], texels: float) -> None:
        if max(self.size) > TRIAL:
            return
        inside = self.inside
        for values in arrays:
            for axis in (0, 1):
                steps = np.abs(np.diff(values, axis=axis))
                if inside is not None:
                    steps = steps[np.delete(inside, 0, axis) & np.delete(inside, -1, axis)]
                steps = steps[np.isfinite(steps)]
                if steps.size:
                    step = float(np.percentile(steps, _MOST_STEPS))
                    self.need = max(self.need, step * texels)


class UvCanvas(Canvas):
    """Texels of a range of texture coordinates."""

    def uv(self, primvar: str) -> tuple[Array, Array]:
        """Texture coordinates at all texels; another map than the canvas' own is 0."""
        height, width = self.size
        if primvar != self.mapping.primvar:
            return np.zeros(self.size), np.zeros(self.size)
        a, _, c, _, e, f = self.mapping.transform
        u = ((np.arange(width) + 0.5) / width - c) / a
        v = (1 - (np.arange(height) + 0.5) / height - f) / e
        return np.broadcast_to(u, self.size), np.broadcast_to(v[:, None], self.size)

    def vector(self, name: str) -> Value | None:
        """Nothing: the place on the surface is not known."""
        return None


class SurfaceCanvas(Canvas):
    """Texels of a surface on which a map of texture coordinates lies without overlap.

    Args:
        surface: The surface.
        primvar: Texture coordinates that the canvas lies on.
        span: Least and largest of these, shape (2, 2).
        raster: Triangles at the texels.
    """

    def __init__(self, surface: MaterialFaces, primvar: str, span: Array, raster: Raster) -> None:
        height, width = raster.triangle.shape
        super().__init__(surface, primvar, span, (height, width))
        self._raster = raster
        self._known: dict[str, Value] = {}

    @property
    def inside(self) -> Array:
        """Texels that lie on the surface."""
        return self._raster.inside

    def uv(self, primvar: str) -> tuple[Array, Array]:
        """Texture coordinates at all texels."""
        found = self._raster.values(self._surface.uv(primvar))
        return found[:, :, 0], found[:, :, 1]

    def vector(self, name: str) -> Value | None:
        """Coordinates of three axes at all texels."""
        if name not in self._known:
            corners = self._surface.vector(name)
            if corners is None:
                return None
            found = self._raster.values(corners)
            self._known[name] = tuple(self.texel(found[:, :, i]) for i in range(3))
        return self._known[name]
