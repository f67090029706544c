"""Lens and brightness that the reader of a kind of camera finds."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Seen:
    """Lens of a camera of pbrt, and its brightness.

    Attributes:
        fields: Fields of ``Camera``.
        ahead: Distance from pbrt's camera to ours, m.
        weight: Value that pbrt shows of a radiance of 1, without film and time.
        timed: Whether pbrt multiplies a picture by the exposure time.
    """

    fields: dict[str, Any]
    ahead: float = 0.0
    weight: float = 1.0
    timed: bool = True
