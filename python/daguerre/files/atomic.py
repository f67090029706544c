"""Files that appear under their final name complete or not at all: temp + fsync + rename."""

from __future__ import annotations

import errno
import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from daguerre.errors import OutputError


@contextmanager
def atomic_path(target: str | os.PathLike[str]) -> Iterator[Path]:
    """A temporary path beside ``target`` that becomes ``target`` when the block ends well.

    The temporary file has the suffix of the target, since image writers choose by it. If anything
    is raised inside the block, Ctrl-C included, it is removed and the target is untouched.

    Args:
        target: Final path; a link is followed, so that the file that it points to is replaced.

    Raises:
        OutputError: No such folder, no permission, disk full; named with the path.
    """
    path = _resolved(target)
    temp = path.with_name(f".{path.stem}.{secrets.token_hex(4)}.tmp{path.suffix}")
    try:
        with _os_errors(path):
            _create(temp)
        with _os_errors(path):  # what the block itself could not write
            yield temp
            _sync(temp)
            temp.replace(path)
            _sync(path.parent)
    finally:
        with suppress(OSError):
            temp.unlink()


def write_bytes(target: str | os.PathLike[str], data: bytes) -> None:
    """Writes a whole file atomically."""
    with atomic_path(target) as temp, _os_errors(Path(target)):
        temp.write_bytes(data)


def check_writable(target: str | os.PathLike[str]) -> None:
    """Tries whether a file could be written there, by making and removing an empty one beside it.

    Raises:
        OutputError: It could not; said before hours are spent on a picture.
    """
    path = _resolved(target)
    temp = path.with_name(f".{path.stem}.{secrets.token_hex(4)}.tmp{path.suffix}")
    with _os_errors(path):
        _create(temp)
        temp.unlink()


def _resolved(target: str | os.PathLike[str]) -> Path:
    path = Path(target)
    try:
        os.fspath(path).encode()
    except UnicodeEncodeError:  # writers of pictures take text alone
        raise OutputError(f"{target}: cannot write: wanted a name in UTF-8") from None
    with _os_errors(path):
        path = path.resolve()
        if not path.parent.is_dir():
            raise OutputError(f"{target}: cannot write: there is no folder {path.parent}")
        if path.is_dir():
            raise OutputError(f"{target}: cannot write: it is a folder, wanted a file name")
    return path


def _create(path: Path) -> None:
    # 0o666 less the umask, as any program; mkstemp would make it unreadable for others.
    os.close(os.open(path, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666))


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
