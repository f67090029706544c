"""Conditions of parameters on the kind of camera."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

from daguerre.errors import UsageError


@dataclass(frozen=True)
class Need:
    """A condition on the kind of camera.

    Attributes:
        kinds: Traits of cameras, such as ``("exact", "polynomial")``; the camera needs any of them.
        refusal: Message for the user; ``{kind}`` stands for the model of the camera's lens. Empty:
            other cameras ignore the parameter.
    """

    kinds: tuple[str, ...]
    refusal: str

    def check(self, traits: Collection[str], kind: str, where: str) -> None:
        """Refuses a camera without any of the kinds.

        Args:
            traits: Traits of the camera.
            kind: Model of its lens, for the message.
            where: Parameter in question, for the message.

        Raises:
            UsageError: The camera has none of the kinds.
        """
        if self.refusal and not set(self.kinds) & set(traits):
            raise UsageError(f"{where}: {self.refusal.replace('{kind}', kind)}")
