"""Polynomial optics: a construction kit of Taylor expansions, and lenses fitted to exact rays.

A :class:`System` maps rays to rays. ``from_lens`` expands a lens; ``propagate``, ``refract``,
``reflect`` and ``place`` make elements of which systems are put together (Hullin, Hanika and
Heidrich 2012)::

    import daguerre.polynomial as po

    singlet = (
        po.refract(po.sphere(-50), 1.5, 1.0) @ po.propagate(5) @ po.refract(po.sphere(50), 1.0, 1.5)
    )
    print(singlet)

The element on the right is applied first, as matrices are. ``fit`` makes a lens of polynomials that
a camera can use.
"""

from daguerre._core import Iris

from .elements import place, propagate, reflect, refract
from .fitting import fit
from .forms import Form, asphere, biconic, conic, cylinder, plane, sphere, toroid
from .lens_fit import ErrorZone, LensFit, SceneRays
from .lens_system import from_lens
from .system import System
from .terms import SeidelTerms
from .wavelengths import wavelength_nodes

__all__ = [
    "ErrorZone",
    "Form",
    "Iris",
    "LensFit",
    "SceneRays",
    "SeidelTerms",
    "System",
    "asphere",
    "biconic",
    "conic",
    "cylinder",
    "fit",
    "from_lens",
    "place",
    "plane",
    "propagate",
    "reflect",
    "refract",
    "sphere",
    "toroid",
    "wavelength_nodes",
]
