"""Text files of limited size."""

from __future__ import annotations

from pathlib import Path

from .reading import decoded, read_bytes

#: Maximum size of a file.
MAX_BYTES = 1 << 30


def text_of(file: Path, encoding: str = "utf-8", most: int = MAX_BYTES) -> str:
    """Reads a text of at most ``most`` bytes.

    Raises:
        InputError: The path is not a regular file, is too large, or cannot be read.
    """
    return decoded(read_bytes(file, most), str(file), encoding)
