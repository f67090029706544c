"""Pictures in memory: linear frames, raw mosaics, display pictures."""

from __future__ import annotations

from .frame import Frame
from .picture import Picture
from .raw import Raw

__all__ = ["Frame", "Picture", "Raw"]
