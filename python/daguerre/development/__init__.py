"""From what a sensor recorded to a picture: white balance, colours, tone, and files of them."""

from daguerre.frame.picture import Picture

from .binning import bayer_of
from .develop import develop, save_raw
from .looks import LOOKS
from .parameters import HIGHLIGHTS

__all__ = ["HIGHLIGHTS", "LOOKS", "Picture", "bayer_of", "develop", "save_raw"]
