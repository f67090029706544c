"""Walks over all that Blender draws: objects, copies, and instances of geometry nodes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import bpy


#: Tells the same thing at another moment: instancer, object, type, and place among the copies.
Identity = tuple[str, str, str, tuple[int, ...]]

#: Types that cannot be drawn, in words; types without surfaces, such as empties, are not here.
UNDRAWN = {
    "VOLUME": "volumes",
    "GREASEPENCIL": "grease pencil drawings",
    "GPENCIL": "grease pencil drawings",
    "POINTCLOUD": "point clouds",
    "LIGHT_PROBE": "light probes",
}


@dataclass(frozen=True)
class Seen:
    """One thing that Blender draws; valid until the walk goes on.

    Attributes:
        object: Evaluated object.
        matrix: World from object in Blender's frame, shape (4, 4).
        name: Name of the object, or of the instancer that copies it.
        own: Whether it is an object of the scene, and no copy or part of one.
        surface: Whether it is drawn itself, and not only its copies.
        copy: The walk's own record of it.
    """

    object: bpy.types.Object
    matrix: NDArray[np.float64]
    name: str
    own: bool
    surface: bool
    copy: bpy.types.DepsgraphObjectInstance

    @property
    def identity(self) -> Identity:
        """Finds it again at another moment."""
        path = () if self.own else tuple(self.copy.persistent_id)
        return self.name, self.object.name_full, self.object.type, path


def walk(depsgraph: bpy.types.Depsgraph) -> Iterator[Seen]:
    """Everything that renders show, in the order of the dependency graph.

    The graph of a render has nothing else. The viewport's graph also has objects hidden in renders.

    Args:
        depsgraph: Evaluated ``bpy.types.Depsgraph``.
    """
    viewport = depsgraph.mode != "RENDER"
    hidden = _hidden(depsgraph.scene) if viewport else set()
    for copy in depsgraph.object_instances:
        thing, own = copy.object, not copy.is_instance
        owner = thing if own or copy.parent is None else copy.parent
        name = owner.name_full
        if viewport and (name in hidden or _hides(thing, owner)):
            continue
        matrix = np.array(copy.matrix_world, np.float64)
        surface = copy.show_self and not (own and _is_pattern(thing))
        yield Seen(thing, matrix, name, own, surface, copy)


def _hides(thing: bpy.types.Object, owner: bpy.types.Object) -> bool:
    """Whether switches of an object or of its instancer hide it in renders.

    Geometry nodes and particles also copy objects that renders hide.
    """
    copied = thing.name_full != owner.name_full and owner.instance_type == "NONE"
    return bool(owner.hide_render or (thing.hide_render and not copied))


def _is_pattern(thing: bpy.types.Object) -> bool:
    """Whether an object exists to be copied: an ancestor instances its children."""
    above = thing.parent
    while above is not None:
        if above.instance_type in ("VERTS", "FACES"):
            return True
        above = above.parent
    return False


def _hidden(scene: bpy.types.Scene) -> set[str]:
    """Names of objects that only collections without render visibility hold."""
    shown: set[str] = set()
    every: set[str] = set()
    stack = [(scene.collection, True)]
    while stack:
        collection, visible = stack.pop()
        visible = visible and not collection.hide_render
        names = [thing.name_full for thing in collection.objects]
        every.update(names)
        if visible:
            shown.update(names)
        stack.extend((child, visible) for child in collection.children)
    return every - shown


def descendants(depsgraph: bpy.types.Depsgraph) -> dict[str, list[str]]:
    """Names of the objects below each object that has children."""
    below: dict[str, list[str]] = {}
    for thing in depsgraph.objects:
        parent = thing.parent
        while parent is not None:
            below.setdefault(parent.name_full, []).append(thing.name_full)
            parent = parent.parent
    return below
