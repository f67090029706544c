"""Participating media: fog, smoke, clouds and cloudy liquids, which absorb, scatter and emit light.

Coefficients are per metre: light loses the share exp(-(absorption + scattering) d) over d metres of
an even medium. Source: Pharr, Jakob and Humphreys 2023, Physically Based Rendering, chapter 11.
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import dataclass, field
from itertools import islice
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.argument_checks import guarded
from daguerre.checks import as_readonly, color, given_matrix, number, short, to_numbers
from daguerre.errors import InputError
from daguerre.files import formats
from daguerre.files.array_value import ArrayValue
from daguerre.files.value import FixedArrays, Value

from .spectrum import Spectrum

Color = tuple[float, float, float]
#: Maximum number of lobes of a phase function, and of elements of a density grid.
MAX_LOBES = 8
MAX_DENSITIES = 1 << 29
#: Maximum number of mean free paths along the longest edge of a density grid, all at its densest:
#: a ray takes as many steps there if its densest cells are few.
MAX_FREE_PATHS = 1e6
#: Maximum mean cosine: beyond it a lobe is narrower than a float direction resolves.
MAX_COSINE = 0.999


@dataclass(frozen=True, eq=False)
class DensityGrid(FixedArrays, ArrayValue, array="values"):
    """Densities on a grid that fills a box: factors on all coefficients of a medium.

    Densities hold at the centres of cells and are linear between them, up to the faces of the box;
    outside the density is 0.

    Attributes:
        values: Densities of at least 0, shape (Z, Y, X), float32.
        transform: World from the unit cube, shape (4, 4), in which x, y and z run along the last,
            the second and the first axis. For the inside of a mesh: local space from the unit cube;
            the grid then moves with the mesh.

    Raises:
        InputError: A shape or a number is wrong, or the transform has no inverse.
    """

    values: NDArray[np.float32]
    transform: NDArray[np.float64] = field(default_factory=lambda: np.eye(4))

    def __post_init__(self) -> None:
        where = "density grid"
        given = to_numbers(self.values, where, "values", "shape (Z, Y, X)")
        if given.ndim != 3 or given.size == 0:
            raise InputError(f"{where}: values: wanted shape (Z, Y, X), got {given.shape}")
        if given.size > MAX_DENSITIES:
            raise InputError(f"{where}: values: wanted at most {MAX_DENSITIES}, got {given.size}")
        with np.errstate(over="ignore"):
            values = as_readonly(given, np.float32)
        if not 0 <= values.min() <= values.max() < np.inf:  # false for NaN
            raise InputError(f"{where}: values: numbers must be finite and at least 0")
        transform = as_readonly(given_matrix(self.transform, where), np.float64)
        if not abs(np.linalg.det(transform[:3, :3])) > 0 or (transform[3] != (0, 0, 0, 1)).any():
            raise InputError(
                f"{where}: transform: wanted an invertible affine matrix, got "
                f"{short(transform.tolist())}"
            )
        object.__setattr__(self, "values", values)
        object.__setattr__(self, "transform", transform)

    @classmethod
    @guarded
    def load(cls, path: str | os.PathLike[str], grid: str = "") -> DensityGrid:
        """Loads a grid from a file of NanoVDB (``.nvdb``) or Mitsuba (``.vol``).

        Units and position of the box are as in the file, in metres.

        Args:
            path: The file.
            grid: Name of a grid of NanoVDB. Default: the first grid.

        Raises:
            InputError: The file is damaged, has no such grid, or its numbers are no densities.
            UsageError: A file of Mitsuba has no grids by name.
        """
        given: dict[str, Any] = {"grid": grid} if grid else {}
        return formats.read("density", path, **given)  # type: ignore[no-any-return]

    def __repr__(self) -> str:
        return "<DensityGrid {2}x{1}x{0}>".format(*self.values.shape)


@dataclass(frozen=True, eq=False)
class Medium(Value):
    """A medium that absorbs, scatters and emits light; it fills a closed mesh or the world.

    Coefficients are colour triples of any size or spectra, 1/m. Set it as ``Material.interior`` of
    a closed mesh, or as the fog of a scene (:meth:`Scene.set_fog`).

    Attributes:
        absorption: Absorption coefficient, 1/m.
        scattering: Scattering coefficient, 1/m.
        lobes: Phase function: pairs (g, weight) of Henyey-Greenstein lobes. g is the mean cosine of
            the angle that light turns by, above 0: forward, -0.999 to 0.999; weights are shares.
        emission: Luminance that a metre of the medium adds at density 1, cd/m2 per m; a spectrum
            multiplies D65 of 1 cd/m2, as a triple does.
        density: Grid of factors on absorption, scattering and emission; None: 1 everywhere.

    Raises:
        InputError: A value is wrong, or the grid is thicker than a ray can be followed through;
            the message names it.
    """

    absorption: Color | Spectrum = (0.0, 0.0, 0.0)
    scattering: Color | Spectrum = (0.0, 0.0, 0.0)
    lobes: tuple[tuple[float, float], ...] = ((0.0, 1.0),)
    emission: Color | Spectrum = (0.0, 0.0, 0.0)
    density: DensityGrid | None = None

    def __post_init__(self) -> None:
        for name in ("absorption", "scattering", "emission"):
            object.__setattr__(self, name, _coefficient(getattr(self, name), f"medium: {name}"))
        object.__setattr__(self, "lobes", _lobes(self.lobes))
        grid: object = self.density
        if grid is not None and not isinstance(grid, DensityGrid):
            raise InputError(f"medium: density: wanted a DensityGrid or None, got {short(grid)}")
        if grid is not None and not (paths := self._free_paths(grid)) <= MAX_FREE_PATHS:
            raise InputError(
                f"medium: density: wanted at most {MAX_FREE_PATHS:g} mean free paths along the "
                f"grid's longest edge, at its densest, got {paths:g}"
            )

    def _free_paths(self, grid: DensityGrid) -> float:
        edge = float(np.linalg.norm(grid.transform[:3, :3], axis=0).max())
        return float(grid.values.max()) * edge * (_most(self.absorption) + _most(self.scattering))


def check_medium(medium: object, where: str) -> None:
    """Checks that a value is a medium or None; a medium has checked itself.

    Raises:
        InputError: It is something else.
    """
    if medium is not None and not isinstance(medium, Medium):
        raise InputError(f"{where}: wanted a Medium or None, got {short(medium)}")


def check_media(interior: object, exterior: object, where: str) -> None:
    """Checks the media on both sides of a surface.

    Raises:
        InputError: A value is neither a medium nor None.
    """
    check_medium(interior, f"{where}: interior")
    check_medium(exterior, f"{where}: exterior")


def check_fog(medium: Any, where: str) -> None:
    """Checks a medium that has no end, or None.

    Raises:
        InputError: It is something else, or shines without losing light, so that it adds up to
            infinity.
    """
    check_medium(medium, where)
    if medium is None or medium.density is not None or not _any(medium.emission):
        return
    if not (_any(medium.absorption) or _any(medium.scattering)):
        raise InputError(
            f"{where}: emission: a medium without bounds that emits must also absorb or scatter"
        )


def _any(value: Color | Spectrum) -> bool:
    return _most(value) > 0


def _most(value: Color | Spectrum) -> float:
    return max(value.values if isinstance(value, Spectrum) else value)


def _coefficient(value: object, where: str) -> Color | Spectrum:
    return value if isinstance(value, Spectrum) else color(value, where)


def _lobes(given: Iterable[tuple[float, float]]) -> tuple[tuple[float, float], ...]:
    wanted = f"medium: lobes: wanted 1 to {MAX_LOBES} pairs (g, weight)"
    try:
        pairs = [(g, weight) for g, weight in islice(given, MAX_LOBES + 1)]
    except (TypeError, ValueError):
        raise InputError(f"{wanted}, got {short(given)}") from None
    if not 1 <= len(pairs) <= MAX_LOBES:
        raise InputError(f"{wanted}, got {len(pairs) if len(pairs) <= MAX_LOBES else 'more'}")
    lobes = []
    for i, (g, weight) in enumerate(pairs):
        where = f"medium: lobes[{i}]"
        mean_cosine = number(g, f"{where}: g", -MAX_COSINE, MAX_COSINE, error=InputError)
        lobes.append((mean_cosine, number(weight, f"{where}: weight", 0, error=InputError)))
    if not 0 < sum(weight for _, weight in lobes) < np.inf:
        raise InputError("medium: lobes: all weights are 0")
    return tuple(lobes)
