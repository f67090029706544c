"""Pictures in memory: linear frames, raw mosaics, display pictures."""

from daguerre.lazy_imports import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__, __file__)
