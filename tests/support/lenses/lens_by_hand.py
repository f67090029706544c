"""A second, plain lens tracer for tests: numpy, all in double, film to scene, no aiming.

Nothing here is shared with the core but the lens file's numbers and the glasses' indices.
Lens frame: mm, +z to the film, z = 0 at the first vertex.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from daguerre.lenses import Lens

Array = NDArray[np.float64]


def iris_radius(lens: Lens, f_stop: float) -> float:
    """Semi-diameter of the stop, mm: the pupil's diameter is focal length / f-stop."""
    (stop,) = [s for s in lens.surfaces if s.stop]
    assert stop.semi_diameter is not None
    return stop.semi_diameter * lens.first_order().f_number / f_stop


def passes(lens: Lens, start: Array, toward: Array, iris: float, nm: float) -> Array:
    """Transmittance of rays from the film (N, 3); 0 where a mount, the iris or TIR stops them."""
    p, d = start.copy(), toward / np.linalg.norm(toward, axis=1, keepdims=True)
    out = np.ones(len(p))
    glasses = [1.0, *(s.core_glass.index(nm) for s in lens.surfaces)]
    with np.errstate(invalid="ignore", divide="ignore"):
        for i in reversed(range(len(lens.surfaces))):
            surface = lens.surfaces[i]
            p, normal = _hit(p, d, lens.vertices[i], surface.radius)
            limit = iris if surface.stop else surface.semi_diameter or math.inf
            out = np.where(np.hypot(p[:, 0], p[:, 1]) <= limit, out, 0)
            d, transmitted = _refract(d, normal, glasses[i + 1], glasses[i], lens.coating, nm)
            out = np.nan_to_num(out * transmitted)
    return out


def _hit(p: Array, d: Array, vertex: float, radius: float | None) -> tuple[Array, Array]:
    """Crossing with a sphere or plane, and the unit normal that faces +z."""
    if radius is None:
        normal = np.zeros_like(d)
        normal[:, 2] = 1
        return p + d * ((vertex - p[:, 2]) / d[:, 2])[:, None], normal
    center = np.array([0, 0, vertex + radius])
    o = p - center
    b = (o * d).sum(axis=1)
    root = np.sqrt(b * b - (o * o).sum(axis=1) + radius * radius)
    # Rays run to -z: the vertex's half of the sphere is met last if the centre lies behind it.
    hit = p + d * (-b + (root if radius > 0 else -root))[:, None]
    return hit, (center - hit) / radius


def _refract(
    d: Array, normal: Array, n1: float, n2: float, coating: str, nm: float
) -> tuple[Array, Array]:
    """Snell's law for rays to -z, and the share of unpolarised light that passes."""
    if n1 == n2:
        return d, np.ones(len(d))
    cos1 = -(d * normal).sum(axis=1)
    mu = n1 / n2
    cos2 = np.sqrt(1 - mu * mu * (1 - cos1 * cos1))
    out = mu * d + (mu * cos1 - cos2)[:, None] * normal
    film = 1.38 if coating == "mgf2" and min(n1, n2) == 1 else n1
    cosf = np.sqrt(1 - (n1 / film) ** 2 * (1 - cos1 * cos1))
    beta = math.pi / 2 * 550 / nm * cosf  # a quarter wave of MgF2 at 550 nm
    total = np.zeros(len(d))
    for s in (True, False):

        def r(na: float, ca: Array, nb: float, cb: Array, s: bool = s) -> Array:
            x, y = (na * ca, nb * cb) if s else (na * cb, nb * ca)
            return (x - y) / (x + y)

        r1, r2 = r(n1, cos1, film, cosf), r(film, cosf, n2, cos2)
        phase = np.exp(2j * beta)  # Airy: r = (r1 + r2 e^2ib) / (1 + r1 r2 e^2ib)
        total += 0.5 * (1 - np.abs((r1 + r2 * phase) / (1 + r1 * r2 * phase)) ** 2)
    return out, total if coating != "perfect" else np.ones(len(d))


def irradiance(lens: Lens, film_z: float, radius: float, f_stop: float, nm: float = 555) -> float:
    """E / L at a film radius (mm): the rear element's disc under cos^4 / Z^2 (Kolb 1995).

    A coarse grid finds where light comes from, a fine one measures it.
    """
    rear = lens.surfaces[-1].semi_diameter
    assert rear is not None
    distance = film_z - lens.vertices[-1]
    iris = iris_radius(lens, f_stop)
    low, high = np.full(2, -1.3 * rear), np.full(2, 1.3 * rear)
    value = 0.0
    for count in (64, 50, 120):
        step = (high - low) / count
        x, y = (low[k] + (np.arange(count) + 0.5) * step[k] for k in range(2))
        grid = np.stack(np.meshgrid(x, y, indexing="ij"), -1).reshape(-1, 2)
        start = np.tile([0.0, radius, film_z], (len(grid), 1))
        toward = np.column_stack([grid[:, 0], grid[:, 1] - radius, np.full(len(grid), -distance)])
        share = passes(lens, start, toward, iris, nm)
        cos4 = (distance**2 / (toward**2).sum(axis=1)) ** 2
        value = float((share * cos4).sum() * step[0] * step[1] / distance**2)
        seen = grid[share > 0]
        if not len(seen):
            return 0.0
        low, high = seen.min(axis=0) - 1.5 * step, seen.max(axis=0) + 1.5 * step
    return value
