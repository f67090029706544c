"""Measures a lens: spots, wavefronts, PSF, MTF, figures over the field, and a data sheet.

All figures come from exact rays through the prescription; docs/lens-bench.md has the formulas.
"""

from daguerre.lazy_imports import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__, __file__)
