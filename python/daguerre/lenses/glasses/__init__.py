"""Glasses of the makers' catalogues, by name: ``find("N-BK7").index(587.56)``.

Indices are relative to air at 20 C and 101.325 kPa, as the catalogues state them; Ohara measures
at 25 C, Hikari at 23 C. Data: refractiveindex.info (CC0), see ``script/make-glass-catalogue``.
"""

from .catalogue import MAKERS, GlassData, find, lookup, names, similar

__all__ = ["MAKERS", "GlassData", "find", "lookup", "names", "similar"]
