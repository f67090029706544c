"""Participating media: ``homogeneous`` and ``heterogeneous``, with their phase functions.

Source: Mitsuba 3, documentation of media, phase functions and volumes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import InputError, asked_by
from daguerre.importers.volumes import vol
from daguerre.scene.materials import Color, Spectrum
from daguerre.scene.media import MAX_COSINE, MAX_LOBES, DensityGrid, Medium

from .context import Context
from .node import Node, leave_out
from .textures import Textures

_GRIDS = ("gridvolume", "grid")
Lobes = tuple[tuple[float, float], ...]
Matrix = NDArray[np.float64]


@dataclass(frozen=True)
class Grid:
    """Densities of a medium, and the hue of its extinction."""

    density: DensityGrid
    color: Color


class Media:
    """Media of a scene file.

    Args:
        context: File, unit and notes.
        textures: Reads colours and spectra.
    """

    def __init__(self, context: Context, textures: Textures) -> None:
        self._context, self._textures, self._notes = context, textures, context.notes
        self._world = context.world
        self._known: dict[Any, Medium | None] = {}
        self._bounded: set[int] = set()

    def inside(self, node: Node, local: Matrix) -> Medium | None:
        """Medium inside of a shape."""
        self._bounded.add(id(node))
        return self.medium(node, local)

    def around(self, node: Node | None) -> Medium | None:
        """Medium around a camera that fills the world; None: no medium, or shapes bound it.

        A medium inside of a shape ends at the shape; where the camera is says which it sees.
        """
        if node is None or id(node) in self._bounded:
            return None
        return self.medium(node, self._world)

    def medium(self, node: Node | None, local: Matrix) -> Medium | None:
        """Medium of an object; ``local`` is the scene from the space of the mesh around it."""
        if node is None:
            return None
        placed = node.plugin == "heterogeneous"
        if placed and not abs(np.linalg.det(local)) > 0:
            node.fail("the transform of the mesh around it has no inverse")
        key = (id(node), local.tobytes() if placed else b"")
        if key not in self._known:
            self._known[key] = self._read(node, local)
        return self._known[key]

    def _read(self, node: Node, local: Matrix) -> Medium | None:
        if node.plugin not in ("homogeneous", "heterogeneous"):
            leave_out(node, self._notes, f"a medium {node.plugin[:40]!r} is left out")
            return None
        node.use()
        node.skip("sample_emitters", "has_spectral_extinction", "method", "step_size")
        scale = node.number("scale", 1.0, 0.0) / self._context.unit_m
        lobes = self._phase(node.nested_one("phase"))
        grid, missing = self._grid(node, local)
        hue = (1.0, 1.0, 1.0) if grid is None else grid.color
        absorption, scattering = self._coefficients(node, scale, hue)
        emission = self._emission(node)
        if missing:
            self._notes.add("a medium whose file is missing is left out", name=missing)
            return None
        return Medium(
            absorption, scattering, lobes, emission, None if grid is None else grid.density
        )

    def _coefficients(
        self, node: Node, scale: float, hue: Color
    ) -> tuple[Color | Spectrum, Color | Spectrum]:
        """Absorption and scattering, 1/m."""
        if node.has("sigma_a") or node.has("sigma_s"):
            absorbed, scattered = (self._color(node, name, 0.0) for name in ("sigma_a", "sigma_s"))
            return _scaled(absorbed, scale), _scaled(scattered, scale)
        if node.has("material"):
            node.fail("material: measured materials are not supported; set sigma_t and albedo")
        extinction = self._color(node, "sigma_t", 1.0, hue)
        albedo = self._color(node, "albedo", 0.75)
        return (
            _combined(lambda t, a: scale * t * (1 - a), extinction, albedo),
            _combined(lambda t, a: scale * t * a, extinction, albedo),
        )

    def _color(
        self, node: Node, name: str, default: float, hue: Color = (1.0, 1.0, 1.0)
    ) -> Color | Spectrum:
        """Coefficient; for a grid ``hue``, as the grid's values are densities."""
        found = node.find(name)
        if found is None or not isinstance(found.value, Node) or found.value.kind != "volume":
            return self._textures.color(node, name, default)
        volume = found.value
        found.take()
        if volume.plugin == "constvolume":
            volume.use()
            return self._textures.color(volume, "value", 1.0)
        if volume.plugin in _GRIDS and name == "sigma_t":
            return hue
        sentence = f"{name} that varies in space is replaced by {default:g}"
        leave_out(volume, self._notes, sentence)
        return default, default, default

    def _grid(self, node: Node, local: Matrix) -> tuple[Grid | None, str]:
        """Grid of extinction, None: the medium is even, and without end; name of a missing file."""
        found = node.find("sigma_t")
        volume = None if found is None else found.value
        if found is not None and isinstance(volume, Node) and volume.plugin in _GRIDS:
            found.take()
            grid = self._of_file(volume, local)
            return grid, "" if grid else volume.text("filename")
        if node.plugin == "homogeneous":
            return None, ""
        # Mitsuba's heterogeneous media fill the unit cube of their extinction alone.
        box = volume.transform() if isinstance(volume, Node) else np.eye(4)
        placed = np.linalg.inv(local) @ self._world @ box
        return Grid(DensityGrid(np.ones((1, 1, 1), np.float32), placed), (1.0, 1.0, 1.0)), ""

    def _of_file(self, volume: Node, local: Matrix) -> Grid | None:
        """Grid of a file; None: missing."""
        volume.use()
        volume.skip("filter_type", "wrap_mode", "accel", "raw", "max_value")
        files = self._context.document.files_of(volume)
        file = files.find(volume.text("filename"), volume.entry)
        box = volume.flag("use_grid_bbox", False)
        placing = volume.transform()
        if file is None:
            return None
        with asked_by(volume.entry):
            read = vol.read(file)
        inner = read.transform if box else np.eye(4)
        placed = np.linalg.inv(local) @ self._world @ placing @ inner
        values = read.values.mean(axis=3)
        color = (1.0, 1.0, 1.0)
        if read.values.shape[3] == 3:
            self._notes.add("a grid of colours in a medium takes the hue of its mean")
            mean = max(float(values.mean()), 1e-30)
            r, g, b = read.values.mean(axis=(0, 1, 2), dtype=np.float64) / mean
            color = (float(r), float(g), float(b))
        try:
            return Grid(DensityGrid(values, placed), color)
        except InputError as error:
            volume.fail(f"{file}: {error}")

    def _emission(self, node: Node) -> Color | Spectrum:
        found = node.find("emission")
        if found is None:
            return 0.0, 0.0, 0.0
        return _scaled(self._color(node, "emission", 0.0), 1 / self._context.unit_m)

    def _phase(self, node: Node | None) -> Lobes:
        """Lobes of a phase function, with weights that add to 1."""
        if node is None:
            return ((0.0, 1.0),)
        if node.plugin == "blendphase":
            node.use()
            return self._blended(node)
        if node.plugin == "isotropic":
            node.use()
            return ((0.0, 1.0),)
        if node.plugin == "hg":
            node.use()
            return ((min(max(node.number("g", 0.8), -MAX_COSINE), MAX_COSINE), 1.0),)
        name = node.plugin[:40]
        leave_out(node, self._notes, f"a phase function {name!r} is replaced by an isotropic one")
        return ((0.0, 1.0),)

    def _blended(self, node: Node) -> Lobes:
        found = node.nested("phase")
        if len(found) != 2:
            node.fail(f"wanted two phase functions inside, got {len(found)}")
        share = min(max(node.number("weight", 0.5), 0.0), 1.0)
        lobes = [
            (g, weight * part)
            for phase, part in zip(found, (1 - share, share), strict=True)
            for g, weight in self._phase(phase)
        ]
        if len(lobes) > MAX_LOBES:
            node.fail(f"wanted at most {MAX_LOBES} phase functions, got {len(lobes)}")
        return tuple(lobes)


def _scaled(value: Color | Spectrum, factor: float) -> Color | Spectrum:
    return _combined(lambda a, b: factor * a, value, value)


def _combined(
    function: Callable[[Any, Any], Any], a: Color | Spectrum, b: Color | Spectrum
) -> Color | Spectrum:
    """Applies a function to two colours, or to spectra at all their samples."""
    if not isinstance(a, Spectrum) and not isinstance(b, Spectrum):
        x, y, z = (max(float(function(p, q)), 0.0) for p, q in zip(a, b, strict=True))
        return x, y, z
    nm = sorted({n for v in (a, b) if isinstance(v, Spectrum) for n in v.wavelengths_nm})
    first, second = (v.at(nm) if isinstance(v, Spectrum) else _mean(v) for v in (a, b))
    return Spectrum(tuple(nm), tuple(np.maximum(function(first, second), 0).tolist()))


def _mean(color: Color) -> float:
    """Value of a grey colour at all wavelengths; of other colours the mean."""
    return sum(color) / 3
