"""Decodes pictures: textures from bytes, environments from files.

:mod:`daguerre.io.pictures` reads them. OpenImageIO's Python wheel cannot read from memory, so bytes
pass through a temporary file.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.color import srgb
from daguerre.errors import InputError
from daguerre.files.json_item import short
from daguerre.files.reading import opened, size_of

from . import ktx2
from .pictures.kinds import KINDS
from .pictures.read import Picture, read
from .pictures.size import MAX_ENVIRONMENT_BYTES, check_size
from .pictures.source import Source

#: Largest colour channel of an environment: the sum of three still fits a float.
MAX_LIGHT = 1e38
#: Kinds of pictures that glTF has beside KTX2.
_OF_GLTF = ("png", "jpeg", "webp")


def decode(data: bytes | memoryview, where: str) -> NDArray[np.uint8] | NDArray[np.float32]:
    """Decodes a PNG, JPEG, WebP or KTX2 image; straight alpha, row 0 at the top.

    Args:
        data: Bytes of the file.
        where: File and JSON path, for messages.

    Returns:
        Shape (H, W, 1..4); uint8, or float32 in 0 .. 1 from 16-bit pictures, as 8 bits would show
        steps in normal maps.

    Raises:
        InputError: The format is another, or the image is truncated, corrupt or too large.
    """
    data = bytes(data)
    if data.startswith(ktx2.MAGIC):
        check_size(*ktx2.size(data, where), 4, 1, where)
        return ktx2.decode(data, where)
    if not is_of_gltf(data):
        raise InputError(f"{where}: wanted a PNG, JPEG, WebP or KTX2 image, got {short(data[:8])}")
    pixels = read(Source(data=data), where).pixels
    if pixels.shape[2] > 4:
        raise InputError(f"{where}: wanted 1 to 4 channels, got {pixels.shape[2]}")
    if pixels.dtype == np.uint8:
        return pixels
    if pixels.dtype == np.uint16:
        return pixels.astype(np.float32) / np.float32(65535)
    return pixels.astype(np.float32)


def is_of_gltf(start: bytes) -> bool:
    """Whether a file begins as a PNG, JPEG, WebP or KTX2."""
    return start.startswith(ktx2.MAGIC) or any(
        kind.matches(start) for kind in KINDS if kind.name in _OF_GLTF
    )


def read_environment(path: str | Path) -> NDArray[np.float32]:
    """Reads an equirectangular picture; .hdr and .exr are linear, integer formats sRGB.

    Args:
        path: The file.

    Returns:
        Linear RGB, float32, shape (H, W, 3), row 0 at the zenith.

    Raises:
        InputError: The file cannot be read, has no colour, or has NaN, Inf or negative light.
    """
    from .exr.reader import is_exr

    file = Path(path)
    size_of(file)
    if is_exr(file):
        return _checked_light(file, upright(*_linear(file)))
    picture = read(Source(file), str(file), MAX_ENVIRONMENT_BYTES)
    pixels = picture.pixels
    if np.issubdtype(pixels.dtype, np.integer):
        scale = np.float32(np.iinfo(pixels.dtype).max)
        rgb = srgb.to_linear(_rgb(picture, file).astype(np.float32) / scale)
    else:
        rgb = _rgb(picture, file).astype(np.float32)
    if picture.kind == "hdr":
        rgb /= np.float32(_radiance_exposure(file))
    return _checked_light(file, upright(rgb, picture.orientation))


def _checked_light(file: Path, rgb: NDArray[np.float32]) -> NDArray[np.float32]:
    """Checks that light is finite and not negative in all pixels."""
    for name, bad in (("finite", ~(np.abs(rgb) <= MAX_LIGHT)), ("non-negative", rgb < 0)):
        count = int(bad.any(axis=2).sum())
        if count:
            y, x = np.argwhere(bad.any(axis=2))[0]
            raise InputError(
                f"{file}: pixel ({x}, {y}): wanted {name} light, got {rgb[y, x].tolist()} "
                f"({count} such pixels)"
            )
    return np.ascontiguousarray(rgb)


def read_file(path: Path, *, floats: bool = False) -> NDArray[Any]:
    """Reads pixels in the type of the file, shape (H, W, C), not turned upright.

    Args:
        path: Picture of any kind of :mod:`daguerre.io.pictures`.
        floats: Return float32 instead: integers scaled to 0 .. 1, premultiplied by alpha.

    Returns:
        The pixels, with straight alpha unless ``floats``.

    Raises:
        InputError: The file cannot be decoded, is truncated or too large.
    """
    from .exr.reader import is_exr

    source = Source(path)
    if is_exr(path):
        raise InputError(f"{path}: OpenEXR is not supported here")
    return read(source, str(path), floats=floats).pixels


def _rgb(picture: Picture, file: Path) -> NDArray[Any]:
    """Selects the colour channels: R, G, B in any position, or one grey."""
    pixels = picture.pixels
    names = [name.rsplit(".", 1)[-1].upper() for name in picture.names]
    if all(name in names for name in "RGB"):
        return pixels[:, :, [names.index(name) for name in "RGB"]]
    if names[:1] in (["Y"], ["I"], ["L"]) or len(names) == 1:
        return np.repeat(pixels[:, :, :1], 3, axis=2)
    raise InputError(f"{file}: channels: wanted R, G, B or one grey, got {', '.join(names[:8])}")


def _linear(file: Path) -> tuple[NDArray[np.float32], int]:
    """Reads an EXR's display window, 0 outside its data window, and its orientation."""
    from .exr.reader import ExrReader, light_names

    with ExrReader(file) as reader:
        names = light_names(list(reader.channels), str(file))
        full = (reader.full_size[1], reader.full_size[0])
        check_size(reader.width, reader.height, 3, 4, str(file), MAX_ENVIRONMENT_BYTES)
        check_size(full[1], full[0], 3, 4, f"{file}: display window", MAX_ENVIRONMENT_BYTES)
        planes = reader.rows(0, reader.height, names)
        x, y = (a - b for a, b in zip(reader.corner, reader.full_corner, strict=True))
        turn = reader.facts.get("Orientation", 1)
    rgb = np.zeros((*full, 3), np.float32)
    x0, y0 = max(x, 0), max(y, 0)
    x1, y1 = min(x + reader.width, full[1]), min(y + reader.height, full[0])
    if x1 > x0 and y1 > y0:
        for i, name in enumerate(names):
            rgb[y0:y1, x0:x1, i] = planes[name][y0 - y : y1 - y, x0 - x : x1 - x]
    return rgb, turn if isinstance(turn, int) else 1


def _radiance_exposure(file: Path) -> float:
    """Product of the EXPOSURE lines, by which Radiance multiplies light (filefmts.pdf)."""
    with opened(file) as stream:
        lines = stream.read(8192).split(b"\n\n", 1)[0].splitlines()
    exposure = 1.0
    for line in lines:
        if line.startswith(b"EXPOSURE="):
            try:
                exposure *= float(line[9:])
            except ValueError:
                exposure = -1.0
    if not 1e-30 < exposure < 1e30:
        raise InputError(f"{file}: EXPOSURE: wanted a positive number, 1e-30 to 1e30")
    return exposure


def upright(pixels: NDArray[Any], orientation: int) -> NDArray[Any]:
    """Undoes EXIF orientation 1 .. 8 of a picture, shape (H, W) or (H, W, C)."""
    if orientation >= 5:
        pixels = pixels.swapaxes(0, 1)
    if orientation in (2, 3, 6, 7):
        pixels = pixels[:, ::-1]
    if orientation in (3, 4, 7, 8):
        pixels = pixels[::-1]
    return pixels
