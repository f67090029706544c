"""The list of effects: a line for each."""

from __future__ import annotations

from .distortion import DISTORTION
from .effect import Effect
from .vignetting import VIGNETTING

EFFECTS: dict[str, Effect] = {effect.name: effect for effect in (DISTORTION, VIGNETTING)}
