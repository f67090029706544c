"""Folders of limited size, from which files that were used longest ago are removed."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable, Iterator
from pathlib import Path


def drop_oldest(folder: Path, limit: int, is_ours: Callable[[str], bool], spared: str = "") -> None:
    """Removes the least recently used files until all fit.

    Other processes may remove files at the same time.

    Args:
        folder: The folder.
        limit: Size of all files, bytes.
        is_ours: Whether a file of that name counts, and may be removed.
        spared: Name of a file that stays, even if it alone exceeds the limit.
    """

    def entries() -> Iterator[tuple[float, int, str]]:
        with os.scandir(folder) as scan:
            for entry in scan:
                with contextlib.suppress(OSError):  # another process removed it
                    facts = entry.stat(follow_symlinks=False)
                    if is_ours(entry.name):
                        yield facts.st_mtime, facts.st_size, entry.name

    total = 0
    for _, size, name in sorted(entries(), reverse=True):
        total += size
        if total > limit and name != spared:
            with contextlib.suppress(OSError):
                (folder / name).unlink()
