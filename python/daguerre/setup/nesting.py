"""Solids in solids in the core's form: priorities, and notes about what overlaps."""

from __future__ import annotations

import daguerre._core as _core
from daguerre.scene.materials import CONTAINED, LITERAL
from daguerre.scene.scene import Scene

#: Overlaps that a note lists.
_LISTED = 3


def add_nesting(builder: _core.SceneBuilder, scene: Scene) -> None:
    """Adds the priorities of materials, and the materials that do not nest."""
    for i, material in enumerate(scene.materials):
        if material.nesting == LITERAL:
            builder.set_nesting(i, 0, literal=True)
        elif material.nesting != CONTAINED:
            builder.set_nesting(i, int(material.nesting), literal=False)


def overlap_notes(scene: Scene, built: _core.Scene) -> list[str]:
    """A sentence about solids that overlap, and about literal surfaces among them."""
    found = built.overlaps
    if not found:
        return []
    parts = [
        f"{_name(scene, higher)} replaces {_name(scene, lower)} (by {by})"
        for lower, higher, by in found[:_LISTED]
    ]
    more = ", and others" if len(found) > len(parts) else ""
    notes = [f"where solids overlap, {', '.join(parts)}{more}"]
    if any(material.nesting == LITERAL for material in scene.materials):
        notes.append("literal interfaces among solids that overlap keep their own index")
    if built.nests_too_deeply:
        notes.append("more than eight solids are nested; a path keeps eight")
    return notes


def _name(scene: Scene, instance: int) -> str:
    return repr(scene.instances[instance].name or instance)
