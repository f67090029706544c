"""Daguerre: a physically based camera renderer."""

from . import compiled, forks  # noqa: F401
from .lazy_imports import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__, __file__)
