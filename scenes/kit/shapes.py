"""Shapes as arrays, in metres, y up; front faces are counter-clockwise seen from outside."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daguerre.exporters.gltf import Shape


def _shape(p: ArrayLike, n: ArrayLike, uv: ArrayLike, i: ArrayLike) -> Shape:
    return Shape(
        np.asarray(p, np.float32).reshape(-1, 3),
        np.asarray(n, np.float32).reshape(-1, 3),
        np.asarray(uv, np.float32).reshape(-1, 2),
        np.asarray(i, np.uint32).reshape(-1, 3),
    )


def join(*shapes: Shape) -> Shape:
    """Several shapes as one."""
    offsets = np.cumsum([0] + [len(s.positions) for s in shapes])
    return _shape(
        np.concatenate([s.positions for s in shapes]),
        np.concatenate([s.normals for s in shapes]),
        np.concatenate([s.uv for s in shapes]),
        np.concatenate([s.indices + o for s, o in zip(shapes, offsets, strict=False)]),
    )


def by_matter(parts: Sequence[tuple[Shape, int]]) -> list[tuple[Shape, int]]:
    """Shapes of one material as one, in the order in which materials come first."""
    matters = dict.fromkeys(matter for _, matter in parts)
    return [(join(*(shape for shape, of in parts if of == m)), m) for m in matters]


def moved(shape: Shape, offset: Sequence[float]) -> Shape:
    """The same shape elsewhere."""
    p = shape.positions + np.asarray(offset, np.float32)
    return Shape(p, shape.normals, shape.uv, shape.indices)


def standing(shape: Shape) -> Shape:
    """The same shape with its lowest point at y = 0."""
    return moved(shape, (0, -float(shape.positions[:, 1].min()), 0))


def _grid_indices(rows: int, columns: int) -> NDArray[np.uint32]:
    r, c = np.meshgrid(np.arange(rows - 1), np.arange(columns - 1), indexing="ij")
    a = (r * columns + c).reshape(-1)
    b, d, e = a + 1, a + columns, a + columns + 1
    return np.stack([a, b, e, a, e, d], 1).reshape(-1, 3).astype(np.uint32)


def smooth_profile(points: Sequence[tuple[float, float]], steps: int = 6) -> NDArray[np.float64]:
    """A Catmull-Rom curve through profile points (radius, height)."""
    p = np.asarray(points, float)
    p = np.concatenate([[2 * p[0] - p[1]], p, [2 * p[-1] - p[-2]]])
    t = np.linspace(0, 1, steps, endpoint=False)[:, None]
    out = [
        0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t**2)
        + 0.5 * (3 * b - a - 3 * c + d) * t**3
        for a, b, c, d in zip(p, p[1:], p[2:], p[3:], strict=False)
    ]
    curve = np.concatenate([*out, p[-2:-1]])
    return np.stack([np.maximum(curve[:, 0], 0), curve[:, 1]], 1)


def lathe(profile: ArrayLike, segments: int = 64, crease_deg: float = 40) -> Shape:
    """Turns a profile (radius, height) about the y axis.

    Going up with the outside to the right gives outward normals. Bends sharper than `crease_deg`
    stay sharp. uv: u around, v along the profile.
    """
    p = np.asarray(profile, float)
    d = np.diff(p, axis=0)
    keep = np.concatenate([[True], np.hypot(d[:, 0], d[:, 1]) > 1e-9])
    p = p[keep]
    d = np.diff(p, axis=0)
    n = np.stack([d[:, 1], -d[:, 0]], 1) / np.hypot(d[:, 0], d[:, 1])[:, None]
    along = np.concatenate([[0], np.cumsum(np.hypot(d[:, 0], d[:, 1]))])
    along /= along[-1]
    bands: list[list[tuple[NDArray[np.float64], NDArray[np.float64], float]]] = [[]]
    for k in range(len(p)):
        before = n[k - 1] if k > 0 else n[0]
        after = n[k] if k < len(n) else n[-1]
        if before @ after < math.cos(math.radians(crease_deg)):
            bands[-1].append((p[k], before, along[k]))
            bands.append([(p[k], after, along[k])])
        else:
            mean = before + after
            bands[-1].append((p[k], mean / np.hypot(*mean), along[k]))
    angle = np.linspace(0, 2 * math.pi, segments + 1)
    cos, sin = np.cos(angle), np.sin(angle)
    parts = []
    for band in bands:
        rn = np.array([[q[0], q[1], m[0], m[1], v] for q, m, v in band])
        r, y, nr, ny, v = (rn[:, i : i + 1] for i in range(5))
        one = np.ones_like(cos)
        pos = np.stack([r * cos, y * one, -r * sin], -1)
        nor = np.stack([nr * cos, ny * one, -nr * sin], -1)
        uv = np.stack([np.ones_like(v) * (angle / (2 * math.pi)), (1 - v) * one], -1)
        parts.append(_shape(pos, nor, uv, _grid_indices(len(band), segments + 1)))
    return _without_slivers(join(*parts))


def _without_slivers(shape: Shape) -> Shape:
    a, b, c = (shape.positions[shape.indices[:, k]].astype(float) for k in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    return Shape(shape.positions, shape.normals, shape.uv, shape.indices[area > 1e-14])


def ball(radius: float, rings: int = 24, segments: int = 48) -> Shape:
    """A sphere with longitude and latitude as uv."""
    a = np.linspace(-math.pi / 2, math.pi / 2, rings + 1)
    return lathe(radius * np.stack([np.cos(a).clip(0), np.sin(a)], 1), segments, 180)


def ico_ball(radius: float, level: int = 1) -> Shape:
    """A sphere of 20 * 4^level near-equal triangles: what small lamps are made of."""
    g = (1 + math.sqrt(5)) / 2
    p = np.array([(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0)], float)
    p = np.concatenate([p, p[:, [2, 0, 1]], p[:, [1, 2, 0]]])
    p /= np.linalg.norm(p[0])
    edge = np.linalg.norm(p[0] - p[1])
    near = np.linalg.norm(p[:, None] - p[None], axis=-1) < edge * 1.01
    tris = [
        (i, j, k) if np.dot(np.cross(p[i], p[j]), p[k]) > 0 else (i, k, j)
        for i in range(12)
        for j in range(i + 1, 12)
        for k in range(j + 1, 12)
        if near[i, j] and near[j, k] and near[i, k]
    ]
    corners = p[np.array(tris)]  # (T, 3, 3)
    for _ in range(level):
        a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
        ab, bc, ca = a + b, b + c, c + a
        parts = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        corners = np.concatenate([np.stack(q, 1) for q in parts])
        corners /= np.linalg.norm(corners, axis=-1, keepdims=True)
    flat, index = np.unique(corners.reshape(-1, 3).round(9), axis=0, return_inverse=True)
    return _shape(flat * radius, flat, np.zeros((len(flat), 2)), index)


def box(size: Sequence[float], uv_rects: Sequence[Sequence[float]] | None = None) -> Shape:
    """A box on y = 0, centred in x and z. Faces +x -x +y -y +z -z; each takes (u0, v0, u1, v1)."""
    s = np.asarray(size, float)
    faces = [((0, 0, -1), (0, 1, 0)), ((0, 0, 1), (0, 1, 0)), ((1, 0, 0), (0, 0, -1))]
    faces += [((1, 0, 0), (0, 0, 1)), ((1, 0, 0), (0, 1, 0)), ((-1, 0, 0), (0, 1, 0))]
    parts = []
    for k, (right, up) in enumerate(faces):
        r, u = np.array(right, float), np.array(up, float)
        n = np.cross(r, u)
        corners = [n - r - u, n + r - u, n + r + u, n - r + u]
        pos = np.array(corners) * s / 2 + (0, s[1] / 2, 0)
        u0, v0, u1, v1 = uv_rects[k] if uv_rects else (0, 0, 1, 1)
        uv = [(u0, v1), (u1, v1), (u1, v0), (u0, v0)]
        parts.append(_shape(pos, np.tile(n, (4, 1)), uv, [(0, 1, 2), (0, 2, 3)]))
    return join(*parts)


def slab(outline: ArrayLike, height: float) -> Shape:
    """A convex outline (x, z), counter-clockwise from above, with thickness; uv spans its box."""
    o = np.asarray(outline, float)
    low, high = o.min(0), o.max(0)
    uv = (o - low) / (high - low)
    m = len(o)
    fan = np.array([(0, k, k + 1) for k in range(1, m - 1)])
    top = np.stack([o[:, 0], np.full(m, height), o[:, 1]], 1)
    bottom = top * (1, 0, 1)
    up, down = np.tile((0, 1, 0), (m, 1)), np.tile((0, -1, 0), (m, 1))
    nxt = np.roll(o, -1, 0)
    side = np.stack([-(nxt - o)[:, 1], np.zeros(m), (nxt - o)[:, 0]], 1)
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    quads = np.stack([bottom, np.roll(bottom, -1, 0), np.roll(top, -1, 0), top], 1)
    i = 4 * np.arange(m)[:, None]
    walls = _shape(
        quads,
        np.repeat(side, 4, 0),
        np.repeat(uv, 4, 0) * 0,
        np.concatenate([i + np.array(k) for k in ((0, 1, 2), (0, 2, 3))]),
    )
    parts = [_shape(top, up, uv, fan), _shape(bottom, down, uv, fan[:, ::-1]), walls]
    return join(*parts)


def tube(path: ArrayLike, radius: float, sides: int = 8) -> Shape:
    """A wire along points (N, 3)."""
    p = np.asarray(path, float)
    t = np.gradient(p, axis=0)
    t /= np.linalg.norm(t, axis=1, keepdims=True)
    helper = np.where(np.abs(t[:, 1:2]) > 0.9, (1.0, 0, 0), (0, 1.0, 0))
    a = np.cross(helper, t)
    a /= np.linalg.norm(a, axis=1, keepdims=True)
    b = np.cross(t, a)
    angle = np.linspace(0, 2 * math.pi, sides + 1)[None, :, None]
    n = a[:, None] * np.cos(angle) + b[:, None] * np.sin(angle)
    uv = np.zeros((*n.shape[:2], 2))
    pos = p[:, None] + radius * n
    return _shape(pos, n, uv, _grid_indices(len(p), sides + 1))


def disc(radius: float, sides: int = 10) -> Shape:
    """A flat disc that faces +z."""
    a = np.linspace(0, 2 * math.pi, sides, endpoint=False)
    p = radius * np.stack([np.cos(a), np.sin(a), 0 * a], 1)
    fan = [(0, k, k + 1) for k in range(1, sides - 1)]
    return _shape(p, np.tile((0, 0, 1), (sides, 1)), p[:, :2] / (2 * radius) + 0.5, fan)


def square(width: float, height: float, uv: Sequence[float] = (0, 0, 1, 1)) -> Shape:
    """A rectangle in the xy plane about the origin that faces +z; uv runs from its upper left."""
    x, y = width / 2, height / 2
    p = [(-x, -y, 0), (x, -y, 0), (x, y, 0), (-x, y, 0)]
    u0, v0, u1, v1 = uv
    corners = [(u0, v1), (u1, v1), (u1, v0), (u0, v0)]
    return _shape(p, np.tile((0, 0, 1), (4, 1)), corners, [(0, 1, 2), (0, 2, 3)])


def surface(points: ArrayLike, tiles: Sequence[float] = (1, 1)) -> Shape:
    """A curved sheet through a grid of points (R, C, 3), seen from where columns x rows points.

    uv: u along the columns, v along the rows, each from 0 to `tiles`. Rows or columns that end
    where they began are smooth across that seam.
    """
    p = np.asarray(points, float)
    slopes = []
    for axis in (0, 1):
        d = np.gradient(p, axis=axis)
        ends = np.moveaxis(d, axis, 0)
        first, last = np.moveaxis(p, axis, 0)[[0, -1]]
        if np.allclose(first, last):
            ends[0] = ends[-1] = ends[0] + ends[-1]
        slopes.append(d)
    n = np.cross(slopes[1], slopes[0])
    length = np.linalg.norm(n, axis=-1, keepdims=True)
    n /= np.maximum(length, 1e-20)
    for end, beside in ((0, 1), (-1, -2)):  # a row that has shrunk to a point
        n[end] = np.where(length[end] < 1e-12, n[beside], n[end])
    rows, columns = p.shape[:2]
    v, u = np.meshgrid(np.linspace(0, 1, rows), np.linspace(0, 1, columns), indexing="ij")
    uv = np.stack([u * tiles[0], v * tiles[1]], -1)
    return _without_slivers(_shape(p, n, uv, _grid_indices(rows, columns)))


def turned(shape: Shape, rotation: ArrayLike) -> Shape:
    """The same shape turned by a rotation matrix (3, 3)."""
    r = np.asarray(rotation, np.float32).T
    return Shape(shape.positions @ r, shape.normals @ r, shape.uv, shape.indices)


def swept(path: ArrayLike, radii: ArrayLike, sides: int = 24, closed: bool = False) -> Shape:
    """A tube along points (N, 3) with a radius at each, and uv: u around, v along.

    Its frame is carried from point to point without twist; a closed one spreads the rest.
    """
    p, r = np.asarray(path, float), np.asarray(radii, float)
    t = np.gradient(p, axis=0)
    if closed:  # the last point is the first again
        t[0] = t[-1] = p[1] - p[-2]
    t /= np.linalg.norm(t, axis=1, keepdims=True)
    a = np.empty_like(p)
    helper = (1.0, 0, 0) if abs(t[0, 1]) > 0.9 else (0, 1.0, 0)
    a[0] = np.cross(helper, t[0])
    for k in range(len(p)):
        a[k] = a[max(k - 1, 0)] if k else a[0]
        a[k] -= t[k] * (a[k] @ t[k])
        a[k] /= np.linalg.norm(a[k])
    b = np.cross(t, a)
    rest = math.atan2(a[-1] @ b[0], a[-1] @ a[0]) if closed else 0.0
    turn = np.linspace(0, 2 * math.pi, sides + 1) - rest * np.linspace(0, 1, len(p))[:, None]
    ring = a[:, None] * np.cos(turn)[..., None] + b[:, None] * np.sin(turn)[..., None]
    return surface(p[:, None] + r[:, None, None] * ring)


def faceted(shape: Shape) -> Shape:
    """The same triangles, each flat: what is cut rather than turned."""
    p = shape.positions[shape.indices]
    n = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    corners = np.arange(3 * len(p)).reshape(-1, 3)
    return _shape(p, np.repeat(n, 3, axis=0), shape.uv[shape.indices], corners)
