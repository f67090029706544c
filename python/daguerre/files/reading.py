"""Files before they are read: one wording for all that are missing, too large or not files."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from daguerre.errors import InputError

#: Maximum number of characters of a path in a message.
_LONGEST = 1000
MISSING = "no such file"
FOLDER = "wanted a file, got a folder"


def why(error: OSError | ValueError) -> str:
    """Says why a file cannot be read."""
    if isinstance(error, FileNotFoundError | NotADirectoryError):
        return MISSING
    if isinstance(error, IsADirectoryError):
        return FOLDER
    return f"cannot read: {getattr(error, 'strerror', None) or error}"


@contextmanager
def reading(path: str | os.PathLike[str]) -> Iterator[None]:
    """Turns errors of the system into ``InputError``, with the path in front."""
    try:
        yield
    except OSError as error:
        raise InputError(f"{shown(path)}: {why(error)}") from error


def shown(path: str | os.PathLike[str]) -> str:
    """Formats a path for messages: one that comes from a file may be long."""
    name = os.fspath(path)
    return name if len(name) <= _LONGEST else f"{name[:_LONGEST]}..."


def fault_of(path: Path) -> str:
    """Says why a path is not a file that can be read; empty: it is a regular file."""
    try:
        mode = path.stat().st_mode
    except (OSError, ValueError) as error:  # ValueError: a name with a zero byte
        return why(error)
    if stat.S_ISDIR(mode):
        return FOLDER
    return "" if stat.S_ISREG(mode) else "not a regular file"


def size_of(path: Path, most: int | None = None) -> int:
    """Returns the size of a file, bytes.

    Raises:
        InputError: There is no such file, it is larger than ``most`` bytes, or it is a folder, a
            pipe or a device, which might never end.
    """
    if fault := fault_of(path):
        raise InputError(f"{shown(path)}: {fault}")
    with reading(path):
        size = path.stat().st_size
    check_size(size, shown(path), most)
    return size


def check_size(size: int, where: str, most: int | None) -> None:
    """Checks the size of a file, bytes; None: any size."""
    if most is not None and size > most:
        raise InputError(f"{where}: wanted at most {most} bytes, got {size}")


def read_bytes(path: Path, most: int | None = None) -> bytes:
    """Reads a file of at most ``most`` bytes.

    Raises:
        InputError: See :func:`size_of`; or it cannot be read.
    """
    size_of(path, most)
    with reading(path):
        return path.read_bytes()


def decoded(data: bytes, where: str, encoding: str = "utf-8") -> str:
    """Decodes a text.

    Raises:
        InputError: It is not UTF-8.
    """
    try:
        return data.decode(encoding)
    except UnicodeDecodeError as error:
        raise InputError(f"{where}: {not_utf8(error)}") from None


def not_utf8(error: UnicodeDecodeError) -> str:
    """Says where bytes are not UTF-8."""
    return f"wanted UTF-8, got byte 0x{error.object[error.start]:02x} at byte {error.start}"


def document(data: bytes, where: str) -> str:
    """Decodes a text that must not be empty.

    Raises:
        InputError: It is empty, or not UTF-8.
    """
    if not data.strip():
        raise InputError(f"{where}: empty file")
    return decoded(data, where, "utf-8-sig")
