"""Polynomial optics: lenses as polynomials, fitted to exact rays."""

from .fitting import fit
from .lens_fit import ErrorZone, LensFit, SceneRays

__all__ = ["ErrorZone", "LensFit", "SceneRays", "fit"]
