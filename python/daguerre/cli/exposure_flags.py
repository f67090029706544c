"""Flags of exposure that several commands have: which exclude each other, and their old meaning."""

from __future__ import annotations

from typing import Any

from daguerre.camera.exposure_mode import CHOICES, chosen_by
from daguerre.camera.parameters import CAMERA
from daguerre.errors import UsageError


def check_mode(changes: dict[str, Any]) -> None:
    """Refuses flags of values that the exposure mode chooses.

    Raises:
        UsageError: The message names both.
    """
    mode = changes.get("exposure") or ""
    for name in chosen_by(mode):
        if name in changes:
            raise UsageError(
                f"--exposure {mode} and {CAMERA[name].flag}: wanted one of them, got both; the "
                f"mode chooses {CHOICES[mode]}"
            )


def before_1_0(flag: str) -> str:
    """Note on a flag or command that gives pictures in ``light`` since version 1.0."""
    return f"in light; before 1.0 {flag} exposed the picture: add --exposure manual for that"
