"""Reads primvars: values of a surface, each with its interpolation."""

from __future__ import annotations

import numpy as np
from pxr import Usd, UsdGeom

from daguerre.files.notes import Notes
from daguerre.scene.over_time.surfaces import Array, Primvar

from .values import Clock


def read_primvar(prim: Usd.Prim, name: str, columns: int, clock: Clock) -> Primvar | None:
    """Reads a primvar of a prim, authored or inherited, at the scene's time.

    Args:
        prim: The prim.
        name: Name, without ``primvars:``.
        columns: Number of components.
        clock: Time codes of the stage.

    Returns:
        The primvar; None: missing, or of another type.
    """
    found = UsdGeom.PrimvarsAPI(prim).FindPrimvarWithInheritance(name)
    if not found or not found.HasValue():
        return None
    values = as_rows(found.Get(clock.code), columns)
    if values is None:
        return None
    indices = None
    if found.IsIndexed():
        indices = np.asarray(found.GetIndices(clock.code), np.int64)
        if indices.size and not (indices.min() >= 0 and indices.max() < len(values)):
            return None
    return Primvar(values, str(found.GetInterpolation()), indices)


def as_rows(value: object, columns: int) -> Array | None:
    """Converts a value of USD to an array (N, columns) of finite numbers; None: another type."""
    try:
        rows = np.asarray(value, np.float32)
    except (TypeError, ValueError):
        return None
    if columns == 1 and rows.ndim < 2:
        rows = rows.reshape(-1, 1)
    elif rows.ndim == 1:
        rows = rows.reshape(1, -1)
    if rows.ndim != 2 or rows.shape[1] < columns or not np.isfinite(rows).all():
        return None
    return np.ascontiguousarray(rows[:, :columns])


def note_length(name: str, notes: Notes) -> None:
    """Notes a primvar with a wrong number of values for its mesh."""
    notes.add(f"primvar {name[:40]!r} has the wrong number of values for its mesh and is left out")
