"""Develops raw pictures and frames: white balance, highlights, colours, tone; writes DNG."""

from daguerre.frame.picture import Picture

from .binning import bayer_of
from .develop import develop, save_raw
from .looks import LOOKS
from .parameters import HIGHLIGHTS

__all__ = ["HIGHLIGHTS", "LOOKS", "Picture", "bayer_of", "develop", "save_raw"]
