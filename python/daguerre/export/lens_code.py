"""Makes the exported functions: ``evaluate`` traces a film ray, ``sample`` samples a film ray."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from .expression import Expression, Function, Name, Number, call, select
from .horner import Terms, derivative, horner
from .iris_code import outside_iris
from .plan import LensPlan, Pair, Segment, Vector

RAY = ("x", "y", "z", "dx", "dy", "dz", "iris_x", "iris_y", "transmittance", "stopped")


@dataclass(frozen=True)
class Coordinates:
    """Two vectors, and the variables of polynomials in them and the wavelength."""

    first: tuple[Expression, Expression]
    second: tuple[Expression, Expression]
    variables: tuple[Expression, ...]

    @property
    def symmetric(self) -> bool:
        """Whether the variables assume axial symmetry."""
        return len(self.variables) == 4


def coordinates(
    f: Function,
    symmetric: bool,
    first: tuple[Expression, Expression],
    second: tuple[Expression, Expression],
    wave: Expression,
    u_range: Pair = (0.0, 1.0),
) -> Coordinates:
    """Makes coordinates of a film point and a second point, both of at most 1."""
    if not symmetric:
        return Coordinates(first, second, (*second, *first, wave))
    (fx, fy), (qx, qy) = first, second
    low, high = u_range
    s = f.temporary(fx * qx + fy * qy)
    w = f.temporary(2.0 * (qx * qx + qy * qy) - 1.0)
    scale = 2.0 / (high - low)
    u = f.temporary(scale * (fx * fx + fy * fy) - (1.0 + scale * low))
    return Coordinates(first, second, (s, w, u, wave))


def vector(function: Function, v: Vector, at: Coordinates) -> tuple[Expression, Expression]:
    """Evaluates a vector; its components get names."""
    a = function.temporary(horner(function, v.first, at.variables))
    b = function.temporary(horner(function, v.second, at.variables))
    if not at.symmetric:
        return a, b
    x, y = (at.first[i] * a + at.second[i] * b for i in range(2))
    return function.temporary(x), function.temporary(y)


def segment_function(plan: LensPlan, segment: Segment, name: str) -> Function:
    """Makes the polynomials of one range of film radii; ``cut`` is 1 if a rim stops the ray."""
    names = ("tx", "ty", "ox", "oy", "ix", "iy", "pass", "cut")
    outputs = tuple(f"out_{name}" for name in names)
    f = Function(name, ("fx", "fy", "qx", "qy", "l"), outputs)
    film, q = (Name("fx"), Name("fy")), (Name("qx"), Name("qy"))
    u_range = segment.u_low, segment.u_high
    at = coordinates(f, plan.symmetric, film, q, Name("l"), u_range)
    bent = at
    if segment.bend is not None:
        bx, by = vector(f, segment.bend, at)
        q_bent = f.temporary(q[0] + bx), f.temporary(q[1] + by)
        bent = coordinates(f, plan.symmetric, film, q_bent, Name("l"), u_range)
    values = [
        *vector(f, segment.direction, bent),
        *vector(f, segment.offset_mm, at),
        *vector(f, segment.iris_mm, at),
    ]
    transmittance = horner(f, segment.transmittance, at.variables)
    cut: Expression = Number(0.0)
    for mount in segment.mounts:
        x, y = vector(f, mount.point, at)
        r2 = f.temporary(x * x + y * y)
        cut = f.temporary(select(r2 > mount.clear_mm**2, 1.0, cut))
        if mount.inner_mm > 0:
            cut = f.temporary(select(r2 < mount.inner_mm**2, 1.0, cut))
    for output, value in zip(outputs, [*values, transmittance, cut], strict=True):
        f.let(output, value)
    return f


def evaluate_function(plan: LensPlan, name: str) -> list[Function]:
    """Makes ``evaluate``, from film ray to scene ray, after the functions that it calls."""
    segments = [
        segment_function(plan, s, f"{name}_segment{i}") for i, s in enumerate(plan.segments)
    ]
    inputs = ("film_x", "film_y", "slope_x", "slope_y", "nm", "f_stop")
    f = Function(f"{name}_evaluate", inputs, tuple(f"out_{o}" for o in RAY))
    film_x, film_y, slope_x, slope_y, nm, f_stop = (Name(i) for i in inputs)
    fx, fy = normalized(f, plan, (film_x, film_y))
    pupil = [plan.q_by_film, plan.q_by_slope, plan.q_shift]
    (ax, ay), (bx, by), (cx, cy) = pupil
    qx = f.let("qx", ax * fx + bx * slope_x + cx)
    qy = f.let("qy", ay * fy + by * slope_y + cy)
    wave = wavelength(f, plan, nm)
    u: Expression = fx * fx + fy * fy
    if plan.symmetric or len(plan.segments) > 1:
        u = f.let("u_film", u)
    inside = tuple(u < s.u_high for s in plan.segments[:-1])
    tx, ty, ox, oy, ix, iy, passed, cut = f.one_of(inside, tuple(segments), fx, fy, qx, qy, wave)
    ray = scene_ray(f, plan, (tx, ty), (ox, oy))
    edge = u if plan.symmetric else call("max", call("abs", fx), call("abs", fy))
    beyond = f.temporary(select(edge > 1.0, 1.0, cut))
    beyond = f.temporary(select(qx * qx + qy * qy > 1.0, 1.0, beyond))
    unit = f.let("unit", 1.0 / (plan.iris_radius_mm * opening(f, plan, f_stop)))
    in_units = f.temporary(ix * unit), f.temporary(iy * unit)
    stopped = outside_iris(f, plan.blades, *in_units, beyond)
    light = select(stopped > 0.5, 0.0, call("min", call("max", passed, 0.0), 1.0))
    for output, value in zip(f.outputs, (*ray, ix, iy, light, stopped), strict=True):
        f.let(output, value)
    return [*segments, f]


def opening(f: Function, plan: LensPlan, f_stop: Expression) -> Expression:
    """Open share of the fit's iris radius; the entrance pupil's diameter is f / N."""
    return f.let("open_share", call("min", plan.f_stop / f_stop, 1.0))


def enumerate_terms(coefficients: tuple[float, ...]) -> dict[tuple[int, ...], float]:
    """Terms of a polynomial in one variable; the constant comes first."""
    return {(power,): c for power, c in enumerate(coefficients)}


def normalized(
    f: Function, plan: LensPlan, film: tuple[Expression, Expression]
) -> tuple[Name, Name]:
    """Normalises a film point to at most 1."""
    (cx, cy), (hx, hy) = plan.film_center_mm, plan.film_half_mm
    return f.let("fx", (film[0] - cx) * (1 / hx)), f.let("fy", (film[1] - cy) * (1 / hy))


def wavelength(f: Function, plan: LensPlan, nm: Expression) -> Name:
    """Polynomial variable of the wavelength."""
    return f.let("l", plan.wavelength[1] * 1e6 / (nm * nm) + plan.wavelength[0])


def scene_ray(
    f: Function,
    plan: LensPlan,
    t: tuple[Expression, Expression],
    o: tuple[Expression, Expression],
) -> list[Expression]:
    """Origin and unit direction from the equidistant direction t and the offset o across the ray.

    The minimal rotation from the axis to the direction also rotates o; it is regular at 90 degrees
    and beyond. With k = sin(theta/2) / (theta/2), sin(theta) / theta is k cos(theta/2) and
    (1 - cos(theta)) / theta^2 is k^2 / 2.
    """
    (tx, ty), (ox, oy) = t, o
    theta2 = f.let("theta2", tx * tx + ty * ty)
    half = f.let("half_theta", 0.5 * call("sqrt", call("max", theta2, 1e-12)))
    k = f.let("k", call("sin", half) / half)
    sinc = f.let("sinc", k * call("cos", half))
    versine = f.let("versine", 0.5 * k * k)
    along = f.let("along", ox * tx + oy * ty)
    ends = [sinc * tx, sinc * ty, versine * theta2 - 1.0]
    direction = [f.let(f"d{axis}", end) for axis, end in zip("xyz", ends, strict=True)]
    depth = plan.pupil_z_mm - plan.front_z_mm
    ends = [ox - versine * along * tx, oy - versine * along * ty, sinc * along + depth]
    foot = [f.let(f"foot_{axis}", end) for axis, end in zip("xyz", ends, strict=True)]
    far = f.let("t_front", to_front_sphere(f, plan.front_curvature, foot, direction))
    origin = [p + d * far for p, d in zip(foot, direction, strict=True)]
    return [*origin[:2], origin[2] + plan.front_z_mm, *direction]


def to_front_sphere(
    f: Function, c: float, foot: Sequence[Expression], d: Sequence[Expression]
) -> Expression:
    """Distance t from the foot p: the root of c |p + t d|^2 = 2 (p + t d).z, stable for planes."""
    across = foot[0] * d[0] + foot[1] * d[1] + foot[2] * d[2]
    square = foot[0] * foot[0] + foot[1] * foot[1] + foot[2] * foot[2]
    b = f.let("front_b", c * across - d[2])
    k = f.let("front_k", c * square - 2.0 * foot[2])
    root = f.let("root", b * b - c * k)
    hit = -k / (b + call("sqrt", call("max", root, 1e-12)))
    return select(root > 0.0, hit, 0.0)


def sample_function(plan: LensPlan, evaluate: Function, name: str) -> Function:
    """Makes ``sample``: from a film point and two random numbers to a ray and its weight."""
    inputs = ("film_x", "film_y", "u1", "u2", "nm", "f_stop")
    outputs = ("out_x", "out_y", "out_z", "out_dx", "out_dy", "out_dz", "out_weight")
    f = Function(f"{name}_sample", inputs, outputs)
    film_x, film_y, u1, u2, nm, f_stop = (Name(i) for i in inputs)
    # The image is upside down on the film.
    film = f.let("behind_x", -film_x), f.let("behind_y", -film_y)
    open_share = opening(f, plan, f_stop)
    r, angle = f.let("r", call("sqrt", u1)), f.let("angle", 2 * math.pi * u2)
    disc = f.let("disc_x", r * call("cos", angle)), f.let("disc_y", r * call("sin", angle))
    # Ratio of the areas of slopes and disc; its factor (open share)^2 cancels in the exposure.
    draw = draw_by_pupil if plan.aim is None else draw_by_aim
    (mx, my), density = draw(f, plan, film, disc, nm, open_share)
    ray = f.results(evaluate, *film, mx, my, nm, f_stop)
    x, y, z, dx, dy, dz, _, _, passed, _ = ray
    tilt = f.let("tilt", 1.0 + mx * mx + my * my)
    open2: Expression = Number(0.0)
    if len(plan.exposure) > 1:
        open2 = f.let("open2", open_share * open_share)
    exposure = horner(f, enumerate_terms(plan.exposure), (open2,))
    weight = passed * density / (exposure * tilt * tilt)
    place = (x * 1e-3, y * 1e-3, (z - plan.pupil_z_mm) * 1e-3)  # camera frame
    for output, value in zip(outputs, (*place, dx, dy, dz, weight), strict=True):
        f.let(output, value)
    return f


def draw_by_aim(
    f: Function,
    plan: LensPlan,
    film: tuple[Expression, Expression],
    disc: tuple[Expression, Expression],
    nm: Expression,
    open_share: Expression,
) -> tuple[tuple[Expression, Expression], Expression]:
    """Samples the enlarged iris: slope, and area of slopes / open share squared."""
    aim = plan.aim
    assert aim is not None
    reach = aim.enlargement * (plan.blades.outer if plan.blades else 1.0) * plan.iris_radius_mm
    grow = f.let("grow", open_share * (reach / aim.radius_mm))
    a = f.let("ax", disc[0] * grow), f.let("ay", disc[1] * grow)
    at = coordinates(f, plan.symmetric, normalized(f, plan, film), a, wavelength(f, plan, nm))
    slope = vector(f, aim.slope, at)
    # Where the map folds back, its sign changes; folded points get a density of 0.
    jacobian = f.let("jacobian", slope_jacobian(f, aim.slope, at))
    area = aim.orientation * math.pi * (reach / aim.radius_mm) ** 2
    return slope, f.let("density", call("max", area * jacobian, 0.0))


def draw_by_pupil(
    f: Function,
    plan: LensPlan,
    film: tuple[Expression, Expression],
    disc: tuple[Expression, Expression],
    nm: Expression,
    open_share: Expression,
) -> tuple[tuple[Expression, Expression], Expression]:
    """Samples the whole exit pupil, if no aim fits."""
    del nm
    at = normalized(f, plan, film)
    a, b, c = plan.q_by_film, plan.q_by_slope, plan.q_shift
    mx, my = (f.temporary((disc[i] - a[i] * at[i] - c[i]) * (1 / b[i])) for i in (0, 1))
    area = math.pi / abs(b[0] * b[1])
    return (mx, my), f.let("density", area / (open_share * open_share))


def slope_jacobian(f: Function, v: Vector, at: Coordinates) -> Expression:
    """Determinant of the derivative of a vector with respect to the second point."""
    columns = []
    if not at.symmetric:
        for k in (0, 1):
            slopes = (horner(f, derivative(t, k), at.variables) for t in (v.first, v.second))
            columns.append([f.temporary(value) for value in slopes])
    else:
        a, b = at.first, at.second
        value_b = f.temporary(horner(f, v.second, at.variables))

        def slope(terms: Terms, variable: int) -> Expression:
            return f.temporary(horner(f, derivative(terms, variable), at.variables))

        # s = f.a and 2 w - 1 = 2 a.a - 1 are the variables that depend on a.
        by_s = [slope(v.first, 0), slope(v.second, 0)]
        by_w = [slope(v.first, 1), slope(v.second, 1)]
        for k in (0, 1):
            d = [f.temporary(by_s[i] * a[k] + 4.0 * b[k] * by_w[i]) for i in (0, 1)]
            columns.append(
                [a[j] * d[0] + b[j] * d[1] + (value_b if j == k else 0.0) for j in (0, 1)]
            )
    (xx, xy), (yx, yy) = columns
    return xx * yy - xy * yx
