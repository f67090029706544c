"""Real lenses: the library, files of the schema ``daguerre-lens/0.1``, one lens on the bench."""

from .lens import FirstOrder, Lens, LensSurface, Nominal, Pupil
from .library import load, names
from .reader import read

__all__ = ["FirstOrder", "Lens", "LensSurface", "Nominal", "Pupil", "load", "names", "read"]
