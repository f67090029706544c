"""Store of a worker: packed values by their hash, in a folder of limited size."""

from __future__ import annotations

import mmap
import os
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from daguerre.errors import InputError, OutputError
from daguerre.files.atomic import write_bytes
from daguerre.files.limited_folder import drop_oldest
from daguerre.files.packing import hash_of, large_of, unpack

#: Environment variable with the folder; default: a folder in the system's temporary folder.
FOLDER = "DAGUERRE_CLUSTER_CACHE"
#: Size at which the values used longest ago are removed, bytes.
LIMIT = 8 << 30
_ENDING = ".packed"


class Store:
    """Packed values in a folder, by their hash.

    Args:
        folder: The folder; None: the folder of the environment variable.
        limit: Most bytes in the folder; the newest value may exceed it.
    """

    def __init__(self, folder: Path | None = None, limit: int = LIMIT) -> None:
        named = os.environ.get(FOLDER)
        self.folder = folder or (_private(Path(named)) if named else _own_folder())
        self.limit = limit

    def lacks(self, names: Iterable[str]) -> list[str]:
        """Names of packed values, or of their large arrays, that are not here."""
        wanted = {name: self._path(name).is_file() for name in names}
        for name in [name for name, is_here in wanted.items() if is_here]:
            wanted |= {
                one: self._path(one).is_file() for one in large_of(self.get(name).readline())
            }
        return [name for name, is_here in wanted.items() if not is_here]

    def value(self, name: str) -> Any:
        """Unpacks a value."""
        return unpack(self.get(name)[:], self.get)

    def put(self, name: str, data: bytes) -> None:
        """Keeps a value.

        Raises:
            InputError: The data have another hash.
            OutputError: They cannot be written.
        """
        got = hash_of(data)
        if got != name:
            raise InputError(f"cluster: wanted a value of hash {name[:12]}, got {got[:12]}")
        try:
            self.folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            write_bytes(self._path(name), data)
            drop_oldest(self.folder, self.limit, _is_value, self._path(name).name)
        except OSError as error:
            raise OutputError(f"{self.folder}: cannot write: {error.strerror or error}") from error

    def get(self, name: str) -> Any:
        """Returns the bytes of a name, without reading them.

        Raises:
            InputError: There are none.
        """
        path = self._path(name)
        try:
            os.utime(path)
            with path.open("rb") as file:
                return mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
        except (OSError, ValueError) as error:
            reason = getattr(error, "strerror", None) or error
            raise InputError(f"{path}: cannot read: {reason}") from error

    def _path(self, name: str) -> Path:
        return self.folder / f"{name}{_ENDING}"


def _is_value(name: str) -> bool:
    """Whether a file of the folder has a packed value."""
    return name.endswith(_ENDING)


def _own_folder() -> Path:
    """Folder of this user among temporary files, in which nobody else can plant values.

    Raises:
        OutputError: A folder of this name belongs to another user.
    """
    if not hasattr(os, "getuid"):  # Windows: temporary files are the user's own
        return Path(tempfile.gettempdir()) / "daguerre-cluster"
    return _private(Path(tempfile.gettempdir()) / f"daguerre-cluster-{os.getuid()}", link=False)


def _private(folder: Path, *, link: bool = True) -> Path:
    """Makes a folder unless it is there, and checks that nobody else can write to it.

    Args:
        folder: The folder.
        link: Whether it may be a link to a folder.

    Raises:
        OutputError: It is of another user, or others can write to it.
    """
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        facts = folder.stat() if link else folder.lstat()
    except OSError as error:
        raise OutputError(f"{folder}: cannot write: {error.strerror or error}") from error
    user = os.getuid() if hasattr(os, "getuid") else facts.st_uid
    if facts.st_uid != user or facts.st_mode & 0o022:
        raise OutputError(
            f"{folder}: wanted a folder to which only this user can write; set {FOLDER} to "
            "another one"
        )
    return folder
