"""Limits of coordinates and transforms: the same for arrays and for every reader.

The core checks values over time against the same limits (``core/math/vec.h``, ``transform.h``).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import InputError

Matrix = NDArray[np.float64]
#: Limit of coordinates and of the numbers of transforms, m: squares of longer ones overflow a
#: float.
MAX_SIZE = 1e18
#: A transform has an inverse in single precision if it turns a cube into a box of more than this
#: share of the volume that edges of the same lengths would have at right angles.
MIN_VOLUME = 1e-7
#: Least product of the lengths of the edges; lengths of 1e-20 count as a scale of 0.
MIN_EDGES = 1e-60
#: Transforms that are checked at once, which fit into a cache.
_BLOCK = 1 << 13


def largest(values: NDArray[Any]) -> float:
    """Largest magnitude among numbers: 0 if there are none, NaN if one of them is."""
    return max(float(values.max()), -float(values.min())) if values.size else 0.0


def check_coordinates(points: NDArray[Any], where: str, what: str = "positions") -> None:
    """Checks that coordinates are finite and below ``MAX_SIZE``.

    Args:
        points: Shape (N, columns), m.
        where: Owner, for messages.
        what: Name of the array, for messages.

    Raises:
        InputError: A coordinate is not; the message names its row.
    """
    if largest(points) < MAX_SIZE:  # NaN is not
        return
    bad = np.flatnonzero(~(np.abs(points) < MAX_SIZE).all(axis=1))
    raise InputError(
        f"{where}: {what}[{bad[0]}]: wanted numbers below {MAX_SIZE:g}, got "
        f"{points[bad[0]].tolist()} ({bad.size} such elements)"
    )


def check_size(values: NDArray[Any], where: str) -> float:
    """Checks numbers of any shape, such as a transform; returns the largest magnitude.

    Raises:
        InputError: A number is not finite, or at least ``MAX_SIZE``.
    """
    size = largest(values)
    if not size < MAX_SIZE:  # NaN is not
        raise InputError(f"{where}: wanted numbers below {MAX_SIZE:g}, got {size:g}")
    return size


def check_places(worlds: Matrix, extent: float, where: str) -> None:
    """Checks transforms that place a mesh: their numbers, its place in the world, their inverses.

    Args:
        worlds: World from local, shape (N, 4, 4).
        extent: Largest coordinate of the mesh, m.
        where: Owner of the transforms, for messages.

    Raises:
        InputError: One of them is wrong; the message names it.
    """
    size = check_size(worlds, where)
    if size * (3 * extent + 1) >= MAX_SIZE:
        _check_reach(worlds, extent, where)
    bad = np.flatnonzero(~invertible(worlds[:, :3, :3]))
    if bad.size:
        some = f" ({bad.size} of {len(worlds)}, the first at {bad[0]})" if len(worlds) > 1 else ""
        raise InputError(
            f"{where}: wanted an invertible matrix (no scale of 0, no shear beyond single "
            f"precision), got {worlds[bad[0], :3, :3].tolist()}{some}"
        )


def check_place(world: Matrix, extent: float, where: str) -> None:
    """Checks one transform (4, 4) of finite numbers like :func:`check_places`, in less time.

    Raises:
        InputError: It is wrong.
    """
    numbers = world.ravel().tolist()
    size = max(max(numbers), -min(numbers))
    near = size * (3 * extent + 1) < MAX_SIZE
    if near and _keeps_volume(numbers[:3] + numbers[4:7] + numbers[8:11]):
        return
    check_places(world[None], extent, where)


def _check_reach(worlds: Matrix, extent: float, where: str) -> None:
    reach = np.abs(worlds[:, :3, :3]).sum(axis=2) * extent + np.abs(worlds[:, :3, 3])
    if not float(reach.max()) < MAX_SIZE:
        raise InputError(
            f"{where}: wanted a mesh within {MAX_SIZE:g} m of the origin, got one that reaches "
            f"{float(reach.max()):g} m"
        )


def invertible(linear: Matrix) -> NDArray[np.bool_]:
    """Whether single precision can invert transforms: neither a scale of 0 nor too much shear.

    Args:
        linear: Linear parts, shape (N, 3, 3).

    Returns:
        Shape (N,).
    """
    found = np.empty(len(linear), bool)
    with np.errstate(all="ignore"):  # readers ask about any numbers
        for first in range(0, len(linear), _BLOCK):
            part = linear[first : first + _BLOCK].reshape(-1, 9)
            found[first : first + _BLOCK] = _keeps_volume(np.ascontiguousarray(part.T))
    return found


def _keeps_volume(rows: Any) -> Any:
    """The same for the nine numbers of a matrix, row by row: floats, or arrays of one shape."""
    xx, yx, zx, xy, yy, zy, xz, yz, zz = rows
    edges = (
        (xx * xx + xy * xy + xz * xz)
        * (yx * yx + yy * yy + yz * yz)
        * (zx * zx + zy * zy + zz * zz)
    ) ** 0.5
    volume = xx * (yy * zz - yz * zy) + xy * (yz * zx - yx * zz) + xz * (yx * zy - yy * zx)
    return (edges > MIN_EDGES) & (abs(volume) > MIN_VOLUME * edges)
