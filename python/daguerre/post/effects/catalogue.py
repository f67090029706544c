"""Catalogue of effects, one line for each."""

from __future__ import annotations

from daguerre.post.effect import Effect

from .depth_of_field import DEPTH_OF_FIELD
from .distortion import DISTORTION
from .fake_flare import FAKE_FLARE
from .glow import BLOOM, DIFFRACTION, GLARE, HALO, PSF, STAR
from .grain import GRAIN
from .lateral_color import LATERAL_COLOR
from .lens_psf import LENS_PSF
from .motion_blur import MOTION_BLUR
from .saturation import SATURATION
from .stmap import STMAP
from .vignetting import VIGNETTING

EFFECTS: dict[str, Effect] = {
    effect.name: effect
    for effect in (
        *(DEPTH_OF_FIELD, MOTION_BLUR),
        *(DISTORTION, STMAP, LATERAL_COLOR, VIGNETTING, SATURATION),
        *(BLOOM, HALO, STAR, DIFFRACTION, GLARE, PSF, LENS_PSF, FAKE_FLARE),
        GRAIN,
    )
}
