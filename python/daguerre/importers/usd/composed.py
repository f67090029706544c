"""Bounds the number of prims that a stage composes, before USD composes any.

A few references to references multiply to more prims than any memory holds. Here the sum of a prim
is counted once per layer and reused wherever a reference leads there. All specs count, also specs
of a prim in several layers; for each set of variants the largest variant counts. References in a
loop end where USD ends them.

A reference from outside also brings the opinions on its name of each inherited or specialized class
at the referring prim; USD calls these arcs implied. USD does not cut all loops of implied arcs: a
stage with references below themselves through an implied arc is refused.

Source: OpenUSD, "LIVERPS Strength Ordering"; ``pxr/usd/pcp/primIndex.cpp`` (loops, implied arcs).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Generator
from dataclasses import dataclass, field

from pxr import Sdf

from daguerre import memory
from daguerre.errors import InputError

from .layer_names import DEEPEST, Arc
from .layers import Stack
from .prims import MAX_PRIMS
from .values import path_text

#: Bytes that a prim takes at least, in USD and as a node of the scene.
_PRIM_BYTES = 1000
#: Most nested references, and most prims to count again because of loops.
_MOST_ARCS, _MOST_AGAIN = 128, 30_000
_MANY = 10**15
#: Most specs of one prim, with all its references. USD leaves out the rest, after seconds for each
#: prim. Source: ``pxr/usd/pcp/primIndex_Graph.h`` (16-bit indices of nodes).
_MOST_SPECS = 65_535


@dataclass
class _Sum:
    """Sum of specs, prims and arcs of a prim.

    Attributes:
        prims: Number of specs.
        own: Number of specs of the prim itself, without the prims below it.
        depth: Largest depth of prims.
        arcs: Largest depth of references.
        classes: How often each class is used, by its path in the stack.
        loop: First place in the chain of references at which a loop was cut.
    """

    prims: int = 0
    own: int = 0
    depth: int = 0
    arcs: int = 0
    classes: Counter[Sdf.Path] = field(default_factory=Counter)
    loop: int = 1 << 30

    def add(self, other: _Sum, times: int = 1, below: int = 0, arcs: int = 0) -> None:
        """Adds the sum of another prim, without its classes and direct specs."""
        self.arcs = max(self.arcs, other.arcs + arcs)
        self.prims = min(self.prims + times * other.prims, _MANY)
        self.depth = max(self.depth, other.depth + below)
        self.loop = min(self.loop, other.loop)

    def largest(self, other: _Sum) -> None:
        """Takes the larger of each number."""
        self.prims = max(self.prims, other.prims)
        self.own = max(self.own, other.own)
        self.arcs = max(self.arcs, other.arcs)
        self.depth = max(self.depth, other.depth)
        self.loop = min(self.loop, other.loop)
        self.classes |= other.classes


#: A count that asks for other counts and gets their sums, so that depth takes no stack.
_Count = Generator["_Count", _Sum, _Sum]


def check_count(stack: Stack, file: str) -> None:
    """Checks the number of prims of a stage.

    Args:
        stack: Layers of the stage.
        file: File, for messages.

    Raises:
        InputError: The prims may exceed the memory, or references are nested too deeply.
    """
    most, left = MAX_PRIMS, memory.left_bytes()
    if left is not None:
        most = min(most, left // _PRIM_BYTES)
    found = _run(_Composed(file).specs(stack, Sdf.Path.absoluteRootPath))
    if found.prims > most:
        raise InputError(
            f"{file}: too many prims: wanted at most {most}, got up to {found.prims:.6g}, with "
            "each reference counted"
        )
    if found.arcs > _MOST_ARCS:
        raise _too_deep(file)
    if found.depth > DEEPEST:
        raise InputError(f"{file}: prims are nested too deeply: the limit is {DEEPEST}")


def _too_deep(file: str) -> InputError:
    return InputError(f"{file}: references are nested too deeply: the limit is {_MOST_ARCS}")


def _run(count: _Count) -> _Sum:
    """Runs a count and all that it asks for."""
    waiting: list[_Count] = [count]
    answer: _Sum | None = None
    while waiting:
        try:
            waiting.append(waiting[-1].send(answer))  # type: ignore[arg-type]
            answer = None
        except StopIteration as done:
            waiting.pop()
            found: _Sum = done.value
            answer = found
    assert answer is not None
    return answer


class _Composed:
    def __init__(self, file: str) -> None:
        self._file = file
        self._tried: set[tuple[Stack, Sdf.Path]] = set()
        self._again = 0
        self._known: dict[tuple[bool, Stack, Sdf.Path], _Sum] = {}
        #: References that are followed: stack and prim of each, the prim that it leads to, and
        #: whether it is an implied arc.
        self._chain: list[tuple[Stack, Sdf.Path, Sdf.Path, bool]] = []
        self._implied: set[tuple[Stack, Sdf.Path]] = set()

    def specs(self, stack: Stack, path: Sdf.Path) -> _Count:
        """Sum of the specs at a path of a stack, with all below."""
        key = False, stack, path
        if key in self._known:
            return self._known[key]
        self._again += (stack, path) in self._tried
        self._tried.add((stack, path))
        if self._again > _MOST_AGAIN:
            raise InputError(f"{self._file}: references form too many loops")
        found = _Sum(prims=0 if path.IsPrimVariantSelectionPath() else 1, own=1, depth=1)
        variants: dict[str, list[Sdf.Path]] = {}
        children = (child for names, _ in stack.layers for child in names.below.get(path, ()))
        for child in dict.fromkeys(children):
            if child.IsPrimVariantSelectionPath():
                variants.setdefault(child.GetVariantSelection()[0], []).append(child)
            else:
                part = yield self.specs(stack, child)
                found.add(part, below=1)
                found.classes += part.classes
        for choices in variants.values():
            most = _Sum()
            for choice in choices:
                most.largest((yield self.specs(stack, choice)))
            found.add(most)
            found.own += most.own
            found.classes += most.classes
        for names, below in stack.layers:
            for arc in names.arcs.get(path, ()):
                yield from self._arc(found, stack, path, arc, below)
        if found.own > _MOST_SPECS:
            raise InputError(
                f"{self._file}: {path_text(path)}: too many references to references: wanted at "
                f"most {_MOST_SPECS}, got {found.own:.6g}"
            )
        if found.loop >= len(self._chain):
            found.loop = 1 << 30
            self._known[key] = found
        return found

    def _arc(
        self, found: _Sum, stack: Stack, path: Sdf.Path, arc: Arc, below: dict[str, Stack]
    ) -> Generator[_Count, _Sum, None]:
        """Adds the sum of an arc."""
        there = below.get(arc.asset) if arc.asset else stack
        if there is None:
            return
        own = path.StripAllVariantSelections()
        target = _target(there, arc, own)
        if target is None:
            return
        part = yield self._through(there, stack, own, target, target)
        found.add(part, arcs=1)
        found.own = min(found.own + part.own, _MANY)
        if arc.of_class:
            found.classes[target] += 1
        for name, uses in part.classes.items():
            inner = name.HasPrefix(target)
            mapped = name.ReplacePrefix(target, own) if inner else name
            found.classes[mapped] = min(found.classes[mapped] + uses, _MANY)
            if (inner or there is not stack) and (stack, mapped) not in self._implied:
                self._implied.add((stack, mapped))
                self._chain.append((stack, own, mapped, True))
                found.add((yield self.composed(stack, mapped)), uses, below=part.depth)
                self._chain.pop()
                self._implied.discard((stack, mapped))

    def _through(
        self, there: Stack, stack: Stack, path: Sdf.Path, target: Sdf.Path, inside: Sdf.Path
    ) -> _Count:
        """Sum of an arc, from a path at or below its target; nothing if it forms a loop."""
        cut = self._loop(there, stack, path, target)
        if cut is not None:
            return _Sum(loop=cut)
        if len(self._chain) >= _MOST_ARCS:
            raise _too_deep(self._file)
        self._chain.append((stack, path, target, False))
        found = yield self.composed(there, inside)
        self._chain.pop()
        return found

    def _loop(self, there: Stack, stack: Stack, path: Sdf.Path, target: Sdf.Path) -> int | None:
        """Place in the chain that an arc leads back to: the same prim, an ancestor or a descendant.

        Raises:
            InputError: The arc leads below itself by an implied arc, where USD cuts no loop, and
                may nest prims without end.
        """
        at, where = path, stack
        for i in range(len(self._chain), -1, -1):
            if where is there and (at.HasPrefix(target) or target.HasPrefix(at)):
                below = at != target and target.HasPrefix(at)
                if below and any(implied for *_, implied in self._chain[i:]):
                    raise InputError(
                        f"{self._file}: {path_text(at)}: a reference leads below itself, through "
                        f"an inherited class, to {path_text(target)}"
                    )
                return i
            if i:
                where, source, through, _ = self._chain[i - 1]
                at = source if through.HasPrefix(at) else at.ReplacePrefix(through, source)
        return None

    def composed(self, stack: Stack, path: Sdf.Path) -> _Count:
        """Sum of a path of a stack: specs there, and specs through arcs of its ancestors."""
        key = True, stack, path
        if key in self._known:
            return self._known[key]
        found = _Sum()
        if _has(stack, path):
            part = yield self.specs(stack, path)
            found.add(part)
            found.own += part.own
            found.classes += part.classes
        above = path.GetParentPath()
        while above != Sdf.Path.absoluteRootPath:
            for place in _with_variants(stack, above):
                yield from self._above(found, stack, path, above, place)
            above = above.GetParentPath()
        if found.loop >= len(self._chain):
            found.loop = 1 << 30
            self._known[key] = found
        return found

    def _above(
        self, found: _Sum, stack: Stack, path: Sdf.Path, above: Sdf.Path, place: Sdf.Path
    ) -> Generator[_Count, _Sum, None]:
        """Adds the sum at a path that a prim above, or a variant of that prim, has there."""
        if place != above:
            inside = path.ReplacePrefix(above, place)
            if _has(stack, inside):
                part = yield self.specs(stack, inside)
                found.add(part)
                found.own += part.own
                found.classes += part.classes
        for names, below in stack.layers:
            for arc in names.arcs.get(place, ()):
                there = below.get(arc.asset) if arc.asset else stack
                target = None if there is None else _target(there, arc, above)
                if there is not None and target is not None:
                    inner = path.ReplacePrefix(above, target)
                    part = yield self._through(there, stack, above, target, inner)
                    found.add(part, arcs=1)
                    found.own = min(found.own + part.own, _MANY)


def _target(there: Stack, arc: Arc, own: Sdf.Path) -> Sdf.Path | None:
    """Prim that an arc leads to; None: no such prim."""
    if arc.path.isEmpty:
        default = there.root.GetDefaultPrimAsPath()
        return None if default.isEmpty else default
    path = arc.path.MakeAbsolutePath(own) if not arc.path.IsAbsolutePath() else arc.path
    return path.StripAllVariantSelections() if path.IsPrimPath() else None


def _has(stack: Stack, path: Sdf.Path) -> bool:
    """Whether a stack has specs at a path, or below it."""
    parent = path.GetParentPath()
    return any(path in names.below.get(parent, ()) for names, _ in stack.layers)


def _with_variants(stack: Stack, path: Sdf.Path) -> list[Sdf.Path]:
    """A prim and all of its variants."""
    found, waiting = [], [path]
    while waiting:
        place = waiting.pop()
        found.append(place)
        for names, _ in stack.layers:
            waiting += (c for c in names.below.get(place, ()) if c.IsPrimVariantSelectionPath())
    return list(dict.fromkeys(found))
