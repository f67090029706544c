"""Records which files are read, and as what, to find those that change later."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager

from . import uses

#: Inode, time (ns) and size (bytes) of a file; None: there is no such file.
Stamp = tuple[int, int, int] | None


@contextmanager
def recorded() -> Iterator[dict[str, Stamp]]:
    """Records all files that this process opens meanwhile, from any thread.

    Returns:
        Stamp of each file before it was first read, by absolute name, also of missing files.
    """
    found: dict[str, Stamp] = {}

    def hear(use: str | int) -> None:
        if isinstance(use, str):
            name = os.path.abspath(use)  # noqa: PTH100
            found.setdefault(name, stamp(name))

    with uses.heard_by(hear):
        yield found


def changed(files: Mapping[str, Stamp]) -> list[str]:
    """Names of files whose stamps differ now; missing files do not count, as they may come back."""
    now = ((name, before, stamp(name)) for name, before in files.items())
    return [name for name, before, after in now if after not in (before, None)]


def stamp(name: str) -> Stamp:
    """Stamp of a file, links followed."""
    try:
        facts = os.stat(name)  # noqa: PTH116
    except (OSError, ValueError):  # ValueError: a name with a zero byte
        return None
    return facts.st_ino, facts.st_mtime_ns, facts.st_size
