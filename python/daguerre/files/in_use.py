"""Files that a command reads, so that it writes onto none of them.

Every reader notes its files here (``note_read``), and every writer asks before it opens or removes
one (``claim``). A file is known by device and inode, so links and other spellings of a name make no
difference. Whichever comes second, reading or claiming, ends the command, which is mostly before
anything is drawn.

The record belongs to one command of the command line (``command``), or to one call of a function
that reads and writes (``call``). Python programs that load a file and later save over it mean it:
without a record nothing is noted, and nothing is refused.
"""

from __future__ import annotations

import os
import stat
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from pathlib import Path

from daguerre.errors import UsageError

from . import uses

Name = str | os.PathLike[str]
#: Device and inode of a file.
_File = tuple[int, int]


@dataclass
class _Record:
    """Files by their identity, each with a name: read, to be written, and written already."""

    read: dict[_File, str] = field(default_factory=dict)
    claimed: dict[_File, str] = field(default_factory=dict)
    made: dict[_File, str] = field(default_factory=dict)


#: Record of the running command, which all its threads share.
_of_command: _Record | None = None
#: Record of a call of a function, in its thread and threads that get its context.
_of_call: ContextVar[_Record | None] = ContextVar("files in use", default=None)
#: Whether files are read to be replaced, such as a checkpoint.
_replacing: ContextVar[bool] = ContextVar("files to be replaced", default=False)


@contextmanager
def command() -> Iterator[None]:
    """Context of a command; a nested command shares its record."""
    global _of_command
    before = _of_command
    _of_command = before or _Record()
    try:
        yield
    finally:
        _of_command = before


@contextmanager
def call() -> Iterator[None]:
    """Context of a function that reads and writes; within a command it shares the command's."""
    if _record() is not None:
        yield
        return
    token = _of_call.set(_Record())
    try:
        yield
    finally:
        _of_call.reset(token)


@contextmanager
def in_place() -> Iterator[None]:
    """Context in which files are opened that the same command may replace, such as checkpoints."""
    token = _replacing.set(True)
    try:
        yield
    finally:
        _replacing.reset(token)


def note_read(paths: Iterable[Name]) -> None:
    """Notes files that are read; skips files that do not exist.

    Readers in other processes report the names of their files, which belong here, too.

    Raises:
        UsageError: The command is about to write a file that it reads.
    """
    paths = list(paths)
    for path in paths:
        uses.opens(path)
    record = _record()
    if record is None or _replacing.get():
        return
    for path in paths:
        file = _file(path)
        if file is None or _still(record.made, file):
            continue
        record.read[file] = os.fspath(path)
        if _still(record.claimed, file):
            raise _refused(record.claimed[file], record.read[file])


def claim(target: Name, over: Name | None = None) -> None:
    """Claims a file that will be written, replaced or removed.

    Args:
        target: The file.
        over: File that is read and may be replaced all the same.

    Raises:
        UsageError: The command has read it.
    """
    record = _record()
    file = None if record is None else _file(target)
    if record is None or file is None or (over is not None and file == _file(over)):
        return
    if _still(record.read, file):
        raise _refused(os.fspath(target), record.read[file])
    record.claimed[file] = os.fspath(target)


def is_read(path: Name) -> bool:
    """Whether the command has read a file."""
    record, file = _record(), _file(path)
    return record is not None and file is not None and _still(record.read, file)


def note_made(target: Name) -> None:
    """Notes a file that the command has just written; it may read and write it again."""
    record = _record()
    file = None if record is None else _file(target)
    if record is not None and file is not None:
        record.made[file] = os.fspath(target)
        record.read.pop(file, None)  # the number of a file that is gone


def _record() -> _Record | None:
    return _of_call.get() or _of_command


def _file(path: Name) -> _File | None:
    """Identity of a regular file, links followed; None: no such file."""
    try:
        found = os.stat(path)  # noqa: PTH116
    except (OSError, ValueError):  # ValueError: a name with a zero byte
        return None
    return (found.st_dev, found.st_ino) if stat.S_ISREG(found.st_mode) else None


def _still(files: dict[_File, str], file: _File) -> bool:
    """Whether a file is listed and still has its name; the system reuses numbers of files."""
    return file in files and _file(files[file]) == file


def _refused(target: str, source: str) -> UsageError:
    names = Path(target).name, Path(source).name
    also = "" if names[0] == names[1] else f" (as {source})"
    return UsageError(
        f"{target}: cannot write: this command reads this file{also}; choose another output name"
    )
