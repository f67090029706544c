"""The light that a photograph shows, for a scene that it is thrown onto."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from daguerre.color import srgb
from daguerre.files.notes import Notes

from .photograph import encoded
from .probe.exposures import exposures_of
from .probe.shots import CLIPPED, read_shot


def photo_light(
    path: str | Path, scale: float | None = None
) -> tuple[NDArray[np.float32], list[str]]:
    """Reads a photograph as luminance.

    Args:
        path: JPEG, PNG, TIFF, raw file, ``.exr`` or ``.hdr``.
        scale: Luminance of a value of 1, cd/m2; None: by EXIF's exposure, 1 for linear files.

    Returns:
        Linear Rec.709, cd/m2, shape (H, W, 3), and remarks: what EXIF lacks, how much is clipped.

    Raises:
        InputError: It cannot be read.
    """
    notes = Notes()
    shot = read_shot(path, None, notes)
    if shot.coded:
        light = np.asarray(srgb.to_linear(encoded(shot.numbers)), np.float32)
    else:
        light = np.asarray(shot.numbers, np.float32)
    if shot.rgb is not None:
        light = light @ shot.rgb.T.astype(np.float32)
    unit = exposures_of([shot], None, scale, notes).luminance[0]
    said = notes.sentences()
    if share := float((shot.top >= CLIPPED).mean()):
        said.append(f"{share:.2%} of the plate is clipped: lights in it are darker than they were")
    return np.ascontiguousarray(light * np.float32(unit)), said
