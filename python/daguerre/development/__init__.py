"""Develops raw pictures and frames: white balance, highlights, colours, tone; writes DNG."""

from daguerre.lazy_imports import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__, __file__)
