# Names of the package, imported on first use (lazy_imports.py).
from daguerre.frame.picture import Picture as Picture

from .binning import bayer_of as bayer_of
from .looks import LOOKS as LOOKS
from .parameters import HIGHLIGHTS as HIGHLIGHTS
from .recipe import develop as develop
from .recipe import save_raw as save_raw
