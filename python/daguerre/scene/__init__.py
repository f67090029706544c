"""Scenes: meshes, instances, materials, lights, cameras, environment, and their motion."""

from daguerre.lazy_imports import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__, __file__)
