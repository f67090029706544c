"""Checks of users' arguments: one clear error that names argument, wanted and got."""

from __future__ import annotations

import math
import operator
import weakref
from collections.abc import Callable
from itertools import islice
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from .errors import DaguerreError, InputError, UsageError

#: Maximum side of a picture (px), maximum samples of a pixel, and default size of pictures.
MAX_RESOLUTION = 65536
DEFAULT_RESOLUTION = (960, 540)
MAX_SAMPLES = 1 << 31
#: Maximum number of elements in a user's array.
MAX_NUMBERS = 1 << 31
#: Deflate cannot shrink data more than this (zlib's "Technical details").
DEFLATE_LIMIT = 1032


def is_loopback(host: str) -> bool:
    """Whether an address is reached from this machine alone."""
    from ipaddress import ip_address  # not at every start of the program

    try:
        return host == "localhost" or ip_address(host).is_loopback
    except ValueError:
        return False


def array(values: ArrayLike, where: str, what: str, columns: int) -> NDArray[np.float32]:
    """Checks finite numbers of shape (N, columns); returns float32."""
    numbers = to_numbers(values, where, what, f"shape (N, {columns})")
    if numbers.ndim != 2 or numbers.shape[1] != columns:
        raise InputError(f"{where}: {what}: wanted shape (N, {columns}), got {numbers.shape}")
    with np.errstate(over="ignore"):
        single = as_readonly(numbers, np.float32)
    finite = np.isfinite(single)
    if not finite.all():
        bad = np.flatnonzero(~finite.all(axis=1))
        raise InputError(
            f"{where}: {what}[{bad[0]}]: wanted finite numbers, got {numbers[bad[0]].tolist()} "
            f"({bad.size} such elements)"
        )
    return single


def optional_array(
    values: ArrayLike | None, where: str, what: str, columns: int, count: int
) -> NDArray[np.float32] | None:
    """Checks like :func:`array`, and the number of rows; None stays None."""
    if values is None:
        return None
    numbers = array(values, where, what, columns)
    if len(numbers) != count:
        raise InputError(f"{where}: {what}: wanted {count} elements, got {len(numbers)}")
    return numbers


def to_numbers(
    values: object, where: str, what: str, wanted: str, error: type[DaguerreError] = InputError
) -> NDArray[Any]:
    """Converts to a numeric array; the error names the type of other values."""
    try:
        numbers = np.asarray(values)
    except ValueError:
        raise error(f"{where}: {what}: wanted {wanted}, got rows of unequal length") from None
    if numbers.size > MAX_NUMBERS:  # a view of few numbers may pretend to be far more
        raise error(f"{where}: {what}: wanted {wanted}, got {numbers.size} numbers")
    if numbers.dtype.kind not in "iufb":
        raise error(f"{where}: {what}: wanted {wanted}, got {short(values)}")
    return numbers


def integers(values: object, where: str, what: str, below: int) -> NDArray[np.int64]:
    """Checks whole numbers in 0 .. below - 1; returns int64 of the same shape.

    Raises:
        InputError: Others.
    """
    found = to_numbers(values, where, what, "integers")
    if found.size == 0:
        return np.zeros(found.shape, np.int64)
    if found.dtype.kind not in "iu":
        raise InputError(f"{where}: {what}: wanted integers, got {found.dtype}")
    low, high = int(found.min()), int(found.max())
    if low < 0 or high >= below:
        raise InputError(f"{where}: {what}: wanted 0 .. {below - 1}, got {low} .. {high}")
    return found.astype(np.int64)


def doubles(values: object, where: str, what: str, wanted: str) -> NDArray[np.float64]:
    """Converts a parameter to a contiguous array of doubles of any shape, for the core."""
    numbers = to_numbers(values, where, what, wanted, UsageError)
    return np.asarray(numbers, np.float64, order="C")


def wavelengths(values: ArrayLike, where: str) -> NDArray[np.float64]:
    """Checks wavelengths for glass, nm, of any shape."""
    found = doubles(values, where, "values", "wavelengths in nm")
    if found.size and not (found.min() >= 1 and found.max() <= 1e6):
        raise UsageError(f"{where}: wanted wavelengths of 1 to 1e6 nm, got {short(found.tolist())}")
    return found


def rows(values: ArrayLike, where: str, columns: int) -> NDArray[np.float64]:
    """Checks points or rays of an analysis, shape (N, columns); a single one becomes a row."""
    numbers = doubles(values, where, "values", f"shape (N, {columns})")
    if numbers.ndim not in (1, 2) or numbers.shape[-1] != columns:
        raise UsageError(f"{where}: wanted shape (N, {columns}), got {numbers.shape}")
    return numbers.reshape(-1, columns)


def line(values: ArrayLike, where: str) -> NDArray[np.float64]:
    """Checks numbers, shape (N,); a single one becomes a row of one."""
    numbers = np.atleast_1d(doubles(values, where, "values", "shape (N,)"))
    if numbers.ndim != 1:
        raise UsageError(f"{where}: wanted shape (N,), got {numbers.shape}")
    return numbers


class SealedBytes:
    """Mapped bytes that nobody can change; ``numpy.asarray`` makes an array of them.

    Args:
        address: Their place.
        size: Their number.
        unmap: Called once no array needs them.
    """

    def __init__(self, address: int, size: int, unmap: Callable[[], object]) -> None:
        self.__array_interface__ = {
            **{"version": 3, "typestr": "|u1", "shape": (size,)},
            "data": (address, True),  # read-only
        }
        weakref.finalize(self, unmap).atexit = False  # arrays may still be in use then


