"""Ways in which pictures are shown: denoised, tinted, beside others."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from daguerre.checks import short
from daguerre.errors import UsageError

from .beside import NAMES as BESIDE
from .dials import Dials
from .tint import NONE, TINTS

#: Checks of the attributes of :class:`Show`, and the values that each takes.
_CHECKS: dict[str, tuple[Callable[[Any], bool], str]] = {
    "denoised": (lambda value: isinstance(value, bool | None), "true, false or null"),
    "models": (lambda value: isinstance(value, bool), "true or false"),
    "tint": (lambda value: value in TINTS, ", ".join(TINTS)),
    "beside": (lambda value: value is None or _is_dial(value), f"one text, of {', '.join(BESIDE)}"),
}


@dataclass(frozen=True)
class Show:
    """Way in which pictures are shown.

    Attributes:
        denoised: Whether pictures are denoised; None: only before they rest, if that is fast.
        models: Whether they are drawn by three models of the lens, side by side.
        tint: One of ``TINTS``: by exposure or distance.
        beside: Dial that differs in a second picture, and its text; None: there is none.
    """

    denoised: bool | None
    models: bool
    tint: str = NONE
    beside: Mapping[str, str] | None = None

    def changed(self, changes: Mapping[str, Any]) -> Show:
        """Another way; models end a picture beside, and it ends them."""
        apart: dict[str, Any] = {}
        if changes.get("beside"):
            apart = {"models": False}
        elif changes.get("models"):
            apart = {"beside": None}
        return replace(self, **{**apart, **changes})


def check_changes(value: object) -> Mapping[str, Any]:
    """Checks changes from a page.

    Returns:
        Some attributes of :class:`Show` and their values.

    Raises:
        UsageError: An attribute or its value is wrong, or both models and a picture beside are
            named.
    """
    if not isinstance(value, dict) or not value or not value.keys() <= _CHECKS.keys():
        raise UsageError(f"show: wanted some of {', '.join(_CHECKS)}; got {short(value)}")
    for name, one in value.items():
        fits, wanted = _CHECKS[name]
        if not fits(one):
            raise UsageError(f"show: {name}: wanted {wanted}; got {short(one)}")
    if value.get("beside") is not None:
        Dials().turned(value["beside"])
        if value.get("models"):
            raise UsageError("show: wanted models or a picture beside, got both")
    return value


def _is_dial(value: Any) -> bool:
    fits = isinstance(value, dict) and len(value) == 1 and next(iter(value)) in BESIDE
    return fits and all(isinstance(text, str) for text in value.values())
