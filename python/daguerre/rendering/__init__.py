"""Rendering for any front end: settings, sessions, jobs with checkpoints, passes and merging."""

from daguerre.lazy_imports import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__, __file__)