def as_readonly(values: NDArray[Any], dtype: DTypeLike | None = None) -> NDArray[Any]:
    """Returns the array if it cannot change, else a read-only copy, as the core reads in place."""
    base: Any = values
    while isinstance(base, np.ndarray) and not base.flags.writeable:
        base = base.base
    in_order = values.flags.c_contiguous and values.flags.aligned
    if isinstance(base, bytes | SealedBytes):  # bytes: as of an array that was pickled
        base = None
    if base is None and in_order and values.dtype == (values.dtype if dtype is None else dtype):
        return values
    copy = np.array(values, dtype, order="C")
    copy.flags.writeable = False
    return copy


def freeze_in_place(values: NDArray[Any]) -> NDArray[Any]:
    """Makes the array read-only, so that :func:`as_readonly` need not copy it."""
    base: Any = values
    while isinstance(base, np.ndarray):
        base.flags.writeable = False
        base = base.base
    return values


def matrix(transform: object, where: str) -> NDArray[np.float64]:
    """Checks a finite transform (4, 4); None is the identity."""
    return np.eye(4) if transform is None else given_matrix(transform, where)


def given_matrix(transform: object, where: str) -> NDArray[np.float64]:
    """Checks a finite transform (4, 4)."""
    numbers = to_numbers(transform, where, "transform", "shape (4, 4)").astype(np.float64)
    if numbers.shape != (4, 4):
        raise InputError(f"{where}: transform: wanted shape (4, 4), got {numbers.shape}")
    if not np.isfinite(numbers).all():
        raise InputError(f"{where}: transform: wanted finite numbers, got {numbers.tolist()}")
    return numbers


def color(
    value: Any, where: str, error: type[DaguerreError] = InputError
) -> tuple[float, float, float]:
    """Checks three finite numbers of at least 0."""
    try:
        r, g, b = (float(v) for v in value)
    except (TypeError, ValueError):
        raise error(f"{where}: wanted three numbers, got {short(value)}") from None
    if not all(0 <= v < math.inf for v in (r, g, b)):
        raise error(f"{where}: wanted three finite numbers of at least 0, got {short(value)}")
    return r, g, b


def number(
    value: Any,
    where: str,
    low: float = -math.inf,
    high: float = math.inf,
    *,
    above: float | None = None,
    infinite: bool = False,
    error: type[DaguerreError] = UsageError,
) -> float:
    """Checks a number in [low, high], or above ``above``; infinite only if that is allowed."""
    wanted = "a number" if low == -math.inf else f"a number of at least {low:g}"
    if above is not None:
        wanted = f"a number above {above:g}"
    if high < math.inf:
        wanted += f" and at most {high:g}"
    if isinstance(value, str | bytes | bool):
        raise error(f"{where}: wanted {wanted}, got {short(value)}")
    try:
        result = float(value)
    except (TypeError, ValueError, OverflowError):
        raise error(f"{where}: wanted {wanted}, got {short(value)}") from None
    fits = result >= low if above is None else result > above
    if math.isinf(result) and infinite:
        fits = result > 0
    elif not math.isfinite(result) or result > high:
        fits = False
    if not fits:
        raise error(f"{where}: wanted {wanted}, got {value}")
    return result


def numbers(value: Any, where: str, count: int, wanted: str) -> tuple[float, ...]:
    """Checks ``count`` finite numbers."""
    try:
        result = tuple(float(v) for v in islice(value, count + 1))
    except (TypeError, ValueError, OverflowError):
        raise UsageError(f"{where}: wanted {wanted}, got {short(value)}") from None
    if len(result) != count or not all(math.isfinite(v) for v in result):
        raise UsageError(f"{where}: wanted {wanted}, got {short(value)}")
    return result


def whole(value: Any, where: str, low: int, high: int, bounds: str | None = None) -> int:
    """Checks an integer of any type in [low, high]."""
    wanted = bounds or f"{low} .. {high}"
    try:
        result = operator.index(value)
    except TypeError:
        raise UsageError(f"{where}: wanted a whole number, {wanted}, got {short(value)}") from None
    if not low <= result <= high:
        raise UsageError(f"{where}: wanted {wanted}, got {result}")
    return result


def short(value: object, length: int = 60) -> str:
    """Formats a value as text that fits into a message."""
    try:
        text = " ".join(repr(value).split())
    except (ValueError, RecursionError):  # whole numbers of thousands of digits
        text = type(value).__name__
    return text if len(text) <= length else text[: length - 3] + "..."


def shown(value: object) -> str:
    """Formats any value for a message: plain values as they are, others by their type."""
    if isinstance(value, np.ndarray):
        return f"an array {value.shape} of {value.dtype}"
    if isinstance(value, type):
        return f"the class {value.__name__}"
    plain = value is None or isinstance(
        value, bool | int | float | complex | str | bytes | tuple | list | dict | np.generic
    )
    return short(value) if plain else f"a {type(value).__name__}"


def plain_light(pixels: NDArray[Any], where: str, *, infinite: bool = False) -> None:
    """Refuses pictures with NaN, and with infinite light unless allowed.

    Args:
        pixels: Shape (H, W, C).
        where: For messages.
        infinite: Whether infinite light is allowed.

    Raises:
        InputError: The picture has such pixels; the message names the first, (x, y).
    """
    if pixels.size == 0 or math.isfinite(pixels.min() + (0 if infinite else pixels.max())):
        return
    bad = (np.isnan(pixels) if infinite else ~np.isfinite(pixels)).any(axis=2)
    places = np.argwhere(bad)
    if not len(places):
        return
    y, x = (int(i) for i in places[0])
    raise InputError(
        f"{where}: wanted finite numbers, got NaN or infinity in {len(places)} pixels, the "
        f"first at "
        f"({x}, {y})"
    )
