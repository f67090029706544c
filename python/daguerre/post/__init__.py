"""The darkroom: 2D lens and film effects for scene-linear pictures of any renderer.

Each effect is a function on arrays of shape (H, W, C), and an entry of ``daguerre post --list``
with the same parameters. Functions return a new array and do not change their arguments.
"""

from __future__ import annotations

from daguerre.convolution.convolve import convolve

from .effects.depth_of_field import depth_of_field
from .effects.distortion import distort, undistort
from .effects.fake_flare import fake_flare
from .effects.glow import bloom, diffract, glare, halo, spread_by, star
from .effects.grain import grain
from .effects.lateral_color import lateral_colour, remove_lateral_colour
from .effects.lens_psf import through_lens
from .effects.motion_blur import motion_blur
from .effects.saturation import unvignette_saturation, vignette_saturation
from .effects.stmap import apply_stmap, stmap
from .effects.vignetting import unvignette, vignette

__all__ = [
    "apply_stmap",
    "bloom",
    "convolve",
    "depth_of_field",
    "diffract",
    "distort",
    "fake_flare",
    "glare",
    "grain",
    "halo",
    "lateral_colour",
    "motion_blur",
    "remove_lateral_colour",
    "spread_by",
    "star",
    "stmap",
    "through_lens",
    "undistort",
    "unvignette",
    "unvignette_saturation",
    "vignette",
    "vignette_saturation",
]
