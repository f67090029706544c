"""Solids in solids in the core's form: priorities, and notes about what overlaps."""

from __future__ import annotations

import daguerre._core as _core
from daguerre.scene.materials import CONTAINED, LITERAL
from daguerre.scene.scene import Scene

#: Overlaps that a sentence lists.
_LISTED = 3
#: Reasons by which it is clear which of two solids fills the space.
_CLEAR = frozenset({"priority", "containment"})


def add_nesting(builder: _core.SceneBuilder, scene: Scene) -> None:
    """Adds the priorities of materials, and the materials that do not nest."""
    for i, material in enumerate(scene.materials):
        if material.nesting == LITERAL:
            builder.set_nesting(i, 0, literal=True)
        elif material.nesting != CONTAINED:
            builder.set_nesting(i, int(material.nesting), literal=False)


def overlap_notes(scene: Scene, built: _core.Scene) -> list[str]:
    """A sentence about solids that replace others by priority or containment, as they should."""
    replaced = _replaced(scene, built, clear=True)
    return [f"where solids overlap, {replaced}"] if replaced else []


def overlap_warnings(scene: Scene, built: _core.Scene) -> list[str]:
    """Sentences about overlaps whose result may not be the wanted one.

    These are solids of equal priority, neither inside the other; literal surfaces among solids that
    overlap; and more solids in each other than a path can keep.
    """
    warnings = []
    if replaced := _replaced(scene, built, clear=False):
        warnings.append(
            "where solids of equal priority overlap and neither is inside the other, "
            f"{replaced}; Material(nesting=) chooses another"
        )
    if built.overlaps and any(material.nesting == LITERAL for material in scene.materials):
        warnings.append("literal interfaces among solids that overlap keep their own index")
    if built.nests_too_deeply:
        warnings.append("more than eight solids are nested; a path keeps eight")
    return warnings


def _replaced(scene: Scene, built: _core.Scene, *, clear: bool) -> str:
    """The first solids that replace others for a clear reason, or for another; empty: none."""
    found = [overlap for overlap in built.overlaps if (overlap[2] in _CLEAR) == clear]
    parts = [
        f"{_name(scene, higher)} replaces {_name(scene, lower)} (by {by})"
        for lower, higher, by in found[:_LISTED]
    ]
    return ", ".join(parts) + (", and others" if len(found) > len(parts) else "")


def _name(scene: Scene, instance: int) -> str:
    return repr(scene.instances[instance].name or instance)
