"""Decodes pictures: textures from bytes, environments from files.

OpenImageIO decodes. Truncated and corrupt files are rejected here first, as it fills a truncated
JPEG with grey and libpng writes to stderr. Its Python wheel cannot read from memory, so bytes pass
through a temporary file.
"""

from __future__ import annotations

import os
import struct
import zlib
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.checks import DEFLATE_LIMIT
from daguerre.color import srgb
from daguerre.errors import InputError
from daguerre.files.json_item import short
from daguerre.files.reading import size_of

from . import ktx2

MAX_PIXELS = 16384 * 16384
#: Largest decoded size of a texture and of an environment (16384 x 8192 in float is 1.5 GiB).
MAX_BYTES = 1 << 30
MAX_ENVIRONMENT_BYTES = 2 << 30
#: Largest colour channel of an environment: the sum of three still fits a float.
MAX_LIGHT = 1e38
_PNG_MAGIC = b"\x89PNG\r\n\x1a\n"
# Bits by colour type (PNG specification, 11.2.1).
_PNG_DEPTHS = {0: (1, 2, 4, 8, 16), 2: (8, 16), 3: (1, 2, 4, 8), 4: (8, 16), 6: (8, 16)}


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
        _check_size(*ktx2.size(data, where), 4, 1, where)
        return ktx2.decode(data, where)
    if data.startswith(_PNG_MAGIC):
        _check_png(data, where)
        suffix = ".png"
    elif data.startswith(b"\xff\xd8\xff"):
        _check_jpeg(data, where)
        suffix = ".jpg"
    elif data[:4] == b"RIFF" and data[8:12] == b"WEBP":
        wanted = 8 + int.from_bytes(data[4:8], "little")
        if len(data) < wanted:
            raise InputError(f"{where}: truncated WebP: wanted {wanted} bytes, got {len(data)}")
        suffix = ".webp"
    else:
        raise InputError(f"{where}: wanted a PNG, JPEG, WebP or KTX2 image, got {short(data[:8])}")
    import tempfile

    descriptor, name = tempfile.mkstemp(suffix=suffix, prefix="daguerre-")
    try:
        with os.fdopen(descriptor, "wb") as stream:
            stream.write(data)
        pixels, _, _ = _read(name, where)
    finally:
        Path(name).unlink(missing_ok=True)
    if pixels.shape[2] > 4:
        raise InputError(f"{where}: wanted 1 to 4 channels, got {pixels.shape[2]}")
    if pixels.dtype == np.uint8:
        return pixels
    if pixels.dtype == np.uint16:
        return pixels.astype(np.float32) / np.float32(65535)
    return pixels.astype(np.float32)


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
    pixels, spec, kind = _read(str(file), str(file), MAX_ENVIRONMENT_BYTES)
    if np.issubdtype(pixels.dtype, np.integer):
        scale = np.float32(np.iinfo(pixels.dtype).max)
        rgb = srgb.to_linear(_rgb(pixels, spec, file).astype(np.float32) / scale)
    else:
        rgb = _rgb(pixels, spec, file).astype(np.float32)
    if kind == "hdr":
        rgb /= np.float32(_radiance_exposure(file))
    return _checked_light(file, upright(rgb, spec.get_int_attribute("Orientation", 1)))


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


def read_file(path: Path, *, floats: bool = False) -> tuple[NDArray[Any], Any]:
    """Reads pixels in the type of the file, shape (H, W, C), not turned upright, and its header.

    Args:
        path: File in a format that OpenImageIO decodes.
        floats: Return float32 instead: integers scaled to 0 .. 1, premultiplied by alpha.

    Returns:
        The pixels, with straight alpha unless ``floats``, and OpenImageIO's ``ImageSpec``.

    Raises:
        InputError: The file cannot be decoded, is truncated or too large.
    """
    from .exr.reader import is_exr

    with path.open("rb") as stream:
        start = stream.read(8)
    if is_exr(path):
        raise InputError(f"{path}: OpenEXR is not supported here")
    if start.startswith(_PNG_MAGIC):
        _check_png(path.read_bytes(), str(path))
    elif start.startswith(b"\xff\xd8\xff"):
        _check_jpeg(path.read_bytes(), str(path))
    pixels, spec, _ = _read(str(path), str(path), floats=floats)
    return pixels, spec


def _check_jpeg(data: bytes, where: str) -> None:
    """Checks for an end marker, as libjpeg fills missing pixels with grey."""
    if data.rfind(b"\xff\xd9") < data.rfind(b"\xff\xda"):
        raise InputError(f"{where}: truncated JPEG: the end marker is missing")


