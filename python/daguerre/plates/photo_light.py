"""Reads the light of a photograph, for a scene onto which it is projected."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.camera.camera import Camera
from daguerre.color import srgb
from daguerre.files.notes import Notes

from .photograph import encoded
from .probe.exposures import exposures_of
from .probe.shots import CLIPPED, read_shot


def photo_light(
    path: str | Path, scale: float | None = None, taken: Camera | None = None
) -> tuple[NDArray[np.float32], list[str]]:
    """Reads a photograph as luminance.

    Args:
        path: JPEG, PNG, TIFF, raw file, ``.exr`` or ``.hdr``.
        scale: Luminance of a value of 1, cd/m2; None: from the exposure, 1 for linear files.
        taken: Camera with the exposure for values that EXIF lacks.

    Returns:
        Linear Rec.709, cd/m2, shape (H, W, 3), and notes on missing EXIF values and clipping.

    Raises:
        InputError: The file cannot be read.
    """
    notes = Notes()
    shot = read_shot(path, None, notes)
    if shot.coded:
        light = np.asarray(srgb.to_linear(encoded(shot.numbers)), np.float32)
    else:
        light = np.asarray(shot.numbers, np.float32)
    if shot.rgb is not None:
        light = light @ shot.rgb.T.astype(np.float32)
    shot = replace(shot, facts=_exposure(taken) | {k: v for k, v in shot.facts.items() if v})
    unit = exposures_of([shot], None, scale, notes, "--plate-scale").luminance[0]
    said = notes.sentences()
    if share := float((shot.top >= CLIPPED).mean()):
        said.append(f"{share:.2%} of the plate is clipped, so its lights are too dark")
    return np.ascontiguousarray(light * np.float32(unit)), said


def _exposure(taken: Camera | None) -> dict[str, Any]:
    """Exposure of a camera under the names of metadata."""
    if taken is None:
        return {}
    stop = taken.exposure_f_stop or taken.f_stop
    facts = {"expTime": taken.shutter_time, "aperture": stop, "isoSpeed": taken.iso}
    return {name: value for name, value in facts.items() if value}
