"""Parts of rooms: boxes and balls with texture coordinates, walls with holes, furniture.

Metres, +y up. A `Builder` keeps one mesh per material, so that a room has few of them.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np

import daguerre as dg

Point = tuple[float, float, float]
#: Ranges of a hole along the first and the second axis of a wall, m.
Hole = tuple[tuple[float, float], tuple[float, float]]
#: Corners of the faces of a box, each counter-clockwise from outside.
SIDES = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
CORNERS = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
TRIANGLES = np.array([(0, 1, 2), (0, 2, 3)])


@dataclass
class Surface:
    """Triangles of one material: points, texture coordinates, and indices."""

    points: list[np.ndarray] = field(default_factory=list)
    uv: list[np.ndarray] = field(default_factory=list)
    faces: list[np.ndarray] = field(default_factory=list)

    def add(self, points: np.ndarray, uv: np.ndarray, faces: np.ndarray) -> None:
        """Adds triangles; indices count from their own first point."""
        self.faces.append(faces + sum(len(p) for p in self.points))
        self.points.append(points)
        self.uv.append(uv)


class Builder:
    """A scene in the making.

    Args:
        materials: Material of each name.
        scene: The scene, which has the textures of these materials.
    """

    def __init__(self, scene: dg.Scene, materials: dict[str, dg.Material]) -> None:
        self.scene, self._materials = scene, materials
        self._surfaces: dict[str, Surface] = {}

    def box(self, material: str, low: Point, high: Point, turn: float = 0.0) -> None:
        """Adds a box, turned about the vertical through the origin by degrees.

        One metre is one unit of its texture coordinates.
        """
        sides = np.subtract(high, low)
        corners = np.asarray(low) + CORNERS * sides
        for side in SIDES:
            face = corners[list(side)]
            across = int(np.argmin(np.ptp(face, axis=0)))
            u, v = {0: (2, 1), 1: (0, 2), 2: (0, 1)}[across]
            uv = np.stack([face[:, u], 1 - face[:, v]], axis=1)
            self._add(material, _turned(face, turn), uv, TRIANGLES)

    def slab(self, material: str, low: np.ndarray, thick: float) -> None:
        """Adds a slab on a rectangle (4, 3) that is clockwise from above."""
        high = low + np.array((0, thick, 0))
        faces = [low, high[::-1]]
        for i in range(4):
            j = (i + 1) % 4
            faces.append(np.array([low[i], high[i], high[j], low[j]]))
        for face in faces:
            self._add(material, face, face[:, :2], TRIANGLES)

    def wall(
        self, material: str, low: Point, high: Point, holes: Sequence[Hole] = (), across: int = 2
    ) -> None:
        """Adds a wall with rectangular holes; ``across``: axis of its thickness."""
        axes = [axis for axis in (0, 1, 2) if axis != across]
        cuts = [
            sorted({low[axis], high[axis], *(edge for hole in holes for edge in hole[i])})
            for i, axis in enumerate(axes)
        ]
        for i in range(len(cuts[0]) - 1):
            for j in range(len(cuts[1]) - 1):
                cell = [(cuts[0][i], cuts[0][i + 1]), (cuts[1][j], cuts[1][j + 1])]
                if not any(_inside(cell, hole) for hole in holes):
                    a, b = list(low), list(high)
                    for axis, (first, last) in zip(axes, cell, strict=True):
                        a[axis], b[axis] = first, last
                    self.box(material, (a[0], a[1], a[2]), (b[0], b[1], b[2]))

    def ball(self, material: str, at: Point, radius: float, rows: int = 32) -> None:
        """Adds a faceted ball."""
        v, u = np.meshgrid(
            np.linspace(0, 1, rows + 1), np.linspace(0, 1, 2 * rows + 1), indexing="ij"
        )
        theta, phi = np.pi * v, 2 * np.pi * u
        unit = np.stack([np.sin(theta) * np.sin(phi), np.cos(theta), np.sin(theta) * np.cos(phi)])
        points = np.asarray(at) + radius * unit.reshape(3, -1).T
        index = np.arange(v.size).reshape(v.shape)
        a, b, c, d = index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]
        lower = np.stack([a, b, c], -1)[:-1].reshape(-1, 3)  # the last row ends at the pole
        upper = np.stack([a, c, d], -1)[1:].reshape(-1, 3)
        self._add(material, points, np.stack([u, v], -1).reshape(-1, 2), np.vstack([lower, upper]))

    def lamp(self, at: Point, half: tuple[float, float], radiance: Point) -> None:
        """Adds a panel that shines down."""
        x, y, z = at
        a, b = half
        points = [(x - a, y, z - b), (x + a, y, z - b), (x + a, y, z + b), (x - a, y, z + b)]
        light = dg.Material(dg.Diffuse((0.0, 0.0, 0.0)), emission=radiance)
        self.scene.add_instance(self.scene.add_mesh(points, TRIANGLES), light)

    def finish(self) -> dg.Scene:
        """Adds the meshes to the scene."""
        for name, surface in self._surfaces.items():
            mesh = self.scene.add_mesh(
                np.concatenate(surface.points),
                np.concatenate(surface.faces),
                uv=np.concatenate(surface.uv),
                name=name,
            )
            self.scene.add_instance(mesh, self._materials[name])
        return self.scene

    def _add(self, material: str, points: np.ndarray, uv: np.ndarray, faces: np.ndarray) -> None:
        if material not in self._materials:
            raise KeyError(f"room: wanted one of {sorted(self._materials)}, got {material!r}")
        self._surfaces.setdefault(material, Surface()).add(points, uv, faces)


class Placed:
    """Puts boxes at a point of the floor, turned about the vertical by degrees."""

    def __init__(self, builder: Builder, at: tuple[float, float], turn: float = 0.0) -> None:
        self._builder, self._turn = builder, turn
        back = _turned(np.array([(at[0], 0.0, at[1])]), -turn)[0]
        self._x, self._z = float(back[0]), float(back[2])

    def box(self, material: str, low: Point, high: Point) -> None:
        """Adds a box, given from the point."""
        a, b = ((x + self._x, y, z + self._z) for x, y, z in (low, high))
        self._builder.box(material, a, b, self._turn)


def table(
    place: Placed, top: str, legs: str, half: tuple[float, float], height: float = 0.74
) -> None:
    """A table on four legs."""
    x, z = half
    place.box(top, (-x, height - 0.04, -z), (x, height, z))
    for i in (-1, 1):
        for j in (-1, 1):
            a, b = i * (x - 0.06), j * (z - 0.06)
            place.box(legs, (a - 0.025, 0, b - 0.025), (a + 0.025, height - 0.04, b + 0.025))


def chair(place: Placed, seat: str, legs: str) -> None:
    """A chair whose back is at +z."""
    table(place, seat, legs, (0.21, 0.21), 0.46)
    for x in (-0.15, 0.15):
        place.box(legs, (x - 0.015, 0.46, 0.18), (x + 0.015, 0.75, 0.21))
    place.box(seat, (-0.2, 0.68, 0.17), (0.2, 0.92, 0.2))


def frame(builder: Builder, material: str, hole: Hole, across: int, at: float) -> None:
    """The bars of a window in a wall's hole: a cross, and a sill."""
    (a, b), (low, high) = hole
    x, y = (a + b) / 2, (low + high) / 2
    bars = [((x - 0.025, low), (x + 0.025, high)), ((a, y - 0.025), (b, y + 0.025))]
    for (first, bottom), (last, top) in bars:
        builder.box(material, *_across((first, bottom, at - 0.03), (last, top, at + 0.03), across))


def _across(low: Point, high: Point, across: int) -> tuple[Point, Point]:
    """A box of a wall: first along it, second up, third through it."""
    if across == 2:
        return low, high
    return (low[2], low[1], low[0]), (high[2], high[1], high[0])


def _turned(points: np.ndarray, degrees: float) -> np.ndarray:
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.asarray(points @ np.array([(c, 0, -s), (0, 1, 0), (s, 0, c)]))


def _inside(cell: Iterable[tuple[float, float]], hole: Hole) -> bool:
    return all(a <= first and last <= b for (first, last), (a, b) in zip(cell, hole, strict=True))
