"""Text files with one statement a line, such as OBJ, each with its place for messages."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

from .reading import decoded, read_bytes

#: Maximum size of a file, which bounds the number of its statements.
MAX_BYTES = 1 << 30


def statements(
    path: str | os.PathLike[str], comment: str = "#"
) -> Iterator[tuple[str, str, list[str]]]:
    """Yields place (``file: line 7: word``), first word and other words of each non-empty line.

    Raises:
        InputError: The path is not a regular file, is too large, or cannot be read as UTF-8.
    """
    file = Path(path)
    for number, line in enumerate(text_of(file).splitlines(), 1):
        if words := line.split(comment)[0].split():
            yield f"{file}: line {number}: {words[0][:20]}", words[0], words[1:]


def text_of(file: Path, encoding: str = "utf-8", most: int = MAX_BYTES) -> str:
    """Reads a text of at most ``most`` bytes.

    Raises:
        InputError: The path is not a regular file, is too large, or cannot be read.
    """
    return decoded(read_bytes(file, most), str(file), encoding)
