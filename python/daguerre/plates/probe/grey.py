"""Matt balls: finds the light that explains the shading of the visible half.

Soft light is fitted to order 2 of spherical harmonics and kept non-negative. A sun shows by its
terminator: its shading is a clamped cosine, which order 2 cannot reproduce.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daguerre.color.spectra import luminance_of_rgb
from daguerre.errors import InputError

from .ball import Ball
from .harmonics import IRRADIANCE, basis, scattered
from .latlong import FloatArray
from .merge import Merged

#: Least cosine between normal and view; steeper parts mirror and are blurred.
_LEAST_COSINE = 0.25
_MOST_NORMALS = 6000
#: Least share of the residual of soft light that a sun must explain, and of the mean light.
_EXPLAINS, _BRINGS = 0.1, 0.05
#: Weight of the regularization toward little light where the ball does not show it.
_CALM = 1e-3


@dataclass(frozen=True)
class Shading:
    """Irradiance of a matt ball by its normals, in the world.

    Attributes:
        normals: Unit vectors, shape (N, 3).
        irradiance: RGB, lux where the photograph is in cd/m2, shape (N, 3).
    """

    normals: FloatArray
    irradiance: FloatArray


@dataclass(frozen=True)
class Lighting:
    """Light that explains a matt ball.

    Attributes:
        coefficients: Soft light: coefficients of nine functions by RGB, shape (9, 3).
        direction: Unit vector toward the sun, shape (3,); None: no sun.
        sun: Illuminance of the sun, RGB, shape (3,).
        error: RMS of the residual, as a share of the mean.
    """

    coefficients: FloatArray
    direction: FloatArray | None
    sun: FloatArray
    error: float


def shading_of(
    merged: Merged, ball: Ball, world_from_camera: FloatArray, reflectance: FloatArray
) -> Shading:
    """Irradiance on the visible part of a matt ball: E = pi L / reflectance.

    Raises:
        InputError: Too little of the ball is not clipped.
    """
    x, y, radius = ball.circle
    step = max(1, int(radius / np.sqrt(_MOST_NORMALS / np.pi)))
    height, width = merged.clipped.shape
    columns = np.arange(max(int(x - radius), 0), min(int(x + radius) + 1, width), step)
    rows = np.arange(max(int(y - radius), 0), min(int(y + radius) + 1, height), step)
    at = np.stack(np.meshgrid(columns, rows), axis=-1).reshape(-1, 2)
    normals, facing = ball.normals(at + 0.5)
    used = (np.nan_to_num(facing, nan=-1) > _LEAST_COSINE) & ~merged.clipped[at[:, 1], at[:, 0]]
    if used.sum() < 200:
        raise InputError(
            f"grey ball: wanted at least 200 px that are not clipped, got {int(used.sum())}"
        )
    light = _blocks(merged.light, at[used], step)
    return Shading(normals[used] @ world_from_camera.T, np.pi * light / reflectance)


def _blocks(light: NDArray[np.float32], at: NDArray[np.int64], step: int) -> FloatArray:
    """Means of step x step px around places, so that all pixels reduce noise."""
    if step < 3:
        return light[at[:, 1], at[:, 0]].astype(np.float64)
    height, width = light.shape[:2]
    reach = (step - 1) // 2
    total = np.zeros((len(at), 3))
    for dy in range(-reach, reach + 1):
        for dx in range(-reach, reach + 1):
            row, column = at[:, 1] + dy, at[:, 0] + dx
            total += light[np.clip(row, 0, height - 1), np.clip(column, 0, width - 1)]
    return total / (2 * reach + 1) ** 2


def lighting_of(shading: Shading) -> Lighting:
    """Fits soft light and a sun to a matt ball, by least squares."""
    soft = basis(shading.normals) * IRRADIANCE
    target = shading.irradiance
    luma = target @ luminance_of_rgb()
    direction = _sun_direction(soft, shading.normals, luma)
    if direction is None:
        found = _positive(soft, target)
        return Lighting(found, None, np.zeros(3), _rms(soft @ found - target, target))
    column = np.maximum(shading.normals @ direction, 0)[:, None]
    found = _positive(np.hstack([soft, column]), target)
    error = _rms(np.hstack([soft, column]) @ found - target, target)
    return Lighting(found[:9], direction, np.maximum(found[9], 0), error)


def _rms(off: FloatArray, target: FloatArray) -> float:
    return float(np.sqrt((off**2).mean()) / target.mean())


def _sun_direction(soft: FloatArray, normals: FloatArray, luma: FloatArray) -> FloatArray | None:
    """Direction with the clamped cosine that explains most of the residual of soft light."""
    q = np.linalg.qr(soft)[0]
    left = luma - q @ (q.T @ luma)
    tried, spread = scattered(2000), 0.08
    best, gain = tried[0], 0.0
    for _ in range(7):
        gains = _gains(tried, normals, q, left)
        if gains.max() > gain:
            best, gain = tried[int(gains.argmax())], float(gains.max())
        tried = _about(best, spread)
        spread /= 3
    amount = _amount(best, normals, q, left)
    explains = gain / max(float(left @ left), 1e-300)
    if explains < _EXPLAINS or amount < _BRINGS * luma.mean():
        return None
    # max(x, 0) = (|x| + x) / 2: suns on opposite sides differ by soft light of order 1 alone,
    # which would have to be negative to make the wrong one fit.
    sides = [(_error_with(side, soft, normals, luma), i) for i, side in enumerate((best, -best))]
    return np.asarray(best if min(sides)[1] == 0 else -best)


def _error_with(
    direction: FloatArray, soft: FloatArray, normals: FloatArray, luma: FloatArray
) -> float:
    """Mean square residual of a sun and non-negative soft light."""
    columns = np.hstack([soft, np.maximum(normals @ direction, 0)[:, None]])
    found = _positive(columns, luma[:, None])
    return float(((columns @ found - luma[:, None]) ** 2).mean())


def _gains(tried: FloatArray, normals: FloatArray, q: FloatArray, left: FloatArray) -> FloatArray:
    """Sum of squares explained by a sun in each direction; 0 where it would be negative."""
    found = np.zeros(len(tried))
    for start in range(0, len(tried), 200):
        part = slice(start, start + 200)
        columns = np.maximum(normals @ tried[part].T, 0)
        columns -= q @ (q.T @ columns)
        along, size = left @ columns, (columns**2).sum(axis=0)
        useful = (along > 0) & (size > 1e-9 * len(normals))
        found[part] = np.where(useful, along**2 / np.maximum(size, 1e-300), 0)
    return found


def _amount(direction: FloatArray, normals: FloatArray, q: FloatArray, left: FloatArray) -> float:
    column = np.maximum(normals @ direction, 0)
    column -= q @ (q.T @ column)
    return float(left @ column / max(float(column @ column), 1e-300))


def _about(direction: FloatArray, spread: float) -> FloatArray:
    """Directions within an angle (rad) of a direction, shape (N, 3)."""
    side = np.cross(direction, np.eye(3)[int(np.abs(direction).argmin())])
    side /= np.linalg.norm(side)
    other = np.cross(direction, side)
    a, b = np.meshgrid(*[np.linspace(-spread, spread, 15)] * 2)
    found = direction + a.reshape(-1, 1) * side + b.reshape(-1, 1) * other
    return np.asarray(found / np.linalg.norm(found, axis=1)[:, None])


def _positive(columns: FloatArray, target: FloatArray) -> FloatArray:
    """Least squares with soft light that is non-negative in 500 directions.

    Where it is negative, an equation requires 0, with more weight each round.
    """
    everywhere = basis(scattered(500))
    extra = columns.shape[1] - everywhere.shape[1]
    everywhere = np.hstack([everywhere, np.zeros((len(everywhere), extra))])
    size = np.sqrt((columns**2).sum(axis=0).max())
    calm = np.diag([0.0] + [_CALM * size] * 8 + [0.0] * extra)
    found = np.zeros((columns.shape[1], target.shape[1]))
    for c in range(target.shape[1]):
        firm = np.zeros(len(everywhere))
        for _ in range(12):
            rows = np.vstack([columns, calm, firm[:, None] * everywhere])
            right = np.concatenate([target[:, c], np.zeros(len(calm) + len(everywhere))])
            found[:, c] = np.linalg.lstsq(rows, right, rcond=None)[0]
            below = everywhere @ found[:, c] < -1e-6 * abs(found[0, c])
            if not below.any():
                break
            firm = np.where(below, np.maximum(2 * firm, 0.02 * size), firm)
    return found
