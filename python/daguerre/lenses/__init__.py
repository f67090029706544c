"""Real lenses: the library, files of the schema ``daguerre-lens/0.1``, one lens on the bench."""

from .configurations import Configuration
from .errors import LensError
from .focus import Focused
from .index import Entry, names
from .lens import FirstOrder, Lens, Nominal, Pupil
from .library import load
from .reader import read
from .search import find
from .setting import LensSetting
from .surface import LensSurface

__all__ = [
    "Configuration",
    "Entry",
    "FirstOrder",
    "Focused",
    "Lens",
    "LensError",
    "LensSetting",
    "LensSurface",
    "Nominal",
    "Pupil",
    "find",
    "load",
    "names",
    "read",
]
