"""Walks the prims of a stage, parents before children, with the values that children inherit."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass, replace

from pxr import Usd, UsdGeom

from daguerre.cached import cached_property
from daguerre.errors import InputError
from daguerre.files.notes import Notes
from daguerre.scene.over_time.emission import Shown
from daguerre.scene.over_time.operations import Matrix, Transform

from .transforms import joined, local
from .values import Clock

#: Maximum number of prims, instances of the stage counted each.
MAX_PRIMS = 10_000_000
#: Purposes of prims that are drawn anyway.
_ALWAYS = "default"
_PREDICATE = Usd.TraverseInstanceProxies(Usd.PrimDefaultPredicate)
PURPOSES = ("default", "render", "proxy", "guide")


@dataclass(frozen=True, eq=False)
class Visit:
    """A prim and the values that it inherits.

    Attributes:
        prim: The prim.
        world: Scene from local, constant or over time.
        shown: Visibility, constant or over time.
        drawn: Whether the prim's purpose is drawn.
        depth: Number of ancestors.
        purpose: Purpose, authored or inherited.
    """

    prim: Usd.Prim
    world: Matrix | Transform
    shown: bool | Shown
    drawn: bool
    depth: int
    purpose: str = _ALWAYS

    @property
    def path(self) -> str:
        """Path of the prim."""
        return str(self.prim.GetPath())

    @property
    def name(self) -> str:
        """Name of its node in the scene: the path without its first slash."""
        return self.path.removeprefix("/")

    @cached_property
    def source(self) -> str:
        """Key that prims with the same content share.

        The key is the prototype of an instance, and the specs that compose the prim: files that
        are referenced several times are read once. Inherited primvars may differ, so the key of a
        prim that inherits primvars is its path.
        """
        prim = self.prim.GetPrimInPrototype() if self.prim.IsInstanceProxy() else self.prim
        parent = prim.GetParent()
        if parent and UsdGeom.PrimvarsAPI(parent).FindInheritablePrimvars():
            return str(prim.GetPath())
        return " ".join(
            f"{spec.layer.identifier}<{spec.path}>{offset.offset:g},{offset.scale:g}"
            for spec, offset in prim.GetPrimStackWithLayerOffsets()
        ) or str(prim.GetPath())


class PrimWalk:
    """Visits prims of a stage.

    Args:
        clock: Time codes of the stage.
        root: Scene from stage, for prims that ignore the transforms of their parents.
        purposes: Purposes to draw, besides ``default``.
        notes: Receives notes on unsupported content.
    """

    def __init__(self, clock: Clock, root: Matrix, purposes: Collection[str], notes: Notes) -> None:
        self._clock = clock
        self._notes = notes
        self._root = root
        self._purposes = {_ALWAYS, *purposes}
        self._count = 0

    def below(self, top: Usd.Prim, world: Matrix | Transform) -> Iterator[Visit]:
        """Visits the descendants of a prim.

        Prims below a point instancer are its prototypes and are not visited.
        """
        return self._below(Visit(top, world, True, True, 0))

    def whole(
        self, top: Usd.Prim, world: Matrix | Transform, shown: bool | Shown = True
    ) -> Iterator[Visit]:
        """Visits a prim and its descendants; the prim keeps its transform."""
        visit = replace(self._child(Visit(top, world, shown, True, 0), top), depth=0)
        yield visit
        if not top.IsA(UsdGeom.PointInstancer):
            yield from self._below(visit)

    def _below(self, top: Visit) -> Iterator[Visit]:
        waiting = [top]
        while waiting:
            visit = waiting.pop()
            if visit.depth:
                yield visit
            if visit.depth == 0 or not visit.prim.IsA(UsdGeom.PointInstancer):
                children = visit.prim.GetFilteredChildren(_PREDICATE)
                waiting += [self._child(visit, prim) for prim in reversed(children)]

    def _child(self, parent: Visit, prim: Usd.Prim) -> Visit:
        self._count += 1
        if self._count > MAX_PRIMS:
            raise InputError(
                f"{self._clock.file}: too many prims and instances: the limit is {MAX_PRIMS}"
            )
        world, shown, purpose = parent.world, parent.shown, parent.purpose
        imageable = UsdGeom.Imageable(prim)
        if imageable:
            ops, resets = local(prim, self._clock, self._notes)
            world = joined(self._root if resets else world, ops) if ops or resets else world
            shown = _visible(shown, imageable, self._clock)
            stated = imageable.GetPurposeAttr()
            if stated.HasAuthoredValue() and stated.Get() in PURPOSES:
                purpose = str(stated.Get())
        drawn = purpose in self._purposes
        return Visit(prim, world, shown, drawn, parent.depth + 1, purpose)


def _visible(parent: bool | Shown, imageable: UsdGeom.Imageable, clock: Clock) -> bool | Shown:
    if parent is False:
        return False
    authored = clock.value(imageable.GetVisibilityAttr(), lambda token: token != "invisible")
    if authored is None or authored is True:
        return parent
    if authored is False:
        return False
    return Shown((*(parent.flags if isinstance(parent, Shown) else ()), authored))
