"""Opens files to read: one wording for all that are missing, too large or not files.

Every file of a user is opened by ``opened`` or ``read_bytes``, or checked by ``size_of`` before a
library opens it by its name. So none is a pipe or a device, which might never end, and all are
noted as read (``in_use``).
"""

from __future__ import annotations

import os
import stat
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from io import BufferedReader
from pathlib import Path

from daguerre.errors import InputError

from .in_use import note_read

#: Maximum number of characters of a path in a message.
_LONGEST = 1000
MISSING = "no such file"
FOLDER = "wanted a file, got a folder"
_ODD = "not a regular file"


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
    """Formats a path for messages: a path from a file may be long."""
    name = os.fspath(path)
    return name if len(name) <= _LONGEST else f"{name[:_LONGEST]}..."


def is_file(path: Path) -> bool:
    """Whether there is such a file; false also for an invalid name, such as a name too long.

    ``Path.is_file`` raises ``OSError`` for a name of more than 255 bytes.
    """
    return _holds(path.is_file)


def is_input(path: Path) -> bool:
    """Whether there is such a file to read; notes a missing file too, as it may come."""
    note_read([path])
    return is_file(path)


def is_folder(path: Path) -> bool:
    """Whether there is such a folder; false also for an invalid name."""
    return _holds(path.is_dir)


def exists(path: Path) -> bool:
    """Whether there is a file or folder of this name; false also for an invalid name."""
    return _holds(path.exists)


def _holds(question: Callable[[], bool]) -> bool:
    try:
        return question()
    except (OSError, ValueError):
        return False


def fault_of(path: Path) -> str:
    """Says why a path is not a file that can be read; empty: it is a regular file."""
    try:
        mode = path.stat().st_mode
    except (OSError, ValueError) as error:  # ValueError: a name with a zero byte
        return why(error)
    return _fault(mode)


def _fault(mode: int) -> str:
    if stat.S_ISDIR(mode):
        return FOLDER
    return "" if stat.S_ISREG(mode) else _ODD


def size_of(path: Path, most: int | None = None) -> int:
    """Returns the size of a file, bytes, and notes that a library reads it.

    Raises:
        InputError: The file does not exist, is larger than ``most`` bytes, or it is a folder, a
            pipe or a device, which might never end.
        UsageError: The command is about to write it.
    """
    if fault := fault_of(path):
        note_read([path])  # a missing file may come
        raise InputError(f"{shown(path)}: {fault}")
    with reading(path):
        size = path.stat().st_size
    check_size(size, shown(path), most)
    note_read([path])
    return size


def opened(path: str | os.PathLike[str], most: int | None = None) -> BufferedReader:
    """Opens a file to read its bytes, and notes that it is read.

    Raises:
        InputError: See :func:`size_of`; or it cannot be read.
        UsageError: The command is about to write it.
    """
    size_of(Path(path), most)
    with reading(path):
        # A pipe that took the file's place since then would be waited for, but for O_NONBLOCK.
        wait = getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
        descriptor = os.open(path, os.O_RDONLY | os.O_CLOEXEC | wait)
    stream = os.fdopen(descriptor, "rb")
    if fault := _fault(os.fstat(descriptor).st_mode):
        stream.close()
        raise InputError(f"{shown(path)}: {fault}")
    return stream


def check_size(size: int, where: str, most: int | None) -> None:
    """Checks the size of a file, bytes; None: any size."""
    if most is not None and size > most:
        raise InputError(f"{where}: wanted at most {most} bytes, got {size}")


def read_bytes(path: Path, most: int | None = None) -> bytes:
    """Reads a file of at most ``most`` bytes.

    Raises:
        InputError: See :func:`size_of`; or it cannot be read.
        UsageError: The command is about to write it.
    """
    with opened(path, most) as stream, reading(path):
        return stream.read() if most is None else _at_most(stream, path, most)


def _at_most(stream: BufferedReader, path: Path, most: int) -> bytes:
    data = stream.read(most + 1)  # a file of /proc has size 0
    check_size(len(data), shown(path), most)
    return data


def decoded(data: bytes, where: str, encoding: str = "utf-8") -> str:
    """Decodes a text.

    Raises:
        InputError: The text is not UTF-8.
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
        InputError: The text is empty, or not UTF-8.
    """
    if not data.strip():
        raise InputError(f"{where}: empty file")
    return decoded(data, where, "utf-8-sig")
