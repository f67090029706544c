"""Atomic writing: files appear under their final name complete or not at all.

A temporary file is written, synced and renamed. A power failure at any moment leaves the old file
or the new one: the bytes reach the disk before the name, and the folder is synced after it. Writers
hold a lock on their temporary file. A temporary file without a lock was left by a killed writer,
and is removed when the same file is written or removed next.

All outputs are opened here, so a file that the command reads is refused as an output here.
"""

from __future__ import annotations

import errno
import fcntl
import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from daguerre.errors import OutputError

from .in_use import claim, note_made

Name = str | os.PathLike[str]
_HEX = frozenset("0123456789abcdef")


@contextmanager
def atomic_path(target: Name, *, over: Name | None = None) -> Iterator[Path]:
    """Yields a temporary path that replaces ``target`` when the block ends without error.

    The temporary file has the suffix of the target, since image writers choose by it. If the block
    raises anything, Ctrl-C included, the file is removed and the target is unchanged.

    Args:
        target: Final path; a link is followed, and the file that it points to is replaced.
        over: File that the command reads, and that the target may replace all the same.

    Raises:
        OutputError: No such folder, no permission, disk full; the message names the path.
        UsageError: The command reads this file (``in_use``).
    """
    path = _resolved(target, over)
    _drop_left(path)
    temp = _temporary(path)
    lock = None
    try:
        with _os_errors(path):
            lock = _create(temp)
        with _os_errors(path):  # faults of the block's writes
            yield temp
            _sync(temp)
            temp.replace(path)
            _sync(path.parent)
        note_made(path)
    finally:
        with suppress(OSError):
            temp.unlink()
        if lock is not None:
            os.close(lock)


def write_bytes(target: Name, data: bytes) -> None:
    """Writes a whole file atomically."""
    with atomic_path(target) as temp, _os_errors(Path(target)):
        temp.write_bytes(data)


def check_writable(target: Name, *, over: Name | None = None) -> None:
    """Checks that a file can be written, by making and removing an empty file beside it.

    It also removes temporary files of killed writers; the file itself is not touched.

    Args:
        target: Final path.
        over: See :func:`atomic_path`.

    Raises:
        OutputError: The file cannot be written. Call this before hours are spent on a picture.
        UsageError: The command reads this file (``in_use``).
    """
    path = _resolved(target, over)
    _drop_left(path)
    temp = _temporary(path)
    with _os_errors(path):
        os.close(_create(temp))
        temp.unlink()


def remove(target: Name) -> None:
    """Removes a file, if it exists, and temporary files that killed writers of it left.

    Raises:
        OutputError: The file cannot be removed.
        UsageError: The command reads this file (``in_use``).
    """
    path = Path(target)
    claim(path)
    with _os_errors(path):
        path.unlink(missing_ok=True)
    _drop_left(path)


def _resolved(target: Name, over: Name | None) -> Path:
    path = Path(target)
    try:
        os.fspath(path).encode()
    except UnicodeEncodeError:  # writers of pictures take text alone
        raise OutputError(f"{target}: cannot write: wanted a name in UTF-8") from None
    with _os_errors(path):
        mode = _mode(path)
        path = Path(os.path.realpath(path))
        if not path.parent.is_dir():
            raise OutputError(f"{target}: cannot write: no such folder: {path.parent}")
        if stat.S_ISDIR(mode):
            raise OutputError(f"{target}: cannot write: wanted a file name, got a folder")
        if mode and not stat.S_ISREG(mode):
            raise OutputError(f"{target}: cannot write: not a regular file")
    claim(target, over)
    return path


def _mode(path: Path) -> int:
    """Mode of a file, links followed; 0: no such file. A link to itself is an error."""
    try:
        return path.stat().st_mode
    except (FileNotFoundError, NotADirectoryError):
        return 0


def _temporary(path: Path) -> Path:
    return path.with_name(f".{path.stem}.{os.urandom(4).hex()}.tmp{path.suffix}")


def _create(path: Path) -> int:
    """Makes an empty file, which is locked while the returned descriptor is open."""
    # 0o666 less the umask, as any program; mkstemp would make the file unreadable for other users.
    descriptor = os.open(path, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666)
    with suppress(OSError):  # some network file systems have no locks
        fcntl.flock(descriptor, fcntl.LOCK_EX)
    if os.fstat(descriptor).st_nlink:
        return descriptor
    os.close(descriptor)  # another writer removed the file as abandoned, before it was locked
    return _create(path)


def _drop_left(path: Path) -> None:
    """Removes temporary files of this target that dead writers left."""
    # No regular expression: a long sequence of files would fill the cache of patterns.
    head, tail = f".{path.stem}.", f".tmp{path.suffix}"
    length = len(head) + 8 + len(tail)
    with suppress(OSError), os.scandir(path.parent) as entries:
        for entry in entries:
            name = entry.name
            if (
                len(name) == length
                and name.startswith(head)
                and name.endswith(tail)
                and _HEX.issuperset(name[len(head) : -len(tail)])
                and entry.is_file(follow_symlinks=False)
            ):
                _drop_unlocked(Path(entry.path))


def _drop_unlocked(path: Path) -> None:
    with suppress(OSError):
        descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW)
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            path.unlink()
        finally:
            os.close(descriptor)


def _sync(path: Path) -> None:
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    except OSError as error:
        # Some file systems cannot sync folders; a file that cannot be synced is an error.
        if not (path.is_dir() and error.errno in (errno.EINVAL, errno.ENOTSUP)):
            raise
    finally:
        os.close(descriptor)


@contextmanager
def _os_errors(path: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise OutputError(f"{path}: cannot write: {error.strerror or error}") from error
