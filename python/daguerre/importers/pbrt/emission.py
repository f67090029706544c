"""Reads ``AreaLightSource``: the light of surfaces.

In pbrt each triangle and each bilinear patch of a mesh is a separate light, and so has the whole
``power``; a sphere, a disk or a cylinder is a single light.

Source: ``DiffuseAreaLight`` of pbrt-v4, ``DiffuseAreaLight`` of pbrt-v3.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daguerre.shading.images import Images

from .ledger import Ledger
from .shapes import LocalMesh
from .spectra import Color, Spectra, luminance, scaled
from .state import Entity

Array = NDArray[np.float64]
#: Most groups of triangles with separate lights; more get the mean.
_MOST_GROUPS = 32


@dataclass(frozen=True)
class Emission:
    """Light of a surface.

    Attributes:
        color: Luminance, cd/m2.
        two_sided: Whether the back shines too.
        picture: Name of a picture of factors; empty: none.
        directive: Directive, for messages.
    """

    color: Color = (0.0, 0.0, 0.0)
    two_sided: bool = False
    picture: str = ""
    directive: Entity | None = None


DARK = Emission()


class Emissions:
    """Reads the light of surfaces.

    Args:
        spectra: Spectra of the scene.
        images: Pictures of the scene.
        version: Version of pbrt, 3 or 4.
        ledger: Counts directives.
    """

    def __init__(self, spectra: Spectra, images: Images, version: int, ledger: Ledger) -> None:
        self._spectra, self._images = spectra, images
        self._version, self._ledger = version, ledger

    def of(
        self, entity: Entity | None, surface: LocalMesh, world: Array
    ) -> list[tuple[Emission, NDArray[np.bool_] | None]]:
        """Light of a surface, and the triangles that emit it; None: all.

        Args:
            entity: Directive, or None.
            surface: The surface.
            world: World from its space, shape (4, 4).
        """
        if entity is None:
            return [(DARK, None)]
        if entity.kind not in ("diffuse", "area"):
            sentence = f"an AreaLightSource of kind {entity.kind[:40]!r} is left out"
            self._ledger.note(entity.place, sentence)
            return [(DARK, None)]
        emission, power = self._read(entity)
        self._ledger.use(entity.place)
        if power <= 0:
            return [(emission, None)]
        return self._by_power(emission, power, surface, world)

    def _read(self, entity: Entity) -> tuple[Emission, float]:
        parameters = entity.parameters
        color = self._spectra.light(parameters.find("L"))
        color = scaled_by(entity, color, self._spectra)
        for name in ("nsamples", "samples"):
            parameters.find(name)
        name = parameters.text("filename")
        emission = Emission(color, parameters.flag("twosided", False), name, entity)
        power = parameters.number("power", -1.0)
        self._ledger.tell_unread(parameters, entity.place, entity.kind)
        return emission, power

    def _by_power(
        self, emission: Emission, power: float, surface: LocalMesh, world: Array
    ) -> list[tuple[Emission, NDArray[np.bool_] | None]]:
        sides = 2 if emission.two_sided else 1
        mean = self._mean_of(emission)
        per_area = power / (sides * math.pi * mean) if mean > 0 else 0.0
        if surface.area is not None:
            return [(_with(emission, per_area / surface.area if surface.area > 0 else 0.0), None)]
        areas, total, count = _areas_of_lights(surface, world)
        if not total > 0:
            return [(DARK, None)]
        rounded = np.round(np.log(np.maximum(areas, 1e-30)) / 1e-3)
        sizes, groups = np.unique(rounded, return_inverse=True)
        if len(sizes) > _MOST_GROUPS:
            self._ledger.notes.add(
                "a mesh with triangles of many sizes spreads its power evenly over them"
            )
            return [(_with(emission, per_area * count / total), None)]
        found: list[tuple[Emission, NDArray[np.bool_] | None]] = []
        for group in range(len(sizes)):
            chosen = groups.reshape(-1) == group
            area = float(areas[chosen].mean())
            found.append((_with(emission, per_area / area if area > 0 else 0.0), chosen))
        return [(found[0][0], None)] if len(found) == 1 else found

    def _mean_of(self, emission: Emission) -> float:
        """Mean luminance of the picture of factors."""
        assert emission.directive is not None
        if not emission.picture:
            return 1.0
        place = str(emission.directive.place)
        picture = self._images.picture(place, emission.picture)
        if picture is None:
            return 1.0
        red, green, blue, _ = picture.planes(srgb=picture.pixels.dtype == np.uint8)
        means = [float(plane.linear().mean(dtype=np.float64)) for plane in (red, green, blue)]
        return luminance((means[0], means[1], means[2]))


def scaled_by(entity: Entity, color: Color, spectra: Spectra) -> Color:
    """Product of a light's color and its ``scale``, which is a color in pbrt-v3."""
    found = entity.parameters.find("scale")
    if found is None or found.type in ("float", "integer"):
        return scaled(color, entity.parameters.number("scale", 1.0, 0.0))
    red, green, blue = (a * b for a, b in zip(color, spectra.coefficient(found), strict=True))
    return red, green, blue


def _with(emission: Emission, luminance_factor: float) -> Emission:
    color = scaled(emission.color, luminance_factor)
    return Emission(color, emission.two_sided, emission.picture, emission.directive)


def _areas_of_lights(surface: LocalMesh, world: Array) -> tuple[Array, float, int]:
    """Area of the light of each triangle, m2; area and number of all lights."""
    corners = surface.positions[surface.triangles].astype(np.float64) @ world[:3, :3].T
    sides = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = 0.5 * np.linalg.norm(sides, axis=1)
    patch = np.arange(len(areas)) if surface.patch is None else surface.patch
    sums = np.asarray(np.bincount(patch, areas), np.float64)
    return sums[patch], float(sums.sum()), int(np.count_nonzero(sums))
