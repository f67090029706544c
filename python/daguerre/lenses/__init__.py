"""Real lenses: the library, files of the schema ``daguerre-lens/0.1``, one lens on the bench."""

from .configurations import Configuration
from .errors import LensError
from .focus import Focused
from .lens import FirstOrder, Lens, Nominal, Pupil
from .library import load, names
from .reader import read
from .setting import LensSetting
from .surface import LensSurface

__all__ = [
    "Configuration",
    "FirstOrder",
    "Focused",
    "Lens",
    "LensError",
    "LensSetting",
    "LensSurface",
    "Nominal",
    "Pupil",
    "load",
    "names",
    "read",
]
