"""Pictures in memory: linear frames, raw mosaics, display pictures."""

from __future__ import annotations

from typing import TYPE_CHECKING

from daguerre.lazy_imports import lazy_attributes

if TYPE_CHECKING:
    from .frame import Frame
    from .picture import Picture
    from .raw import Raw

__all__ = ["Frame", "Picture", "Raw"]

if not TYPE_CHECKING:  # type checkers use the imports above, and report other names
    __getattr__, __dir__ = lazy_attributes(
        __name__,
        {
            "Frame": "frame",
            "Picture": "picture",
            "Raw": "raw",
        },
    )
