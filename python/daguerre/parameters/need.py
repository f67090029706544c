"""Conditions that a camera must meet to take a parameter."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

from daguerre.errors import UsageError


@dataclass(frozen=True)
class Need:
    """A condition on the kind of camera.

    Attributes:
        kinds: Traits of cameras of which one must be there, such as ``("exact", "polynomial")``.
        refusal: Words that tell a user what to do; ``{kind}`` is the model of the camera's lens.
            Empty: another camera leaves the parameter aside.
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
            UsageError: None of the traits is wanted.
        """
        if self.refusal and not set(self.kinds) & set(traits):
            raise UsageError(f"{where}: {self.refusal.replace('{kind}', kind)}")
