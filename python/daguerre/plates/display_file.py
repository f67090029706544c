"""Reads developed photographs (JPEG, PNG, TIFF, WebP) with OpenImageIO."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import InputError
from daguerre.pictures.images import read_file, upright
from daguerre.pictures.shot_blocks import read_tags

from .photograph import Photograph
from .shot_facts import exif_number, facts_and_notes, orientation

_WHOLE = (np.dtype(np.uint8), np.dtype(np.uint16))


def read_display(path: Path) -> Photograph:
    """Reads a developed photograph; colours are taken as sRGB.

    Raises:
        InputError: The file cannot be decoded, or its pixels are not integers.
    """
    pixels = read_file(path)
    if pixels.dtype not in _WHOLE:
        raise InputError(
            f"{path}: pixels: wanted 8 or 16 bits (linear light only as .exr), got {pixels.dtype}"
        )
    shot = read_tags(path)
    turn = orientation(shot)
    notes = turn_notes(turn)
    colors, more = colors_of(pixels, str(path))
    facts, told = facts_and_notes(shot, (pixels.shape[1], pixels.shape[0]))
    notes += told
    if exif_number(shot.exif.get("ColorSpace", shot.xmp.get("ColorSpace"))) == 65535:
        notes.append("colours: the file has another colour space; it is read as sRGB")
    return Photograph(
        path, "display", upright(colors, turn), None, turned(facts, turn), (*notes, *more)
    )


def colors_of(pixels: NDArray[Any], where: str) -> tuple[NDArray[Any], list[str]]:
    """Returns red, green and blue, (H, W, 3), from 1 to 4 channels, and a note on alpha."""
    count = pixels.shape[2]
    if not 1 <= count <= 4:
        raise InputError(f"{where}: channels: wanted grey or red, green and blue, got {count}")
    notes = alpha_notes(pixels[:, :, -1]) if count in (2, 4) else []
    if count < 3:
        return np.broadcast_to(pixels[:, :, :1], (*pixels.shape[:2], 3)), notes
    return pixels[:, :, :3], notes


def alpha_notes(alpha: NDArray[Any]) -> list[str]:
    """Returns a note that alpha is ignored, and how many pixels are not opaque."""
    top = np.iinfo(alpha.dtype).max if np.issubdtype(alpha.dtype, np.integer) else 1
    clear = int(np.count_nonzero(alpha < top))
    share = f"{clear} of {alpha.size} pixels are not opaque" if clear else "all pixels are opaque"
    return [f"alpha is ignored: {share}"]


def turn_notes(orientation: int) -> list[str]:
    """Returns a note if a photograph was turned upright."""
    return [] if orientation == 1 else [f"turned upright: EXIF orientation {orientation}"]


def turned(facts: dict[str, Any], orientation: int) -> dict[str, Any]:
    """Metadata of a turned photograph, with the sides of its sensor swapped if needed."""
    size = facts.get("sensorOverallDimensions")
    if orientation < 5 or size is None:
        return facts
    return facts | {"sensorOverallDimensions": (size[1], size[0])}
