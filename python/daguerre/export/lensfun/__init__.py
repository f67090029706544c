"""Profiles of lenses for lensfun, the library that photo editors correct photographs with."""

from .fitting import lensfun_profile, save_lensfun
from .profile import LensfunProfile

__all__ = ["LensfunProfile", "lensfun_profile", "save_lensfun"]
