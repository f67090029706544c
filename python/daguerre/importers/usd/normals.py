"""Reads normals of polygon meshes, constant or over time."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import Usd, UsdGeom

from daguerre.files.notes import Notes
from daguerre.motion.values import Keys, keys
from daguerre.scene.over_time.surfaces import Array, DrawnPolygons, Primvar

from .primvars import as_rows, note_length, read_primvar
from .values import Clock

#: Most numbers in all time samples of an attribute.
_MAX_NUMBERS = 1 << 30


@dataclass(frozen=True, eq=False)
class Normals:
    """Normals at the corners of a mesh.

    Attributes:
        now: Unit normals at the scene's time, shape (C, 3).
        moving: Normals of the file over time, of any length, shape (N, 3); None: they do not
            change.
        rows: Row of each corner in ``moving``, shape (C,).
        alike: Number of each corner, equal for corners whose normals are equal at all times, (C,).
    """

    now: Array
    moving: Keys | None = None
    rows: NDArray[np.int64] | None = None
    alike: NDArray[np.uint64] | None = None


def read_normals(
    prim: Usd.Prim, surface: DrawnPolygons, clock: Clock, notes: Notes
) -> Normals | None:
    """Reads the normals of a polygon mesh; None: it is flat.

    Args:
        prim: The mesh.
        surface: Its polygons.
        clock: Time codes of the stage.
        notes: Receives notes on normals that cannot be used.

    Raises:
        InputError: There are too many time samples.
    """
    found = _primvar(prim, surface, clock, notes)
    if found is None:
        return None
    primvar, attribute = found
    corners = surface.corners(primvar)
    if corners is None:
        note_length("normals", notes)
        return None
    lengths = np.linalg.norm(corners, axis=1, keepdims=True)
    if (lengths <= 1e-20).any():
        notes.add("normals of length 0: the mesh is flat")
        return None
    now = np.asarray(corners / lengths, np.float32)
    moving = _over_time(attribute, primvar.values, clock, notes)
    if moving is None:
        return Normals(now)
    path, alike = moving
    numbers: Any = np.arange(len(primvar.values))
    rows = surface.corners(Primvar(numbers, primvar.interpolation, primvar.indices))
    assert rows is not None
    which = np.asarray(rows, np.int64)
    return Normals(now, path, which, alike[which])


def _primvar(
    prim: Usd.Prim, surface: DrawnPolygons, clock: Clock, notes: Notes
) -> tuple[Primvar, Usd.Attribute] | None:
    """Normals and their attribute: ``primvars:normals`` if it fits, else ``normals``."""
    primvar = read_primvar(prim, "normals", 3, clock)
    if primvar is not None:
        if surface.corners(primvar) is not None:
            return primvar, UsdGeom.PrimvarsAPI(prim).FindPrimvarWithInheritance(
                "normals"
            ).GetAttr()
        note_length("normals", notes)
    mesh = UsdGeom.Mesh(prim)
    attribute = mesh.GetNormalsAttr()
    rows = as_rows(attribute.Get(clock.code), 3)
    if rows is None or not len(rows):
        return None
    return Primvar(rows, str(mesh.GetNormalsInterpolation())), attribute


def _over_time(
    attribute: Usd.Attribute, now: Array, clock: Clock, notes: Notes
) -> tuple[Keys, NDArray[np.uint64]] | None:
    """Normals over time, and a number for each row; None: they do not change."""
    codes = clock.codes(attribute)
    if len(codes) < 2:
        return None
    alike, changes = np.zeros(len(now), np.uint64), False
    for rows in _samples(attribute, codes):
        if rows is None or rows.shape != now.shape or now.size * len(codes) > _MAX_NUMBERS:
            notes.add("normals over time that cannot be used keep the value of the scene's time")
            return None
        changes = changes or not np.array_equal(rows, now)
        alike = _mixed(alike, rows)
    if not changes:
        return None
    needed = clock.around(codes)
    times = [clock.seconds(code) for code in codes[needed]]
    how = "step" if clock.holds else "linear"
    kept = tuple(rows for rows in _samples(attribute, codes[needed]) if rows is not None)
    if clock.borrows:
        return Keys(np.array(times), kept, how), alike
    return keys(zip(times, kept, strict=True), how), alike


def _samples(attribute: Usd.Attribute, codes: list[float]) -> Iterator[Array | None]:
    return (as_rows(attribute.Get(Usd.TimeCode(code)), 3) for code in codes)


def _mixed(numbers: NDArray[np.uint64], rows: Array) -> NDArray[np.uint64]:
    """Mixes the bits of rows into their numbers. Source: Steele et al. 2014, SplitMix."""
    for bits in rows.view(np.uint32).T:
        numbers = (numbers ^ bits) * np.uint64(0x9E3779B97F4A7C15)
        numbers ^= numbers >> np.uint64(32)
    return numbers
