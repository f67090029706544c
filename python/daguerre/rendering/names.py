"""File names of several pictures: ``shot.####.exr`` for frames, ``{camera}`` for cameras."""

from __future__ import annotations

import re
from pathlib import Path

from daguerre.files.numbered import PLACE, has_place, with_number

#: Placeholder of a camera's name in a file name.
CAMERA = "{camera}"


def has_frame(path: Path) -> bool:
    """Whether the name has a placeholder (#) for the frame number."""
    return has_place(path.name)


def numbered(path: Path, frame: int) -> Path:
    """Replaces # in ``shot.####.exr`` by the frame number, with at least as many digits."""
    return path.with_name(with_number(path.name, frame))


def named(path: Path, camera: str, *, several: bool) -> Path:
    """Replaces ``{camera}`` in a file name by the camera's name.

    Without ``{camera}``, names of several cameras go before the frame number, or to the end.
    """
    name = re.sub(r"[/\\\x00-\x1f\x7f]", "_", camera)
    name = "_" * len(name) if name in (".", "..") else name
    if CAMERA in str(path):
        return Path(str(path).replace(CAMERA, name))
    return _before_number(path, name) if several else path


def _before_number(path: Path, word: str) -> Path:
    """``shot.####.exr`` as ``shot.WORD.####.exr``; ``shot.exr`` as ``shot.WORD.exr``."""
    place = PLACE.search(path.name)
    cut = place.start() if place else len(path.stem)
    head, tail = path.name[:cut].rstrip("."), path.name[cut:].lstrip(".")
    return path.with_name(".".join(part for part in (head, word, tail) if part))
