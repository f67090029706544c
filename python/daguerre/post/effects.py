"""The list of effects: a line for each."""

from __future__ import annotations

from .distortion import DISTORTION
from .effect import Effect
from .lateral_colour import LATERAL_COLOUR
from .saturation import SATURATION
from .stmap import STMAP
from .vignetting import VIGNETTING

EFFECTS: dict[str, Effect] = {
    effect.name: effect for effect in (DISTORTION, STMAP, LATERAL_COLOUR, VIGNETTING, SATURATION)
}
