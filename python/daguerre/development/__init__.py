"""Develops raw pictures and frames: white balance, highlights, colours, tone; writes DNG."""

from __future__ import annotations

from typing import TYPE_CHECKING

from daguerre.frame.picture import Picture
from daguerre.lazy_imports import lazy_attributes

if TYPE_CHECKING:
    from .binning import bayer_of
    from .looks import LOOKS
    from .parameters import HIGHLIGHTS
    from .recipe import develop, save_raw

__all__ = ["HIGHLIGHTS", "LOOKS", "Picture", "bayer_of", "develop", "save_raw"]

if not TYPE_CHECKING:  # checkers know the names above, and report all others
    __getattr__, __dir__ = lazy_attributes(
        __name__,
        {
            "HIGHLIGHTS": "parameters",
            "LOOKS": "looks",
            "bayer_of": "binning",
            "develop": "recipe",
            "save_raw": "recipe",
        },
    )
