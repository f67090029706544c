"""Decodes KTX 2.0 textures of KHR_texture_basisu: ETC1S and UASTC to RGB(A), level 0 only.

The header and its sizes are checked here. Binomial's transcoder, the package ``opengl_basisu`` of
the extra ``compression``, does the rest. The header's transfer function is not read, as in glTF the
use of a texture sets it.
Source: KTX file format specification 2.0, chapter 3; KHR_texture_basisu.
"""

from __future__ import annotations

import struct
from importlib import import_module
from typing import NoReturn

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import InputError
from daguerre.files import extras

MAGIC = b"\xabKTX 20\xbb\r\n\x1a\n"
_NONE, _BASIS_LZ, _ZSTD = 0, 1, 2


def size(data: bytes, where: str) -> tuple[int, int]:
    """Checks the header of a plain 2D texture; returns width and height, px.

    Raises:
        InputError: The header is truncated or of another kind, or level 0 does not fit the file.
    """

    def fail(what: str, wanted: object, got: object) -> NoReturn:
        raise InputError(f"{where}: KTX2 {what}: wanted {wanted}, got {got}")

    if len(data) < 104:
        fail("header", "at least 104 bytes", len(data))
    vk_format, _, width, height, depth, layers, faces, levels, scheme = struct.unpack_from(
        "<9I", data, 12
    )
    offset, length, unpacked = struct.unpack_from("<3Q", data, 80)
    if vk_format != 0:
        fail("vkFormat", "0 (Basis Universal)", vk_format)
    if min(width, height) < 1:
        fail("size", "at least 1x1", f"{width}x{height}")
    if (depth, layers, faces) != (0, 0, 1):
        fail("depth, layers, faces", "0, 0, 1 (a 2D texture)", f"{depth}, {layers}, {faces}")
    if levels > 32:
        fail("levelCount", "at most 32", levels)
    if scheme not in (_NONE, _BASIS_LZ, _ZSTD):
        fail("supercompressionScheme", "0, 1 or 2", scheme)
    if offset + length > len(data):
        fail("level 0", f"at most {len(data)} bytes", offset + length)
    blocks = -(-width // 4) * -(-height // 4) * 16
    if scheme != _BASIS_LZ and (length if scheme == _NONE else unpacked) != blocks:
        fail("level 0", f"{blocks} bytes of UASTC", length if scheme == _NONE else unpacked)
    return width, height


def decode(data: bytes, where: str) -> NDArray[np.uint8]:
    """Decodes level 0 of a file that ``size`` has checked, shape (H, W, 3 or 4).

    Raises:
        InputError: The data are damaged, or the package is not installed.
    """
    package = extras.missing_for("KHR_texture_basisu")
    if package:
        raise InputError(f"{where}: KTX2 {extras.lack(package)}")
    basisu = import_module(extras.EXTENSIONS["KHR_texture_basisu"])
    try:
        texture = basisu.open(data)
        rgba: NDArray[np.uint8] = texture.transcode("rgba8").data
    except (ValueError, MemoryError) as error:
        raise InputError(f"{where}: KTX2 cannot be decoded: {error}") from None
    return rgba if texture.has_alpha else np.ascontiguousarray(rgba[:, :, :3])
