"""Real lenses: the library, files of the schema ``daguerre-lens/0.1``, one lens on the bench."""

from __future__ import annotations

from typing import TYPE_CHECKING

from daguerre.lazy_imports import lazy_attributes

if TYPE_CHECKING:
    from .configurations import Configuration
    from .errors import LensError
    from .focus import Focused
    from .index import Entry, names
    from .lens import FirstOrder, Lens, Nominal, Pupil
    from .library import load
    from .product import Product
    from .reader import read
    from .search import find
    from .setting import LensSetting
    from .surface import LensSurface

__all__ = [
    "Configuration",
    "Entry",
    "FirstOrder",
    "Focused",
    "Lens",
    "LensError",
    "LensSetting",
    "LensSurface",
    "Nominal",
    "Product",
    "Pupil",
    "find",
    "load",
    "names",
    "read",
]

if not TYPE_CHECKING:  # checkers know the names above, and report all others
    __getattr__, __dir__ = lazy_attributes(
        __name__,
        {
            "Configuration": "configurations",
            "Entry": "index",
            "FirstOrder": "lens",
            "Focused": "focus",
            "Lens": "lens",
            "LensError": "errors",
            "LensSetting": "setting",
            "LensSurface": "surface",
            "Nominal": "lens",
            "Product": "product",
            "Pupil": "lens",
            "find": "search",
            "load": "library",
            "names": "index",
            "read": "reader",
        },
    )
