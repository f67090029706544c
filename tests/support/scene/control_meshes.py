"""Small control meshes: points and faces."""

from __future__ import annotations

import numpy as np

Faces = list[list[int]]
Mesh = tuple[np.ndarray, Faces]


def cube() -> Mesh:
    points = [[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    faces = [
        [0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]
    ]  # fmt: skip
    return np.array(points, float), faces


def grid(columns: int, rows: int) -> Mesh:
    points = [[i, j, 0] for i in range(columns + 1) for j in range(rows + 1)]
    step = rows + 1
    faces = [
        [i * step + j, (i + 1) * step + j, (i + 1) * step + j + 1, i * step + j + 1]
        for i in range(columns)
        for j in range(rows)
    ]
    return np.array(points, float), faces


def prism(sides: int) -> Mesh:
    turn = 2 * np.pi * np.arange(sides) / sides
    rings = [[np.cos(t), np.sin(t), z] for z in (-1, 1) for t in turn]
    walls = [[i, (i + 1) % sides, sides + (i + 1) % sides, sides + i] for i in range(sides)]
    ends = [list(range(sides))[::-1], list(range(sides, 2 * sides))]
    return np.array(rings), ends + walls


def cone(sides: int) -> Mesh:
    turn = 2 * np.pi * np.arange(sides) / sides
    rim = [[np.cos(t), np.sin(t), 0] for t in turn]
    faces = [[0, 1 + i, 1 + (i + 1) % sides] for i in range(sides)]
    return np.array([[0, 0, 0.5], *rim]), faces


def fins() -> Mesh:
    """Three strips at one line: edges with three faces."""
    points = [
        [x, y, z] for x, y in ((0, 0), (1, 0), (-1, 0), (0, 1)) for z in range(3)
    ]  # fmt: skip
    faces = [[0, 3, 4, 1], [1, 4, 5, 2], [6, 0, 1, 7], [7, 1, 2, 8], [0, 9, 10, 1], [1, 10, 11, 2]]
    return np.array(points, float), faces


def icosahedron() -> Mesh:
    g = (1 + 5**0.5) / 2
    points = [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g)]
    points += [(0, -1, -g), (0, 1, -g), (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]
    faces = [
        [0, 11, 5], [0, 5, 1], [0, 1, 7], [0, 7, 10], [0, 10, 11], [1, 5, 9], [5, 11, 4],
        [11, 10, 2], [10, 7, 6], [7, 1, 8], [3, 9, 4], [3, 4, 2], [3, 2, 6], [3, 6, 8],
        [3, 8, 9], [4, 9, 5], [2, 4, 11], [6, 2, 10], [8, 6, 7], [9, 8, 1],
    ]  # fmt: skip
    return np.array(points, float), faces


def torus(around: int, across: int, *, triangles: bool = False) -> Mesh:
    u = 2 * np.pi * np.arange(around)[:, None] / around
    v = 2 * np.pi * np.arange(across)[None] / across
    far = 2 + np.cos(v)
    points = np.stack([far * np.cos(u), far * np.sin(u), np.sin(v) + 0 * u], axis=-1)
    i, j = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    after = (i + 1) % around * across + j, i * across + (j + 1) % across
    both = (i + 1) % around * across + (j + 1) % across
    quads = np.stack([i * across + j, after[0], both, after[1]], axis=-1).reshape(-1, 4)
    if triangles:
        quads = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    return points.reshape(-1, 3), quads.tolist()
