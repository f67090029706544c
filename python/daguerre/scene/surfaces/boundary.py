"""Surfaces that only bound a medium."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Boundary:
    """An invisible surface: light passes unchanged, and only the medium changes there."""
