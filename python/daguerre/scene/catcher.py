"""Catchers: stand-ins for real surfaces that a photograph shows already."""

from __future__ import annotations

from collections.abc import Iterable

from daguerre.errors import UsageError, suggest

#: Effects of objects on a catcher, in order; ``holdout`` means none of them.
EFFECTS = ("shadow", "reflection", "gi")
HOLDOUT = "holdout"
WANTED = f"{', '.join(EFFECTS)}, or {HOLDOUT}"


def check_effects(effects: str | Iterable[str], where: str) -> tuple[str, ...]:
    """Checks effects and returns them in order.

    Args:
        effects: Names, or a text with commas between them; ``holdout`` or empty: no effects.
        where: Start of messages.

    Raises:
        UsageError: Unknown name, or ``holdout`` beside others.
    """
    names = effects.split(",") if isinstance(effects, str) else list(effects) or [HOLDOUT]
    names = [str(name).strip() for name in names]
    for name in names:
        if name not in (*EFFECTS, HOLDOUT):
            raise UsageError(
                f"{where}: wanted {WANTED}, got {name!r}{suggest(name, [*EFFECTS, HOLDOUT])}"
            )
    if HOLDOUT in names and len(names) > 1:
        raise UsageError(f"{where}: wanted {WANTED}, got {', '.join(names)!r}")
    return tuple(name for name in EFFECTS if name in names)
