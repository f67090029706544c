"""Limits of the size of pictures."""

from __future__ import annotations

from daguerre.errors import InputError

MAX_PIXELS = 16384 * 16384
#: Largest decoded size of a texture and of an environment (16384 x 8192 in float is 1.5 GiB).
MAX_BYTES = 1 << 30
MAX_ENVIRONMENT_BYTES = 2 << 30


def check_size(
    width: int, height: int, channels: int, bytes_each: int, where: str, limit: int = MAX_BYTES
) -> None:
    """Checks the size of a picture before its pixels are read.

    Args:
        width: Width, px.
        height: Height, px.
        channels: Number of channels.
        bytes_each: Bytes of a channel of a pixel.
        where: Place of the picture, for messages.
        limit: Most bytes of all pixels.

    Raises:
        InputError: The picture has no pixels, or too many.
    """
    if min(width, height, channels) < 1:
        raise InputError(f"{where}: image size: wanted at least 1x1, got {width}x{height}")
    size = width * height * channels * bytes_each
    if width * height > MAX_PIXELS or size > limit:
        raise InputError(
            f"{where}: image size: wanted at most {MAX_PIXELS} pixels and {limit >> 20} MiB, "
            f"got {width}x{height} ({size >> 20} MiB)"
        )
