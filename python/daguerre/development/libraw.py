"""Reads raw files with LibRaw, in a helper process: their bytes come from strangers.

:func:`read` asks, :func:`answer` runs in the helper. Our own mosaics, which LibRaw demosaics too
(:mod:`daguerre.development.channels`), stay in this process.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import asdict, dataclass, fields, replace
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from daguerre.apart.helper import Helper
from daguerre.apart.limits import Limits
from daguerre.errors import InputError
from daguerre.files import extras
from daguerre.files.reading import size_of
from daguerre.files.value import BriefRecord

from .channels import USUAL, Demosaic
from .dng import LEAST_XTRANS

#: Colours of photosites that are looked at for the pattern, each way.
PERIOD = 12
#: Largest picture, photosites: four times as many as the largest sensors on sale.
MAX_PIXELS = 1 << 29
#: Limits of a task: seconds and bytes for any file, and for each photosite.
_SECONDS, _SECONDS_EACH = 30.0, 4e-6
_MEMORY, _MEMORY_EACH = 800 << 20, 64

Wants = Literal["values", "mosaic", "picture"]
_TASK = f"{__name__}:answer"
_helper = Helper()


@dataclass(frozen=True, repr=False)
class RawFile(BriefRecord):
    """A raw file as LibRaw reads it.

    Attributes:
        colors: Number of colours.
        letters: Letter of each colour index.
        flat: Whether there is one value per photosite.
        pattern: Side of the pattern of colours; 0: none.
        flip: LibRaw's turn: 0, 3 (half), 5 (quarter left) or 6 (quarter right).
        size: Height and width of the visible part, px.
        least: Shorter side of the whole sensor, px.
        black: Black level of each colour index, DN.
        white: White level, DN.
        balances: White balance as shot and in daylight, factors of red, green and blue.
        xyz_matrix: Matrix from XYZ to the camera's colours, shape (3, 3); zeros: unknown.
        facts: Facts of the shot, numbers and texts by EXIF's names.
        cells: Colour index of the first photosites, shape (12, 12) or less.
        mosaic: Values of the visible part, shape (H, W); None: not wanted.
        pixels: Demosaiced, balanced values, shape (H, W, 3 or 1), upright; None: not wanted.
    """

    colors: int
    letters: str
    flat: bool
    pattern: int
    flip: int
    size: tuple[int, int]
    least: int
    black: tuple[float, ...]
    white: float
    balances: tuple[tuple[float, ...], tuple[float, ...]]
    xyz_matrix: NDArray[np.float64]
    facts: dict[str, Any]
    cells: NDArray[np.uint8]
    mosaic: NDArray[np.uint16] | None = None
    pixels: NDArray[np.uint16] | None = None


def read(
    path: str | os.PathLike[str], wants: Wants = "values", demosaic: Demosaic = USUAL
) -> RawFile:
    """Reads a raw file.

    Args:
        path: The file.
        wants: Its values alone, its mosaic too, or the demosaiced picture.
        demosaic: Demosaicing; for X-Trans below 516 px LibRaw has only the fast method.

    Raises:
        InputError: It is no raw file, is too large, or LibRaw crashed, looped or took too much.
        UsageError: The package rawpy is not installed.
    """
    where = os.fspath(path)
    size_of(Path(path))
    extras.need("rawpy", f"{where}: a raw file")
    request = {"path": os.path.abspath(where), "where": where, "wants": wants}  # noqa: PTH100
    found = _helper.ask(
        _TASK,
        request | {"demosaic": asdict(demosaic)},
        Limits(_SECONDS, _MEMORY),
        where=where,
        heard=_limits,
    )
    return _checked(found, where)


def _limits(told: str) -> Limits:
    """Limits by the number of photosites, which the helper tells."""
    count = min(int(told) if told.isdecimal() else 0, MAX_PIXELS)
    return Limits(_SECONDS + _SECONDS_EACH * count, _MEMORY + _MEMORY_EACH * count)


def _checked(found: Any, where: str) -> RawFile:
    """Checks the answer: a file that overran a buffer of the helper could have changed it."""
    fault = InputError(f"{where}: cannot read: the helper process sent no raw file")
    try:
        file = RawFile(**found)
        arrays = (
            (file.xyz_matrix, np.float64, 2), (file.cells, np.uint8, 2),
            (file.mosaic, np.uint16, 2), (file.pixels, np.uint16, 3),
        )  # fmt: skip
        for array, dtype, sides in arrays:
            if array is not None and (
                array.dtype != dtype or array.ndim != sides or not array.size
            ):
                raise fault
        return replace(file, black=tuple(map(float, file.black)), white=float(file.white))
    except (TypeError, ValueError, AttributeError):
        raise fault from None


def answer(request: dict[str, Any], tell: Callable[[str], None]) -> dict[str, Any]:
    """Reads a raw file, in the helper; see :func:`read`."""
    import rawpy

    path, where = request["path"], request["where"]
    try:
        with rawpy.imread(path) as opened:
            sizes = opened.sizes
            count = max(sizes.raw_width * sizes.raw_height, sizes.width * sizes.height)
            if count > MAX_PIXELS:
                raise InputError(
                    f"{where}: wanted at most {MAX_PIXELS} photosites, got "
                    f"{sizes.raw_width}x{sizes.raw_height}"
                )
            tell(str(count))
            file = _values(opened)
            if request["wants"] == "mosaic" and file.flat:
                file = replace(file, mosaic=np.array(opened.raw_image_visible, np.uint16))
            if request["wants"] == "picture":
                file = replace(file, pixels=_picture(opened, file, request))
            return {one.name: getattr(file, one.name) for one in fields(file)}
    except rawpy.LibRawError as error:
        reason = error.args[0] if error.args else error
        reason = reason.decode() if isinstance(reason, bytes) else str(reason)
        raise InputError(
            f"{where}: wanted a camera raw file; LibRaw cannot read this one: {reason}"
        ) from None


def _values(opened: Any) -> RawFile:
    """Values of an opened file, in the helper."""
    import rawpy

    flat = bool(opened.raw_type == rawpy.RawType.Flat and opened.raw_image is not None)
    pattern = opened.raw_pattern if flat else None
    visible = opened.raw_image_visible.shape if flat else (opened.sizes.height, opened.sizes.width)
    cells = opened.raw_colors_visible[:PERIOD, :PERIOD] if flat else np.zeros((1, 1))
    other, lens = getattr(opened, "other", None), getattr(opened, "lens", None)
    facts = {
        "PhotographicSensitivity": getattr(other, "iso_speed", None),
        "ExposureTime": getattr(other, "shutter_speed", None),
        "FNumber": getattr(other, "aperture", None),
        "FocalLength": getattr(other, "focal_length", None),
        "LensModel": getattr(lens, "model", None),
        "LensMake": getattr(lens, "make", None),
    }
    return RawFile(
        colors=int(opened.num_colors),
        letters=opened.color_desc.decode("ascii", "replace"),
        flat=flat,
        pattern=0 if pattern is None else len(pattern),
        flip=int(opened.sizes.flip),
        size=(int(visible[0]), int(visible[1])),
        least=int(min(opened.raw_image.shape)) if flat else 0,
        black=tuple(float(level) for level in opened.black_level_per_channel),
        white=float(opened.white_level),
        balances=(_three(opened.camera_whitebalance), _three(opened.daylight_whitebalance)),
        xyz_matrix=np.array(opened.rgb_xyz_matrix, np.float64)[:3],
        facts=facts,
        cells=np.array(cells, np.uint8),
    )


def _three(factors: Any) -> tuple[float, ...]:
    return tuple(float(factor) for factor in factors[:3])


def _picture(opened: object, file: RawFile, request: dict[str, Any]) -> NDArray[np.uint16]:
    """Demosaics an opened file, in the helper."""
    check_colors(file, request["where"])
    demosaic = Demosaic(**request["demosaic"])
    xtrans = file.colors != 1 and file.pattern == 6
    if xtrans and file.least < LEAST_XTRANS:
        demosaic = replace(demosaic, method="fast")
    balance = balance_of(file, request["where"])
    pixels = demosaic.run(opened, balance, xtrans, turn=True)
    return np.ascontiguousarray(pixels.reshape(*pixels.shape[:2], -1))


def check_colors(file: RawFile, where: object) -> None:
    """Checks that a file has a mosaic of red, green and blue, or grey alone.

    Raises:
        InputError: It has not.
    """
    if file.flat and (file.colors == 1 or (file.colors == 3 and file.pattern)):
        return
    mosaic = "in a mosaic" if file.flat and file.pattern else "without a mosaic"
    raise InputError(
        f"{where}: colours: wanted a mosaic of red, green and blue, or grey alone; got "
        f"{file.colors} colours {mosaic}"
    )


def balance_of(file: RawFile, where: object) -> NDArray[np.float64]:
    """Factors that balance the channels; see :func:`neutral_of`."""
    return np.asarray(1 / np.clip(neutral_of(file, where), 0.05, 1))


def neutral_of(file: RawFile, where: object) -> NDArray[np.float64]:
    """Values of white in the three channels, the largest 1; by the shot, else by daylight.

    Raises:
        InputError: The file has no factors of white balance.
    """
    if file.colors == 1:
        return np.ones(3)
    for balance in file.balances:
        factors = np.array(balance, np.float64)
        if factors.shape == (3,) and (factors > 0).all():
            return np.asarray(factors.min() / factors)
    raise InputError(f"{where}: white balance: wanted the camera's or daylight factors, got none")
