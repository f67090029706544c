"""Exports lenses: fits as C, GLSL, OSL, NumPy and JSON, profiles for lensfun."""

from .files import SUFFIXES, check_suffix, code, save
from .lensfun import LensfunProfile, lensfun_profile, save_lensfun

__all__ = [
    "SUFFIXES",
    "LensfunProfile",
    "check_suffix",
    "code",
    "lensfun_profile",
    "save",
    "save_lensfun",
]
