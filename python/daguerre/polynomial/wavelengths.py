"""Wavelengths of expansions, and refractive indices at them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

import daguerre._core as _core
from daguerre.checks import doubles, number, whole
from daguerre.errors import UsageError
from daguerre.lenses.lens import DESIGN_WAVELENGTH_NM


class HasIndex(Protocol):
    """Interface of a glass, such as ``dg.lenses.glasses.find("N-BK7")``."""

    def index(self, wavelength_nm: object, /) -> Any:
        """Returns the index relative to air at wavelengths, nm."""


#: Refractive index: a number, a number for each wavelength, or a glass.
Index = float | Sequence[float] | HasIndex


def wavelength_nodes(from_nm: float, to_nm: float, count: int) -> NDArray[np.float64]:
    """Returns nodes for polynomial interpolation in 1/wavelength^2.

    Args:
        from_nm: Shortest wavelength, nm.
        to_nm: Longest wavelength, nm.
        count: Number of nodes, at least 2; with 4 most lenses are within a micrometre.

    Returns:
        Chebyshev nodes with both ends, nm, shape (count,).
    """
    count = whole(count, "wavelength nodes", 2, 64, "2 to 64")
    low, high = number(from_nm, "wavelength nodes", above=0), number(to_nm, "wavelength nodes")
    if not low < high:
        raise UsageError(
            f"wavelength nodes: wanted 0 < from_nm < to_nm, got {from_nm!r} to {to_nm!r}"
        )
    return np.asarray(_core.wavelength_nodes(low, high, count), np.float64)


def nodes_of(wavelength: ArrayLike | None) -> list[float]:
    """Returns wavelengths as a list; None: an empty list.

    Raises:
        UsageError: They do not ascend, or are not wavelengths.
    """
    if wavelength is None:
        return []
    nm = np.atleast_1d(doubles(wavelength, "polynomial system", "wavelength", "nm"))
    if (
        nm.ndim != 1
        or not nm.size
        or not (np.isfinite(nm) & (nm > 0)).all()
        or (np.diff(nm) <= 0).any()
    ):
        raise UsageError(
            f"wavelength: wanted one above 0 nm, or several that ascend, got {wavelength!r}"
        )
    return [float(x) for x in nm]


def with_glass(nm: list[float], *indices: Index) -> list[float]:
    """Returns the nodes; without nodes and with a glass, the helium d line."""
    return nm or (
        [DESIGN_WAVELENGTH_NM]
        if any(hasattr(n, "index") and not isinstance(n, (Sequence, np.ndarray)) for n in indices)
        else []
    )


def index_at(n: Index, nm: list[float]) -> list[float]:
    """Returns the index at each node, or a single index for all.

    Raises:
        UsageError: The numbers of indices and wavelengths differ.
    """
    if hasattr(n, "index") and not isinstance(n, (Sequence, np.ndarray)):
        return [float(n.index(x)) for x in nm]
    wanted = "a glass, a number, or one for each wavelength"
    numbers = np.atleast_1d(doubles(n, "polynomial element", "refractive index", wanted))
    if numbers.ndim != 1 or len(numbers) not in (1, max(1, len(nm))):
        raise UsageError(
            f"refractive index: wanted a glass, a number, or one for each of {len(nm)} "
            f"wavelengths, got {n!r}"
        )
    return [float(x) for x in numbers]
