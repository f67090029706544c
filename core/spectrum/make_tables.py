"""Writes tables.inc: colour matching, D65, the RGB basis and the wavelength quantiles.

Needed only to change the tables. Run with colour-science 0.4.7, scipy and numpy installed:
``python core/spectrum/make_tables.py``. The renderer interpolates linearly between nodes, so every
integral of three tables is a sum of cubics per interval and Simpson's rule is exact.
"""

from pathlib import Path

import colour
import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

FloatArray = NDArray[np.float64]

STEP_NM = 5
NODES_NM = np.arange(380.0, 781.0, STEP_NM)
# ITU-R BT.709-6, table 1.3.
PRIMARIES_XY = np.array([[0.640, 0.330], [0.300, 0.600], [0.150, 0.060]])
CELLS = 512  # of the quantile table; a multiple of 4, so that quarters fall on cell borders


def triple_weights(a: FloatArray, b: FloatArray) -> FloatArray:
    """Weights w with integral(a b c) = sum(w c) for piecewise linear a, b, c.

    Args:
        a: Values at the nodes, shape (N,).
        b: Values at the nodes, shape (N,).

    Returns:
        Weights per nm, shape (N,).
    """
    middle = (a[:-1] + a[1:]) * (b[:-1] + b[1:]) / 4
    weights = np.zeros_like(a)
    weights[:-1] += (a * b)[:-1] + 2 * middle
    weights[1:] += (a * b)[1:] + 2 * middle
    return weights * STEP_NM / 6


def load_tables() -> tuple[FloatArray, FloatArray]:
    """CIE 1931 2-degree observer, shape (N, 3), and D65, shape (N,)."""
    shape = colour.SpectralShape(380, 780, STEP_NM)
    observer = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"].copy().align(shape)
    d65 = colour.SDS_ILLUMINANTS["D65"].copy().align(shape)
    return observer.values.round(12), d65.values.round(6)


def xyz_of_primaries(white: FloatArray) -> FloatArray:
    """Columns: XYZ of linear R, G and B of strength 1, such that they add up to the white."""
    xyz = np.column_stack([(x / y, 1, (1 - x - y) / y) for x, y in PRIMARIES_XY])
    return xyz * np.linalg.solve(xyz, white)


def solve_basis(weights: FloatArray, primaries: FloatArray) -> FloatArray:
    """Basis of Mallett and Yuksel 2019 (EGSR), equation 5: least squared slopes.

    A quadratic program by active sets: values that would be negative are held at 0 until their
    multiplier says that they want to leave.

    Args:
        weights: XYZ under D65 = weights @ basis, shape (3, N).
        primaries: Wanted XYZ, a column per primary, shape (3, 3).

    Returns:
        Basis, shape (3, N): non-negative, columns sum to 1.
    """
    n = weights.shape[1]
    slope = np.diff(np.eye(n), axis=0)
    hessian = np.kron(np.eye(3), slope.T @ slope)
    equal = [np.kron(np.ones(3), np.eye(n))]
    equal += [np.kron(np.eye(3)[k], weights) for k in range(2)]  # the third follows from the sum
    wanted = np.concatenate([np.ones(n), primaries[:, 0], primaries[:, 1]])
    held: set[int] = set()
    for _ in range(1000):
        rows = np.vstack([*equal, np.eye(3 * n)[sorted(held)]])
        m = len(rows)
        kkt = np.block([[hessian, rows.T], [rows, np.zeros((m, m))]])
        target = np.concatenate([np.zeros(3 * n), wanted, np.zeros(len(held))])
        solution = np.linalg.lstsq(kkt, target, rcond=1e-14)[0]
        values, multipliers = solution[: 3 * n], -solution[3 * n + len(wanted) :]
        if values.min() < -1e-10:
            held |= set(np.flatnonzero(values < -1e-10).tolist())
        elif len(held) and multipliers.min() < -1e-9:
            held.remove(sorted(held)[int(multipliers.argmin())])
        else:
            return np.where(values < 1e-12, 0, values).round(12).reshape(3, n)
    raise RuntimeError("the active set did not settle")


def quantiles(density: FloatArray) -> FloatArray:
    """Wavelengths in nm at which the CDF of a piecewise linear density is i / CELLS."""
    fine = np.linspace(380, 780, 400 * 64 + 1)
    values = np.interp(fine, NODES_NM, density)
    cdf = np.concatenate([[0], np.cumsum(values[:-1] + values[1:])])
    return np.interp(np.arange(CELLS + 1) / CELLS, cdf / cdf[-1], fine)


