"""Finds the materials of prims and of subsets of their faces."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import Sdf, Usd, UsdGeom, UsdShade

from daguerre.files.notes import Notes

from .bound_collections import BoundCollections
from .materials import Materials
from .meshes import Choice, uv_names
from .primvars import read_primvar
from .values import Clock

#: Colour of prims without a material and without a colour: as in USD's preview surface.
_GREY = (0.18, 0.18, 0.18)
#: Largest number of materials made for the colours of a prim's elements.
_MAX_COLORS = 512


@dataclass(frozen=True, eq=False)
class Part:
    """Faces of a prim with one material.

    Attributes:
        choice: Faces and coordinates that they need of the mesh.
        faces: Faces of the file; None for all.
        material: Index of the material.
    """

    choice: Choice
    faces: NDArray[np.int64] | None
    material: int


class Bindings:
    """Materials of the prims of a stage.

    Args:
        materials: Reader of materials.
        clock: Time codes of the stage.
        notes: Receives notes on materials that are missing.
        collections: Check of collections that are bound; None: there are none.
    """

    def __init__(
        self,
        materials: Materials,
        clock: Clock,
        notes: Notes,
        collections: BoundCollections | None = None,
    ) -> None:
        self._materials, self._collections = materials, collections
        self._clock = clock
        self._notes = notes
        self._seen: set[Sdf.Path] = set()
        #: Paths of materials that USD finds, by prim.
        self._of_usd: dict[Sdf.Path, Sdf.Path | None] = {}

    @property
    def clock(self) -> Clock:
        """Time codes of the stage."""
        return self._clock

    def prefetch(self, prims: Iterable[Usd.Prim]) -> None:
        """Finds the materials of prims and of their subsets, and begins to decode pictures."""
        found = [p for prim in prims for p in (prim, *_subsets(UsdShade.MaterialBindingAPI(prim)))]
        if not found:
            return
        if self._collections is not None:
            self._collections.check(found)
        api, purpose = UsdShade.MaterialBindingAPI, UsdShade.Tokens.full
        materials, _ = api.ComputeBoundMaterials(found, purpose)  # looks at each collection once
        for prim, material in zip(found, materials, strict=True):
            self._of_usd[prim.GetPath()] = path = material.GetPath() if material else None
            path = self._materials.bound_path(prim) if path is None else path
            if path is not None and path not in self._seen:
                self._seen.add(path)
                self._materials.prefetch(prim.GetStage(), path)

    def parts(self, prim: Usd.Prim, faces: int) -> list[Part]:
        """Parts of a mesh with ``faces`` faces: its subsets with materials, and the other faces."""
        found, left = [], np.ones(faces, bool)
        for subset in UsdShade.MaterialBindingAPI(prim).GetMaterialBindSubsets():
            if str(subset.GetElementTypeAttr().Get()) != "face":
                continue
            chosen = self._clock.integers(subset.GetIndicesAttr())
            chosen = chosen[(chosen >= 0) & (chosen < faces)]
            chosen = chosen[left[chosen]]
            left[chosen] = False
            if len(chosen):
                found.append(self._part(subset.GetPrim(), prim, chosen))
        if not found:
            return [self._part(prim, prim, None)]
        if left.any():
            found.append(self._part(prim, prim, np.flatnonzero(left), rest=True))
        return found

    def bound(self, prim: Usd.Prim) -> bool:
        """Whether a prim has a material."""
        return self._bound(prim) is not None

    def whole(self, prim: Usd.Prim, *, colored: bool = False) -> int:
        """Index of the material of a prim without subsets of faces.

        Args:
            prim: The prim.
            colored: Whether the prim has colours, which multiply the material's.
        """
        if colored and self._bound(prim) is None:
            return self._materials.displayed()
        return self._part(prim, prim, None).material

    def colors(self, prim: Usd.Prim, count: int) -> list[tuple[int, NDArray[np.int64]]]:
        """Materials of the ``count`` elements of a prim, each with the numbers of its elements.

        Colours by element are gathered in at most ``_MAX_COLORS`` materials.
        """
        color = read_primvar(prim, "displayColor", 3, self._clock)
        if self._bound(prim) is not None or color is None or len(color) != count or count == 1:
            return [(self.whole(prim), np.arange(count))]
        rows = np.clip(color.flat, 0, 1)
        for steps in (255, 63, 15, 7):  # coarser, until there are few
            levels, index = np.unique(np.round(rows * steps), axis=0, return_inverse=True)
            if len(levels) <= _MAX_COLORS:
                break
        index = index.reshape(-1)
        order = np.argsort(index, kind="stable")
        groups = np.split(order, np.cumsum(np.bincount(index))[:-1])
        return [
            (self._materials.displayed(tuple((level / steps).tolist()), 1.0), group)
            for level, group in zip(levels, groups, strict=True)
        ]

    def _bound(self, prim: Usd.Prim) -> Sdf.Path | None:
        """Path of the material of a prim; it may be in a ``.mtlx`` file that USD does not read."""
        if prim.GetPath() not in self._of_usd:
            self.prefetch([prim])
        path = self._of_usd[prim.GetPath()]
        if path is not None:
            return path
        path = self._materials.bound_path(prim)
        if path is not None and not self._materials.has(prim.GetStage(), path):
            self._notes.add("a bound material is missing: the prim has its displayColor")
            return None
        return path

    def _part(self, bound: Usd.Prim, prim: Usd.Prim, faces: Any, *, rest: bool = False) -> Part:
        subset = "the rest" if rest else bound.GetName() if bound != prim else ""
        path = self._bound(bound)
        if path is not None:
            stage = prim.GetStage()
            names = UsdGeom.PrimvarsAPI(prim).FindPrimvarsWithInheritance()
            has = frozenset(str(primvar.GetPrimvarName()) for primvar in names)
            index = self._materials.index_at(stage, path, has)
            sets = uv_names(self._materials.uv_sets_at(stage, path), prim)
            colored = self._materials.reads_vertex_colors(stage, path)
            return Part(Choice(subset, sets, colored), faces, index)
        color = read_primvar(prim, "displayColor", 3, self._clock)
        opacity = read_primvar(prim, "displayOpacity", 1, self._clock)
        colored = color is not None and len(color) != 1
        shown = _GREY if color is None or not len(color) else tuple(map(float, color.flat[0]))
        alpha: Any = None
        if opacity is not None and len(opacity):
            varies = colored and len(opacity) != 1
            alpha = [] if varies else float(opacity.flat[0, 0])  # a list: the vertices' opacity
        index = self._materials.displayed(None if colored else shown, alpha)
        return Part(Choice(subset, uv_names((), prim), colored), faces, index)


def _subsets(api: UsdShade.MaterialBindingAPI) -> list[Usd.Prim]:
    """Prims of the subsets of a prim that have materials."""
    return [subset.GetPrim() for subset in api.GetMaterialBindSubsets()]
