"""Files that texts include: limits of their number and bytes, so that a few lines end soon.

Each file may include several others, so a few small files can ask for a number without bounds.
"""

from __future__ import annotations

from pathlib import Path
from typing import NoReturn, Protocol

#: Limits of different files, of inclusions of files that were included before, and of their bytes,
#: unless the files themselves have more.
MAX_FILES = 100_000
MAX_AGAIN = 10_000
MAX_BYTES_AGAIN = 64 << 20


class Asker(Protocol):
    """Place in a file that asks for another."""

    def fail(self, message: str) -> NoReturn:
        """Raises an error at this place."""


class Includes:
    """Counts the files of a scene as they are included."""

    def __init__(self) -> None:
        self._once: set[Path] = set()
        self._bytes_once = 0
        self._again = 0
        self._bytes_again = 0

    def count(self, path: Path, size: int, asker: Asker) -> None:
        """Counts one file.

        Args:
            path: The file, without links.
            size: Size of the file, bytes.
            asker: Place that includes it.

        Raises:
            InputError: There are too many files or bytes.
        """
        if path not in self._once:
            self._once.add(path)
            self._bytes_once += size
            if len(self._once) > MAX_FILES:
                asker.fail(f"too many files: the limit is {MAX_FILES}")
            return
        self._again += 1
        self._bytes_again += size
        if self._again > MAX_AGAIN:
            asker.fail(f"too many files are included again: the limit is {MAX_AGAIN}")
        most = max(MAX_BYTES_AGAIN, self._bytes_once)
        if self._bytes_again > most:
            asker.fail(
                f"files that are included again: wanted at most {most} bytes in all, "
                f"got {self._bytes_again}"
            )
