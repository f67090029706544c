"""Real lenses: the library, files of the schema ``daguerre-lens/0.1``, one lens on the bench."""

from daguerre.lazy_imports import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__, __file__)