def _read(
    name: str, where: str, limit: int = MAX_BYTES, *, floats: bool = False
) -> tuple[NDArray[Any], Any, str]:
    """Returns pixels, ``ImageSpec`` and the name of the format; see :func:`read_file`."""
    import OpenImageIO as oiio  # takes 30 MB, which scenes without pictures save

    try:
        name.encode()
    except UnicodeEncodeError:
        raise InputError(f"{where}: cannot be decoded: wanted a name in UTF-8") from None
    config = oiio.ImageSpec()
    config.attribute("oiio:UnassociatedAlpha", int(not floats))
    source = oiio.ImageInput.open(name, config)
    if source is None:
        raise InputError(f"{where}: cannot be decoded: {_reason(oiio.geterror(), name)}")
    try:
        spec = source.spec()
        format = oiio.TypeDesc(oiio.FLOAT) if floats else spec.format
        _check_size(spec.width, spec.height, spec.nchannels, format.basesize(), where, limit)
        pixels = source.read_image(0, 0, 0, spec.nchannels, format)
        error, kind = source.geterror(), str(source.format_name())
    finally:
        source.close()
    if pixels is None or (error and "extraneous bytes" not in error):
        raise InputError(f"{where}: cannot be decoded: {_reason(error, name)}")
    return np.asarray(pixels).reshape(spec.height, spec.width, spec.nchannels), spec, kind


def _reason(error: str, name: str) -> str:
    line = error.strip().splitlines()[0] if error.strip() else "no reason given"
    return line.replace(f'("{name}")', "").replace(name, Path(name).name).strip()[:200]


def _check_size(
    width: int, height: int, channels: int, bytes_each: int, where: str, limit: int = MAX_BYTES
) -> None:
    if min(width, height, channels) < 1:
        raise InputError(f"{where}: image size: wanted at least 1x1, got {width}x{height}")
    size = width * height * channels * bytes_each
    if width * height > MAX_PIXELS or size > limit:
        raise InputError(
            f"{where}: image size: wanted at most {MAX_PIXELS} pixels and {limit >> 20} MiB, "
            f"got {width}x{height} ({size >> 20} MiB)"
        )


def _check_png(data: bytes, where: str) -> None:
    """Checks chunks, checksums and header (PNG specification, chapters 5 and 11)."""
    offset, packed, header, start = len(_PNG_MAGIC), 0, b"", b""
    while True:
        if offset + 12 > len(data):
            raise InputError(f"{where}: truncated PNG: the IEND chunk is missing")
        length, kind = struct.unpack_from(">I4s", data, offset)
        end = offset + 12 + length
        if end > len(data):
            raise InputError(
                f"{where}: truncated PNG: wanted at least {end} bytes, got {len(data)}"
            )
        (stored,) = struct.unpack_from(">I", data, end - 4)
        if kind[:1].isupper() and zlib.crc32(data[offset + 4 : end - 4]) != stored:
            raise InputError(f"{where}: corrupt PNG: wrong checksum of chunk {short(kind)}")
        if kind == b"IHDR":
            header = data[offset + 8 : end - 4]
        if kind == b"IDAT":
            start += data[offset + 8 : offset + 8 + min(length, 2 - len(start))]
            packed += length
        if kind == b"IEND":
            break
        offset = end
    if len(header) != 13:
        raise InputError(f"{where}: corrupt PNG: wanted 13 bytes of IHDR, got {len(header)}")
    width, height, depth, color = struct.unpack_from(">IIBB", header)
    if depth not in _PNG_DEPTHS.get(color, ()):
        raise InputError(
            f"{where}: corrupt PNG: wanted a known kind of pixels, got colour type {color} "
            f"of {depth} bits"
        )
    channels = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}[color]
    _check_size(width, height, channels, max(depth // 8, 1), where)
    if len(start) < 2 or start[0] & 15 != 8 or int.from_bytes(start, "big") % 31:  # RFC 1950, 2.2
        raise InputError(f"{where}: corrupt PNG: wanted a deflate stream, got {short(start)}")
    unpacked = height * ((width * depth * channels + 7) // 8)
    if unpacked > packed * DEFLATE_LIMIT + 64:
        raise InputError(
            f"{where}: truncated PNG: {packed} bytes cannot hold {width}x{height} pixels"
        )


def _rgb(pixels: NDArray[Any], spec: Any, file: Path) -> NDArray[Any]:
    """Selects the colour channels: R, G, B in any position, or one grey."""
    names = [str(name).rsplit(".", 1)[-1].upper() for name in spec.channelnames]
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
        _check_size(reader.width, reader.height, 3, 4, str(file), MAX_ENVIRONMENT_BYTES)
        _check_size(full[1], full[0], 3, 4, f"{file}: display window", MAX_ENVIRONMENT_BYTES)
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
    with file.open("rb") as stream:
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
