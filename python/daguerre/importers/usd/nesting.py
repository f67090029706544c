"""Counts the copies of point instancers, nested copies too, before any copy is made."""

from __future__ import annotations

import numpy as np
from pxr import Usd, UsdGeom

from daguerre.errors import InputError

from .values import Clock

#: Maximum number of nested point instancers.
_DEEPEST = 32


class Totals:
    """Numbers of prims that point instancers draw.

    Args:
        clock: Time codes of the stage.
    """

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._found: dict[str, int] = {}
        self._open: list[str] = []

    def of(self, prim: Usd.Prim) -> int:
        """Number of shapes and lights in all copies of an instancer.

        Raises:
            InputError: The instancer contains itself, or too many instancers are nested.
        """
        path = str(prim.GetPath())
        if path in self._open or len(self._open) >= _DEEPEST:
            raise InputError(
                f"{self._clock.file}: {path}.prototypes: point instancers are nested more than "
                f"{_DEEPEST} deep, or contain themselves"
            )
        if path not in self._found:
            self._open.append(path)
            self._found[path] = self._count(UsdGeom.PointInstancer(prim))
            self._open.pop()
        return self._found[path]

    def _count(self, instancer: UsdGeom.PointInstancer) -> int:
        kinds = self._clock.integers(instancer.GetProtoIndicesAttr())
        stage, total = instancer.GetPrim().GetStage(), 0
        for i, path in enumerate(instancer.GetPrototypesRel().GetForwardedTargets()):
            copies, prototype = int(np.count_nonzero(kinds == i)), stage.GetPrimAtPath(path)
            if prototype and copies:
                total += copies * self._below(prototype)
        return total

    def _below(self, prototype: Usd.Prim) -> int:
        total = 0
        walk = Usd.PrimRange(prototype, Usd.TraverseInstanceProxies(Usd.PrimDefaultPredicate))
        prims = iter(walk)
        for prim in prims:
            if prim.IsA(UsdGeom.PointInstancer):
                total += self.of(prim)
                prims.PruneChildren()
            else:
                total += bool(prim.IsA(UsdGeom.Gprim))
        return total
