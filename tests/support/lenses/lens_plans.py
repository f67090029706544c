"""Made-up lens plans for tests of exported code, and what they say, written a second time."""

from __future__ import annotations

import math
from itertools import pairwise, product

import numpy as np

from daguerre.export.plan import Aim, Blades, LensPlan, Mount, Segment, Vector


def _terms(rng, symmetric, degree, linear, size=0.02):
    """Random small coefficients, and one that is not small."""
    count = 4 if symmetric else 5
    choices = [e for e in product(range(degree + 1), repeat=count) if sum(e) + e[-1] <= degree]
    terms = {e: float(size * rng.standard_normal()) for e in choices}
    for exponents, value in linear.items():
        terms[exponents] = value
    return terms


def _vector(rng, symmetric, degree, along_film, along_pupil, rough=0.01):
    """Near along_film f + along_pupil q."""
    size = rough * max(abs(along_film), abs(along_pupil))
    if symmetric:
        zero = (0, 0, 0, 0)
        parts = [{zero: along_film}, {zero: along_pupil}]
    else:
        parts = [
            {(0, 0, 1, 0, 0): along_film, (1, 0, 0, 0, 0): along_pupil},
            {(0, 0, 0, 1, 0): along_film, (0, 1, 0, 0, 0): along_pupil},
        ]
    return Vector(*(_terms(rng, symmetric, degree, part, size) for part in parts))


def made_up(symmetric=True, blades=False, segments=2, aim=True, wide=0.5, rough=0.01, inner=1.0):
    """A lens like a 50 mm f/2, partly random; `wide`: its view at the film's edge, radians."""
    rng = np.random.default_rng(7)
    degree = 3 if symmetric else 4
    edges_u = np.linspace(0, 1, segments + 1)
    zero = {(0,) * (4 if symmetric else 5): 0.9}

    def vector(along_film, along_pupil):
        return _vector(rng, symmetric, degree, along_film, along_pupil, rough)

    made = tuple(
        Segment(
            u_low=float(low),
            u_high=float(high),
            direction=vector(-wide, -0.02),
            offset_mm=vector(0.3, 12.0),
            iris_mm=vector(0.4, 9.0),
            transmittance=_terms(rng, symmetric, degree, zero, 0.002),
            mounts=(Mount(2, vector(3.0, 10.0), 11.5, inner),),
            bend=vector(0.02, -0.03) if low == 0 else None,
        )
        for low, high in pairwise(edges_u)
    )
    edges = tuple((math.cos(a), math.sin(a)) for a in 2 * np.pi * (np.arange(6) + 0.2) / 6)
    iris = Blades(edges, 0.92, 1, -0.5, 1.45, 1.08) if blades else None
    slope = vector(22 / 50, -8.5 / 50)
    return LensPlan(
        name="Made-up 50 mm f/2",
        film_z_mm=60.0,
        symmetric=symmetric,
        film_center_mm=(0.0, 0.0) if symmetric else (1.0, -2.0),
        film_half_mm=(22.0, 22.0) if symmetric else (20.0, 15.0),
        q_by_film=(22 / 14, 22 / 14) if symmetric else (20 / 14, 15 / 14),
        q_by_slope=(-50 / 14, -50 / 14),
        q_shift=(0.0, 0.0) if symmetric else (1 / 14, -2 / 14),
        wavelength=(-1.6, 0.6),
        pupil_z_mm=20.0,
        front_z_mm=0.5,
        front_curvature=1 / 35,
        f_stop=2.0,
        iris_radius_mm=8.5,
        blades=iris,
        segments=made,
        aim=Aim(slope, 8.8, 1.01, 1.0) if aim else None,
        exposure=(0.18, 0.002),
    )


def evaluated(plan, film, slope, nm, f_stop):
    """Expects of evaluate() for one ray: origin, direction, iris, transmittance, stopped."""
    f = (np.array(film) - plan.film_center_mm) / plan.film_half_mm
    q = plan.q_by_film * f + plan.q_by_slope * np.array(slope) + plan.q_shift
    wave = plan.wavelength[0] + plan.wavelength[1] / (nm * 1e-3) ** 2
    segment = next((s for s in plan.segments if f @ f < s.u_high), plan.segments[-1])
    middle, half = (segment.u_low + segment.u_high) / 2, (segment.u_high - segment.u_low) / 2
    outside = (f @ f if plan.symmetric else max(abs(f))) > 1 or math.hypot(*q) > 1

    def scalar(terms, q=q):
        symmetric = f @ q, 2 * q @ q - 1, (f @ f - middle) / half, wave
        variables = symmetric if plan.symmetric else (*q, *f, wave)
        return sum(c * math.prod(v**k for v, k in zip(variables, e)) for e, c in terms.items())  # noqa: B905

    def vector(v, q=q):
        a, b = scalar(v.first, q), scalar(v.second, q)
        return f * a + q * b if plan.symmetric else np.array([a, b])

    bent = q if segment.bend is None else q + vector(segment.bend, q)
    toward = vector(segment.direction, bent)
    theta = np.hypot(*toward)
    h = np.array([*toward / theta, 0.0])
    e = np.array([0.0, 0.0, -1.0])
    direction = math.sin(theta) * h + math.cos(theta) * e
    offset = np.array([*vector(segment.offset_mm), 0.0])
    # Rodrigues: the minimal rotation from e to the direction, about e x h.
    k = np.cross(e, h)
    turned = (
        offset * math.cos(theta)
        + np.cross(k, offset) * math.sin(theta)
        + k * (k @ offset) * (1 - math.cos(theta))
    )
    iris = vector(segment.iris_mm)
    stopped = outside
    rims = [(math.hypot(*vector(m.point)), m) for m in segment.mounts]
    stopped |= any(not m.inner_mm <= r <= m.clear_mm for r, m in rims)
    stopped |= not _in_iris(plan, iris / (plan.iris_radius_mm * min(1, plan.f_stop / f_stop)))
    passed = 0.0 if stopped else min(max(scalar(segment.transmittance), 0.0), 1.0)
    origin = _on_front(plan, turned + np.array([0, 0, plan.pupil_z_mm]), direction)
    return np.array([*origin, *direction, *iris, passed, float(stopped)])


def _on_front(plan, foot, direction):
    """Where the ray meets the front half of the front sphere; the foot if it misses the sphere."""
    radius = 1 / plan.front_curvature
    from_center = foot - np.array([0, 0, plan.front_z_mm + radius])
    b = from_center @ direction
    root = b * b - from_center @ from_center + radius**2
    if root < 0:
        return foot
    return foot + (math.sqrt(root) - b) * direction


def _in_iris(plan, p):
    if plan.blades is None:
        return math.hypot(*p) <= 1
    b = plan.blades
    for edge in np.array(b.edges):
        if b.bend <= 0 and edge @ p > b.apothem:
            return False
        if b.bend * (np.hypot(*(p - b.center * edge)) - b.arc_radius) > 0:
            return False
    return True
