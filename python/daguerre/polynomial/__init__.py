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

from daguerre.lazy_imports import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__, __file__)
