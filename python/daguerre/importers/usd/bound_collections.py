"""Bounds the work of collections that materials are bound to, before USD follows them.

A collection may include others, and USD follows each again wherever it is included, so a few
collections multiply. Here they are followed in the same way, but without their prims.

Source: OpenUSD, ``pxr/usd/usd/collectionAPI.cpp`` (a collection within itself is left out).
"""

from __future__ import annotations

from collections.abc import Iterable

from pxr import Sdf, Usd, UsdShade

from daguerre.errors import InputError

from .values import path_text

#: Begin of the names of relationships that bind a material to a collection.
BINDING = f"{UsdShade.Tokens.materialBindingCollection}:"
#: Most targets of all bound collections, each counted wherever it is included.
_MOST = 1_000_000


class BoundCollections:
    """Collections to which prims bind materials, each followed once.

    Args:
        file: File, for messages.
    """

    def __init__(self, file: str) -> None:
        self._file, self._targets = file, 0
        self._seen: set[Sdf.Path] = set()
        self._known: dict[Sdf.Path, tuple[int, list[Sdf.Path]]] = {}

    def check(self, prims: Iterable[Usd.Prim]) -> None:
        """Checks the collections that prims, or prims above them, bind.

        Raises:
            InputError: Nested collections multiply too much.
        """
        for prim in prims:
            above = prim
            while above and above.GetPath() not in self._seen:
                self._seen.add(above.GetPath())
                for name in above.GetAuthoredPropertyNames():
                    relationship = str(name).startswith(BINDING) and above.GetRelationship(name)
                    for target in relationship.GetTargets() if relationship else ():
                        self._follow(target, above.GetStage())
                above = above.GetParent()

    def _follow(self, first: Sdf.Path, stage: Usd.Stage) -> None:
        """Follows a collection, once."""
        if first in self._known:
            return
        chain: dict[Sdf.Path, None] = {}  # nested collections take no stack
        waiting = [iter([first])]
        while waiting:
            path = next(waiting[-1], None)
            if path is None:
                waiting.pop()
                if chain:
                    chain.popitem()
            elif path not in chain:
                count, inside = self._facts(path, stage)
                self._targets += count
                if self._targets > _MOST:
                    raise InputError(
                        f"{self._file}: {path_text(first)}: wanted at most {_MOST} targets of "
                        "collections, got more: they include one another"
                    )
                chain[path] = None
                waiting.append(iter(inside))

    def _facts(self, path: Sdf.Path, stage: Usd.Stage) -> tuple[int, list[Sdf.Path]]:
        """Number of targets of a collection, and the collections among them."""
        if path not in self._known:
            prim = stage.GetPrimAtPath(path.GetPrimPath())
            found: list[Sdf.Path] = []
            for name in ("includes", "excludes"):
                relationship = prim and prim.GetRelationship(f"{path.name}:{name}")
                found += relationship.GetTargets() if relationship else ()
            inside = [path for path in found if Usd.CollectionAPI.IsCollectionAPIPath(path)]
            self._known[path] = 1 + len(found), inside
        return self._known[path]
