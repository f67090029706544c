"""Writes developed pictures: JPEG, PNG, TIFF and EXR, with profile and EXIF.

OpenImageIO encodes JPEG and PNG, tifffile TIFF. :mod:`daguerre.pictures.exif` makes the EXIF block,
as OpenImageIO writes 1/48 s as 20833/1000000.
"""

from __future__ import annotations

import os
import struct
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.checks import whole
from daguerre.color import spaces
from daguerre.errors import OutputError, UsageError
from daguerre.files.atomic import atomic_path
from daguerre.files.formats import check_written, written
from daguerre.frame.picture import quantized

from . import exif, icc, png_chunks
from .tiff import TiffImage, write_tiff


def write_picture(
    path: str | os.PathLike[str],
    pixels: NDArray[np.float32],
    space: str,
    metadata: Mapping[str, Any],
    *,
    quality: int = 95,
    bits: int | None = None,
) -> None:
    """Writes a developed picture atomically.

    Args:
        path: File; its suffix sets the format: JPEG with 8 bits, TIFF with 16 or 8, PNG with 8 or
            16, EXR with linear floats.
        pixels: Values encoded with the curve of ``space``, 0 to 1, or light, shape (H, W, 3).
        space: Name in ``daguerre.color.spaces.COLOR_SPACES``; linear spaces need EXR.
        metadata: Metadata for EXIF, with OpenEXR's names.
        quality: JPEG quality, 1 to 100.
        bits: Bits per channel; default: 16 for TIFF, else 8.

    Raises:
        UsageError: The suffix is unknown, or the format does not have this quality or bits.
        OutputError: The file cannot be written.
    """
    suffix = check_written(path, written("picture"))
    whole(quality, f"{path}: quality", 1, 100)
    check_space(path, space)
    if suffix == ".exr":
        _write_linear(path, pixels, space, metadata)
        return
    bits = _bits(path, suffix, bits)
    numbers = quantized(pixels, bits)
    with atomic_path(path) as temp:
        if suffix in (".tif", ".tiff"):
            _write_tiff(temp, numbers, space, metadata)
            return
        size = (pixels.shape[1], pixels.shape[0])
        data = exif.block(metadata, size, srgb=space == "srgb")
        add = _jpeg_with if suffix in (".jpg", ".jpeg") else _png_with
        temp.write_bytes(add(_coded(suffix, numbers, space, quality, str(path)), data, space))


def check_space(path: str | os.PathLike[str], space: str) -> None:
    """Checks that a file can hold a colour space.

    Raises:
        UsageError: Linear light would be encoded for a display.
    """
    if space not in spaces.ENCODED and not str(path).lower().endswith(".exr"):
        wanted = ", ".join(spaces.ENCODED)
        raise UsageError(
            f"{path}: color space {space}: linear light needs .exr; other files take {wanted}"
        )


def _bits(path: str | os.PathLike[str], suffix: str, bits: int | None) -> int:
    allowed = (8,) if suffix in (".jpg", ".jpeg") else (8, 16)
    usual = 16 if suffix in (".tif", ".tiff") else 8
    if bits is not None and bits not in allowed:
        wanted = " or ".join(map(str, allowed))
        raise UsageError(f"{path}: bits: wanted {wanted} for {suffix}, got {bits}")
    return bits or usual


def _coded(suffix: str, numbers: NDArray[Any], space: str, quality: int, path: str) -> bytes:
    """Encodes JPEG or PNG by OpenImageIO, with the profile.

    It writes into a pipe, as libjpeg ends the whole process on a full disk or at the limit of a
    file's size.
    """
    import OpenImageIO as oiio

    height, width, count = numbers.shape
    kind = oiio.UINT8 if numbers.dtype == np.uint8 else oiio.UINT16
    spec = oiio.ImageSpec(width, height, count, kind)
    profile = np.frombuffer(icc.profile(space), np.uint8)
    spec.attribute("ICCProfile", oiio.TypeDesc(f"uint8[{len(profile)}]"), profile)
    spec.attribute("Compression", f"jpeg:{quality}" if suffix[1] == "j" else "zip:6")
    if quality >= 90:
        spec.attribute("jpeg:subsampling", "4:4:4")
    picture = oiio.ImageBuf(spec)

    def write(name: str) -> None:
        # This call releases the interpreter's lock, which the reader of the pipe needs.
        if not picture.write(name, kind, suffix[1:]):
            reason = str(picture.geterror() or "unknown reason").replace(name, path)
            raise OutputError(f"{path}: cannot write: {reason}")

    if not picture.set_pixels(oiio.ROI.All, numbers):
        raise OutputError(f"{path}: cannot write: {picture.geterror()}")
    return _through_a_pipe(write)


