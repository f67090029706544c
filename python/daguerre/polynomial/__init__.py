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

from typing import TYPE_CHECKING

from daguerre._core import Iris
from daguerre.lazy_imports import lazy_attributes

from .elements import place, propagate, reflect, refract
from .fitting import fit
from .forms import Form, asphere, biconic, conic, cylinder, plane, sphere, toroid
from .lens_fit import ErrorZone, LensFit, SceneRays
from .lens_system import from_lens
from .system import System
from .terms import SeidelTerms
from .wavelengths import wavelength_nodes

if TYPE_CHECKING:
    from .ghosts import GhostError, GhostPolynomial, PolynomialGhosts, expand_ghost

__all__ = [
    "ErrorZone",
    "Form",
    "GhostError",
    "GhostPolynomial",
    "Iris",
    "LensFit",
    "PolynomialGhosts",
    "SceneRays",
    "SeidelTerms",
    "System",
    "asphere",
    "biconic",
    "conic",
    "cylinder",
    "expand_ghost",
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

if not TYPE_CHECKING:  # checkers know the names above, and report all others
    __getattr__, __dir__ = lazy_attributes(
        __name__,
        dict.fromkeys(
            ("GhostError", "GhostPolynomial", "PolynomialGhosts", "expand_ghost"), "ghosts"
        ),
    )
