"""Sets of texture coordinates: a written mesh has one."""

from __future__ import annotations

from collections.abc import Sequence

from daguerre.files.notes import Notes
from daguerre.scene.materials import TextureSlot


def uv_set_of(slots: Sequence[TextureSlot], notes: Notes) -> int:
    """Set of texture coordinates to write: the first texture's; notes textures with others."""
    if not slots:
        return 0
    others = sum(slot.uv_set != slots[0].uv_set for slot in slots)
    if others:
        notes.add(
            "texture on a second set of texture coordinates in its material is written on the "
            "first set",
            others,
        )
    return slots[0].uv_set