def _through_a_pipe(write: Callable[[str], None]) -> bytes:
    """Returns the bytes that ``write`` writes to the file it is given."""
    pipe, end = os.pipe()
    with ThreadPoolExecutor(1) as reader, os.fdopen(pipe, "rb") as source:
        data = reader.submit(source.read)
        try:
            write(f"/proc/self/fd/{end}")
        finally:
            os.close(end)
        return data.result()


def _jpeg_with(data: bytes, block: bytes, _: str) -> bytes:
    """Sets the EXIF block of a JPEG file."""
    head, at = data[:2], 2
    while data[at + 1] != 0xDA:  # up to the start of the scan
        end = at + 2 + int.from_bytes(data[at + 2 : at + 4], "big")
        if not (data[at + 1] == 0xE1 and data[at + 4 : at + 8] == b"Exif"):
            head += data[at:end]
        at = end
    segment = b"Exif\0\0" + block
    # JFIF (APP0) stays first, as its standard requires.
    after = 4 + int.from_bytes(head[4:6], "big") if head[3] == 0xE0 else 2
    app1 = b"\xff\xe1" + struct.pack(">H", len(segment) + 2) + segment
    return head[:after] + app1 + head[after:] + data[at:]


def _png_with(data: bytes, block: bytes, space: str) -> bytes:
    """Sets the EXIF block and cICP code points of a PNG file (PNG 3rd edition, 11.3)."""
    if not png_chunks.is_complete(BytesIO(data)):
        raise OutputError("PNG: the file is not complete; is the disk full?")
    cicp = bytes([*(spaces.COLOR_SPACES[space].cicp or ()), 0, 1])
    head, *rest = png_chunks.chunks(BytesIO(data))
    kept = [(c.kind, c.data) for c in rest if c.kind not in (b"eXIf", b"cICP")]
    all_ = [(head.kind, head.data), (b"cICP", cicp), (b"eXIf", block), *kept]
    start = data[: png_chunks.SIGNATURE_BYTES]
    return start + b"".join(png_chunks.encoded(kind, data) for kind, data in all_)


def _write_tiff(temp: Path, numbers: NDArray[Any], space: str, metadata: Mapping[str, Any]) -> None:
    tags = exif.main_tags(metadata)
    tags[34675] = (exif.UNDEFINED, tuple(icc.profile(space)))
    write_tiff(temp, [TiffImage(numbers, "rgb", tags)], exif.exposure_tags(metadata))


def _of_size(metadata: Mapping[str, Any], width: int, height: int) -> dict[str, Any]:
    """Metadata without resolution and crop if these do not fit the picture's size."""
    size, crop = metadata.get("resolution"), metadata.get("crop")
    x0, y0, x1, y1 = crop or (0, 0, *(size or (width, height)))
    if (x1 - x0, y1 - y0) == (width, height):
        return dict(metadata)
    return {key: value for key, value in metadata.items() if key not in ("resolution", "crop")}


def _write_linear(
    path: str | os.PathLike[str],
    pixels: NDArray[np.float32],
    space: str,
    metadata: Mapping[str, Any],
) -> None:
    """Writes linear light in the primaries of the space, with the attributes of a frame."""
    from daguerre.frame.frame import Frame

    from .exr import color_space
    from .exr.write import ExrPart, attributes, write_parts

    linear = np.empty_like(pixels)
    for row in range(0, len(pixels), 64):
        linear[row : row + 64] = spaces.decoded(pixels[row : row + 64], space)
    own = {"colorspace": space if space in spaces.LINEAR else None}
    header = attributes({**metadata, **own})
    if space == spaces.CAMERA:
        del header["chromaticities"]
        header["colorInteropID"] = "unknown"
    else:
        header |= color_space.space_attributes(space)
    planes: dict[str, Any] = {"RGB": linear}
    if space == color_space.ACES:
        header |= color_space.container_attributes()
        planes = color_space.container_planes(planes)
    frame = Frame(rgb=linear, metadata=_of_size(metadata, linear.shape[1], linear.shape[0]))
    write_parts(path, [ExrPart("picture", header, planes)], frame)
