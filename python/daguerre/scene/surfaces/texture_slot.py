"""Use of a texture by a material."""

from __future__ import annotations

from dataclasses import dataclass

from daguerre.files.value import BriefRecord


@dataclass(frozen=True, repr=False)
class TextureSlot(BriefRecord):
    """Reference of a material to a texture.

    Attributes:
        texture: Index returned by ``Scene.add_texture``.
        uv_set: Set of texture coordinates, 0 or 1.
        transform: uv' = (a u + b v + c, d u + e v + f), as (a, b, c, d, e, f).
    """

    texture: int
    uv_set: int = 0
    transform: tuple[float, float, float, float, float, float] = (1, 0, 0, 0, 1, 0)
