"""Checks WebP files before they are decoded."""

from __future__ import annotations

from daguerre.errors import InputError

from .source import PictureBytes


def check(source: PictureBytes, where: str, limit: int) -> None:
    """Checks the length; a WebP cannot be larger than 16383 x 16383 px.

    Raises:
        InputError: The file is truncated.
    """
    wanted = 8 + int.from_bytes(source.at(4, 4), "little")
    if source.size < wanted:
        raise InputError(f"{where}: truncated WebP: wanted {wanted} bytes, got {source.size}")
