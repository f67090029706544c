"""Points and tangents of the limit surface at the vertices of a level."""

from __future__ import annotations

from .level import OPEN, Level
from .rules import INFINITE, FloatArray, IntArray
from .scheme import Scheme, pulled_through
from .stencils import Group, side_by_side


def limit_groups(level: Level, scheme: Scheme) -> list[Group]:
    """Sums that give position and two tangents at each vertex of a level."""
    found = []
    for kind, valence, special, vertices in level.groups(scheme.regular):
        if not special and len(vertices):
            index = ring_points(level, scheme, kind, valence, vertices)
            found.append(Group(vertices, index, scheme.limit(kind, valence, False)))
        elif len(vertices):
            found += _special(level, scheme, kind, valence, vertices)
    return found


def ring_points(
    level: Level, scheme: Scheme, kind: int, valence: int, vertices: IntArray
) -> IntArray:
    """Vertices of rings: vertex, spokes, opposite corners; shape (M, P)."""

    def parts(some: slice) -> list[IntArray]:
        fan = level.fan(vertices[some], valence)
        after = level.after(fan)
        found = [vertices[some, None], level.vertices[after]]
        if kind == OPEN:
            found.append(level.vertices[level.before(fan[:, -1:])])
        if scheme.quads:
            found.append(level.vertices[level.after(after)])
        return found

    return side_by_side(len(vertices), scheme.ring(kind, valence), parts)


def _special(
    level: Level, scheme: Scheme, kind: int, valence: int, vertices: IntArray
) -> list[Group]:
    """Groups of vertices of one kind and valence that are sharp, or have sharp spokes."""
    sharpness = level.sharp_vertices.of(vertices)
    corner = sharpness >= INFINITE
    index = ring_points(level, scheme, kind, valence, vertices)
    found = [Group(vertices[corner], index[corner], scheme.limit(kind, valence, True))]
    rest = ~corner
    if rest.any():
        weights: FloatArray = pulled_through(
            scheme,
            kind,
            scheme.limit(kind, valence, False),
            sharpness[rest],
            level.fan_sharpness(level.fan(vertices[rest], valence), kind),
        )
        found.append(Group(vertices[rest], index[rest], weights))
    return found