def noise(
    density: FloatArray,
    observer: FloatArray,
    lights: FloatArray,
    to_rgb: FloatArray,
    hero_share: float = 0.1,
) -> float:
    """Variance of linear R + G + B of one path, summed over the lights.

    Args:
        density: At the nodes, shape (N,).
        observer: Colour matching, shape (N, 3).
        lights: Spectra of luminance about 1, shape (L, N).
        to_rgb: Matrix from XYZ, shape (3, 3).
        hero_share: Weight of the variance with the hero alone (paths through dispersive glass).

    Returns:
        Sum over lights and R, G, B of the variance with four rotated wavelengths, and with the
        hero alone.
    """
    nm = quantiles(density)
    middle, width = (nm[1:] + nm[:-1]) / 2, np.diff(nm) * CELLS
    total = 0.0
    for light in lights:
        seen = np.column_stack([np.interp(middle, NODES_NM, o * light) for o in observer.T])
        rgb = (seen * width[:, None]) @ to_rgb.T
        four = rgb.reshape(4, CELLS // 4, 3).mean(axis=0)
        total += four.var(axis=0).sum() + hero_share * rgb.var(axis=0).sum()
    return total


def best_density(observer: FloatArray, lights: FloatArray, to_rgb: FloatArray) -> FloatArray:
    """Density with the least noise: free at knots 20 nm apart, at least 2 % of its mean.

    Four wavelengths per path: x + y + z with a floor leaves 2.6 times the standard deviation of
    white, a flat density 4.6 times.
    """
    knots = NODES_NM[::4]

    def density(p: FloatArray) -> FloatArray:
        return np.interp(NODES_NM, knots, 0.02 + np.exp(p) / np.exp(p).mean())

    start = np.log(observer[::4].sum(axis=1) + 0.1)
    best = minimize(
        lambda p: noise(density(p), observer, lights, to_rgb),
        start,
        method="L-BFGS-B",
        options={"maxiter": 100},
    )
    flat = np.ones(len(observer))
    for name, d in [("flat", flat), ("x + y + z", density(start)), ("best", density(best.x))]:
        everything = noise(d, observer, lights, to_rgb)
        white = noise(d, observer, lights[:1], to_rgb, hero_share=0) ** 0.5
        print(f"{name}: noise {everything:.3f}, standard deviation of white {white:.3f}")
    return density(best.x)


def cpp_array(name: str, values: FloatArray, comment: str) -> str:
    """One constexpr array of doubles, 90 columns wide."""
    lines, line = [], "   "
    for v in values:
        text = f" {float(v)!r},"
        if len(line) + len(text) > 88:
            lines.append(line)
            line = "   "
        line += text
    body = "\n".join([*lines, line])
    return f"// {comment}\nconstexpr double {name}[{len(values)}] = {{\n{body}\n}};\n"


def main() -> None:
    """Writes tables.inc beside this file."""
    observer, d65 = load_tables()
    weights = np.stack([triple_weights(o, d65) for o in observer.T])
    scale = 1 / weights[1].sum()
    weights *= scale
    white = weights.sum(axis=1)
    primaries = xyz_of_primaries(white)
    basis = solve_basis(weights, primaries)
    error = np.abs(weights @ basis.T - primaries).max()
    print("white", white, "basis error", error, "sum error", np.abs(basis.sum(axis=0) - 1).max())
    if error > 1e-9:
        raise RuntimeError(f"the basis misses its primaries by {error}")
    lights = np.stack([d65, *(d65 * b for b in basis)]) * scale
    density = best_density(observer, lights, np.linalg.inv(primaries))
    parts = [
        "// tables.inc -- written by make_tables.py; do not edit. Nodes: 380, 385, ... 780 nm.\n",
        cpp_array("kCieX", observer[:, 0], "CIE 1931 2-degree observer (CIE 018:2019, table 6)."),
        cpp_array("kCieY", observer[:, 1], "y."),
        cpp_array("kCieZ", observer[:, 2], "z."),
        cpp_array("kD65", d65, "CIE standard illuminant D65 (ISO 11664-2:2022)."),
        cpp_array("kRed", basis[0], "Basis for linear Rec.709 under D65; blue = 1 - red - green."),
        cpp_array("kGreen", basis[1], "Green."),
        cpp_array(
            "kQuantileNm",
            np.round(quantiles(density), 4),
            f"Wavelength below which i / {CELLS} of the samples lie.",
        ),
    ]
    Path(__file__).with_name("tables.inc").write_text("\n".join(parts), encoding="utf-8")


if __name__ == "__main__":
    main()
