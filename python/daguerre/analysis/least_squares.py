"""Nonlinear least squares for a few unknowns.

Source: Nocedal and Wright, Numerical Optimization, 2nd ed., section 10.3 (Levenberg-Marquardt).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .bench import FloatArray

STEP = 1e-6  # step of finite differences, for scaled unknowns
STEPS = 200  # most iterations
STILL = 1e-15  # relative change of the sum of squares that ends the search
STUCK = 1e12  # damping that ends the search: no step improves the fit


def least_squares(
    misses: Callable[[FloatArray], FloatArray], start: FloatArray, scale: FloatArray
) -> FloatArray:
    """Finds the unknowns with the smallest sum of squares near a start.

    Args:
        misses: Residuals for unknowns, shape (N,); NaN outside their domain, where no step is
            taken.
        start: First guess of the unknowns, shape (K,), with finite residuals.
        scale: Steps of the unknowns with comparable effect, shape (K,).
    """
    at, damping = np.array(start, np.float64), 1e-3
    found = misses(at)
    for _ in range(STEPS):
        slopes = _slopes(misses, at, scale, found)
        square, down = slopes.T @ slopes, slopes.T @ found
        before = float(found @ found)
        while damping < STUCK:
            damped = square + damping * np.diag(np.maximum(np.diag(square), 1e-300))
            step = -np.linalg.lstsq(damped, down, rcond=None)[0] * scale
            there = misses(at + step)
            if float(there @ there) < before:  # false for NaN, too
                at, found, damping = at + step, there, max(damping / 10, 1e-12)
                break
            damping *= 10
        if damping >= STUCK or before - float(found @ found) <= STILL * before:
            break
    return at


def _slopes(
    misses: Callable[[FloatArray], FloatArray],
    at: FloatArray,
    scale: FloatArray,
    here: FloatArray,
) -> FloatArray:
    """Derivatives by scaled unknowns, shape (N, K); one-sided at the edge of the domain."""
    out = np.empty((len(here), len(at)))
    for k, size in enumerate(scale):
        delta = np.zeros(len(at))
        delta[k] = STEP * size
        up, down = misses(at + delta), misses(at - delta)
        slope = (up - down) / (2 * STEP)
        if not np.isfinite(slope).all():
            slope = np.where(np.isfinite(up).all(), up - here, here - down) / STEP
        out[:, k] = slope
    return np.asarray(np.nan_to_num(out))
