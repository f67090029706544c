"""Subdivision surfaces: Catmull-Clark, Loop and bilinear, with creases, corners and boundaries.

A :class:`Refiner` takes the faces of a control mesh once and makes points of the limit surface from
control points as often as they change. ``cut.py`` opens the mesh along boundaries, seams and
infinitely sharp creases, so that a vertex has one fan of faces from then on. ``level.py`` holds the
faces, edges and rings of a level; ``split.py`` makes the next level. ``step.py`` and ``limit.py``
compute points as weighted sums (``stencils.py``).

Sources: Catmull and Clark 1978, Computer-Aided Design 10, 350; Loop 1987, Smooth subdivision
surfaces based on triangles; Halstead, Kass and DeRose 1993, SIGGRAPH, 35; Hoppe et al. 1994,
SIGGRAPH, 295; DeRose, Kass and Truong 1998, SIGGRAPH, 85; the subdivision rules that OpenSubdiv
documents.
"""

from daguerre.lazy_imports import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__, __file__)
