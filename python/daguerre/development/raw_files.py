"""Raw pictures into files, as the table of formats calls for them."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from daguerre.errors import UsageError
from daguerre.frame.raw import Raw

from .develop import develop
from .dng import write_dng


def as_dng(path: str | os.PathLike[str], raw: Raw, **look: Any) -> None:
    """The numbers as they are.

    Raises:
        UsageError: A look was asked for.
    """
    if look:
        raise UsageError(f"{Path(path)}: a DNG is not developed: {', '.join(look)} has no place")
    write_dng(path, raw)


def as_picture(path: str | os.PathLike[str], raw: Raw, **look: Any) -> None:
    """A developed picture; ``quality`` and ``bits`` are of the file."""
    files = {name: look.pop(name) for name in ("quality", "bits") if name in look}
    develop(raw, **look).save(path, **files)
