"""The darkroom: imperfections of a lens in 2D, for scene-linear pictures of any renderer.

Each effect is a function on arrays of shape (H, W, C), and an entry of ``daguerre post --list``
with the same parameters. None changes its argument.
"""

from __future__ import annotations

from .depth_of_field import depth_of_field
from .distortion import distort, undistort
from .fake_flare import fake_flare
from .grain import grain
from .lateral_colour import lateral_colour, remove_lateral_colour
from .motion_blur import motion_blur
from .saturation import unvignette_saturation, vignette_saturation
from .stmap import apply_stmap, stmap
from .vignetting import unvignette, vignette

__all__ = [
    "apply_stmap",
    "depth_of_field",
    "distort",
    "fake_flare",
    "grain",
    "lateral_colour",
    "motion_blur",
    "remove_lateral_colour",
    "stmap",
    "undistort",
    "unvignette",
    "unvignette_saturation",
    "vignette",
    "vignette_saturation",
]
