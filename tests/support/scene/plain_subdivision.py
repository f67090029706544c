"""Subdivision by the book: dictionaries, one face and one vertex after the other.

It shares nothing with ``daguerre.scene.subdivision``, and finds limits by brute force: around one
vertex a mesh is refined dozens of times, as the faces at a vertex depend on these faces alone.
Sources: Catmull and Clark 1978; Loop 1987; DeRose, Kass and Truong 1998.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np

Edge = frozenset[int]
Face = tuple[int, ...]
Point = np.ndarray
FOREVER = 10.0


def sides(face: Face) -> list[tuple[int, int]]:
    return list(zip(face, face[1:] + face[:1], strict=True))


def softer(sharpness: float) -> float:
    return sharpness if sharpness >= FOREVER else max(sharpness - 1, 0)


@dataclass
class Plain:
    """A mesh: points, faces, and what is sharp."""

    points: list[Point]
    faces: list[Face]
    edges: dict[Edge, float] = field(default_factory=dict)
    corners: dict[int, float] = field(default_factory=dict)
    loop: bool = False

    def uses(self) -> dict[Edge, list[tuple[int, int]]]:
        """Faces of each edge, and the place of the edge in them."""
        found: dict[Edge, list[tuple[int, int]]] = {}
        for f, face in enumerate(self.faces):
            for i, side in enumerate(sides(face)):
                found.setdefault(frozenset(side), []).append((f, i))
        return found

    def closed(self, corners_are_sharp: bool) -> Plain:
        """The mesh with sharp boundaries, and with sharp corners of one face if that is asked."""
        uses = self.uses()
        edges = dict(self.edges)
        for edge, found in uses.items():
            ways = {sides(self.faces[f])[i] for f, i in found}
            if len(found) != 2 or len(ways) != 2:
                edges[edge] = FOREVER
        counts = Counter(v for face in self.faces for v in face)
        border = {v for edge, found in uses.items() if len(found) == 1 for v in edge}
        corners = dict(self.corners)
        if corners_are_sharp:
            corners |= {v: FOREVER for v in border if counts[v] == 1}
        return Plain(self.points, self.faces, edges, corners, self.loop)

    def refined(self) -> Plain:
        uses = self.uses()
        middles = [sum(self.points[v] for v in face) / len(face) for face in self.faces]
        number = {edge: len(self.points) + i for i, edge in enumerate(uses)}
        points = [self.vertex(v, uses, middles) for v in range(len(self.points))]
        points += [self.edge_point(edge, found, middles) for edge, found in uses.items()]
        faces: list[Face] = []
        for f, face in enumerate(self.faces):
            halves = [number[frozenset(side)] for side in sides(face)]
            for i, v in enumerate(face):
                tail = () if self.loop else (len(points) + f,)
                faces.append((v, halves[i], *tail, halves[i - 1]))
            if self.loop:
                faces.append(tuple(halves))
        edges = {
            frozenset((v, number[edge])): softer(s)
            for edge, s in self.edges.items()
            if edge in number
            for v in edge
        }
        corners = {v: softer(s) for v, s in self.corners.items()}
        return Plain(points + ([] if self.loop else middles), faces, edges, corners, self.loop)

    def edge_point(self, edge: Edge, found: list[tuple[int, int]], middles: list[Point]) -> Point:
        a, b = (self.points[v] for v in edge)
        blend = min(self.edges.get(edge, 0.0), 1.0)
        if blend == 1.0 or len(found) != 2:
            return (a + b) / 2
        if self.loop:
            far = [self.points[next(v for v in self.faces[f] if v not in edge)] for f, _ in found]
            smooth = 3 / 8 * (a + b) + 1 / 8 * (far[0] + far[1])
        else:
            smooth = (a + b + middles[found[0][0]] + middles[found[1][0]]) / 4
        return blend * (a + b) / 2 + (1 - blend) * smooth

    def vertex(
        self, v: int, uses: dict[Edge, list[tuple[int, int]]], middles: list[Point]
    ) -> Point:
        around = [edge for edge in uses if v in edge]
        now = {edge: self.edges.get(edge, 0.0) for edge in around}
        corner = self.corners.get(v, 0.0)
        later = {edge: softer(s) for edge, s in now.items()}
        rule, then = rule_of(corner, now), rule_of(softer(corner), later)
        if not around:
            return self.points[v]
        first = self.by_rule(v, rule, now, middles)
        if rule == then or rule == "smooth":
            return first
        ending = [s for edge, s in now.items() if s > 0 and later[edge] <= 0]
        ending += [corner] if corner > 0 and softer(corner) <= 0 else []
        share = min(sum(ending) / len(ending), 1)
        return share * first + (1 - share) * self.by_rule(v, then, later, middles)

    def by_rule(self, v: int, rule: str, around: dict[Edge, float], middles: list[Point]) -> Point:
        own = self.points[v]
        others = {edge: self.points[next(iter(edge - {v}))] for edge in around}
        if rule == "corner":
            return own
        if rule == "crease":
            ends = [others[edge] for edge, s in around.items() if s > 0]
            return 3 / 4 * own + 1 / 8 * (ends[0] + ends[1])
        n = len(around)
        if self.loop:
            beta = (5 / 8 - (3 / 8 + math.cos(2 * math.pi / n) / 4) ** 2) / n
            return (1 - n * beta) * own + beta * sum(others.values())
        faces = sum(middles[f] for f, face in enumerate(self.faces) if v in face)
        return (n - 2) / n * own + (sum(others.values()) + faces) / n**2

    def near(self, v: int) -> Plain:
        """The faces at a vertex alone, which becomes number 0."""
        faces = [face for face in self.faces if v in face]
        order = {v: 0}
        for face in faces:
            for one in face:
                order.setdefault(one, len(order))
        known = set(order)
        return Plain(
            [self.points[one] for one in order],
            [tuple(order[one] for one in face) for face in faces],
            {
                frozenset(order[one] for one in edge): s
                for edge, s in self.edges.items()
                if edge <= known
            },
            {order[one]: s for one, s in self.corners.items() if one in known},
            self.loop,
        )

    def zoomed(self, v: int, levels: int) -> Plain:
        """The faces at a vertex after many levels; the vertex is number 0."""
        mesh = self.near(v)
        for _ in range(levels):
            mesh = mesh.refined().near(0)
        return mesh

    def limit(self, v: int, levels: int = 25) -> Point:
        """Limit of a vertex."""
        return self.zoomed(v, levels).points[0]

    def sides(self, v: int, levels: int = 40) -> list[tuple[int, Point]]:
        """Number of faces and unit normal of each side of what stays sharp at a vertex.

        The mesh is doubled about the vertex at each level, so that no digits are lost.
        """
        mesh = self.near(v)
        for _ in range(levels):
            mesh = mesh.refined().near(0)
            mesh.points = [2 * (point - mesh.points[0]) for point in mesh.points]
        return [(len(group), mesh.plane(group)) for group in mesh.groups()]

    def groups(self) -> list[list[int]]:
        """Faces at vertex 0 that no edge of endless sharpness parts."""
        uses = self.uses()
        group = list(range(len(self.faces)))
        for edge, found in uses.items():
            if 0 in edge and self.edges.get(edge, 0) < FOREVER and len(found) == 2:
                one, other = group[found[0][0]], group[found[1][0]]
                group = [one if g == other else g for g in group]
        return [[f for f in range(len(group)) if group[f] == g] for g in sorted(set(group))]

    def plane(self, faces: Iterable[int]) -> Point:
        """Mean normal of the triangles at vertex 0, each with the same weight."""
        total = np.zeros(3)
        for f in faces:
            face = self.faces[f]
            i = face.index(0)
            one = self.points[face[(i + 1) % len(face)]] - self.points[0]
            other = self.points[face[i - 1]] - self.points[0]
            cross = np.cross(one, other)
            total += cross / max(float(np.linalg.norm(cross)), 1e-300)
        return total / np.linalg.norm(total)


def rule_of(corner: float, edges: dict[Edge, float]) -> str:
    sharp = sum(s > 0 for s in edges.values())
    if corner > 0 or sharp > 2:
        return "corner"
    return "crease" if sharp == 2 else "smooth"
