"""Reads photographs in linear light: OpenEXR with standard attributes."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from daguerre.errors import InputError
from daguerre.pictures.exr.read import load_frame

from .display_file import alpha_notes
from .photograph import Photograph


def read_linear(path: Path) -> Photograph:
    """Reads a picture in linear light, Rec.709.

    Raises:
        InputError: The file cannot be read, has no colours, or a pixel is not finite.
    """
    frame = load_frame(path).without_overscan()
    bad = np.argwhere(~np.isfinite(frame.rgb).all(axis=2))
    if len(bad):
        y, x = bad[0]
        raise InputError(
            f"{path}: pixel ({x}, {y}): wanted finite light, got {frame.rgb[y, x].tolist()} "
            f"({len(bad)} such pixels)"
        )
    notes = alpha_notes(frame.alpha) if (frame.alpha != 1).any() else []
    notes += frame.metadata.get("notes", [])
    of_file = ("notes", "colorspace")
    facts = {
        name: value
        for name, value in frame.metadata.items()
        if value is not None and name not in of_file
    }
    return Photograph(path, "linear", frame.rgb, None, facts, tuple(notes))
