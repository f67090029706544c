"""Daguerre's properties of a camera or a scene, ``daguerre``, which the extension declares.

A property counts if the user set it, or if the user chose a lens: then the panel shows all values
in use. ``BLENDER`` as the lens is no choice, whoever set it. Properties of a scene always count, as
its panel shows them. Properties that do not count have Blender's values. Without the extension no
property counts.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import bpy


#: Lens of a camera that keeps Blender's own.
BLENDER = "blender"


class CameraPanel:
    """Properties of a camera that the user chose, or of a scene.

    Args:
        data: ``bpy.types.Camera`` or ``bpy.types.Scene``, or None.
        always: Whether all properties count, as for a scene.
    """

    def __init__(self, data: bpy.types.ID | None, *, always: bool = False) -> None:
        self._always = always
        self._group: bpy.types.PropertyGroup | None = getattr(data, "daguerre", None)

    def chosen(self, name: str) -> Any:
        """Value of a property; None if it does not count, or names nothing."""
        if self._group is None:
            return None
        if not (self._always or self._has_lens or self._is_set(name)):
            return None
        return self.value(name)

    def value(self, name: str) -> Any:
        """Value of a property, whether it counts or not; None if it names nothing."""
        value = getattr(self._group, name, None)
        return None if value == "" else value

    def named(self, name: str, *others: str) -> str | None:
        """Choice of a menu, in lower case; None if it does not count, or is one of ``others``."""
        value = self.chosen(name)
        found = None if value is None else str(value)
        return None if found is None or found.lower() in others else found

    @property
    def _has_lens(self) -> bool:
        return self._is_set("lens") and getattr(self._group, "lens", BLENDER) != BLENDER

    def _is_set(self, name: str) -> bool:
        """Whether the user set a property; of an object that is no group: whether it is there."""
        asked = getattr(self._group, "is_property_set", None)
        if asked is None:
            return hasattr(self._group, name)
        return hasattr(self._group, name) and bool(asked(name))
