"""Mixtures of materials."""

from __future__ import annotations

from dataclasses import dataclass

from daguerre.files.value import BriefRecord

from .texture_slot import TextureSlot


@dataclass(frozen=True, repr=False)
class Mix(BriefRecord):
    """A mixture of two materials of the scene, each of which covers a share of every point.

    Only the emission of the mixture counts; its parts emit nothing.

    Attributes:
        first: Index from ``Scene.add_material``, of a material that was added before the mixture.
        second: Index of the second material, added before the mixture, too.
        amount: Share of the second, 0 to 1.
        amount_texture: R, a factor on ``amount``.
    """

    first: int = 0
    second: int = 0
    amount: float = 0.5
    amount_texture: TextureSlot | None = None
