"""Developed photographs: JPEG, PNG, TIFF and WebP, decoded by OpenImageIO."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import InputError
from daguerre.io.images import read_file, upright

from .photograph import Photograph
from .shot_facts import exif_number, shot_facts

_WHOLE = (np.dtype(np.uint8), np.dtype(np.uint16))


def read_display(path: Path) -> Photograph:
    """Reads a developed photograph; colours are taken for sRGB.

    Raises:
        InputError: It cannot be decoded, or is no picture of whole numbers.
    """
    pixels, spec = read_file(path)
    if pixels.dtype not in _WHOLE:
        raise InputError(
            f"{path}: pixels: wanted 8 or 16 bits, or linear light as .exr; got {pixels.dtype}"
        )
    tags = {str(a.name).rpartition(":")[2]: a.value for a in spec.extra_attribs}
    turn = int(exif_number(tags.get("Orientation")) or 1)
    notes = turn_notes(turn)
    colors, more = colors_of(pixels, str(path))
    facts = shot_facts(tags, (pixels.shape[1], pixels.shape[0]))
    if exif_number(tags.get("ColorSpace")) == 65535:
        notes.append("colours: the file says that they are not sRGB's; taken for sRGB")
    return Photograph(
        path, "display", upright(colors, turn), None, turned(facts, turn), (*notes, *more)
    )


def colors_of(pixels: NDArray[Any], where: str) -> tuple[NDArray[Any], list[str]]:
    """Red, green and blue, (H, W, 3), of 1 to 4 channels, and what became of alpha."""
    count = pixels.shape[2]
    if not 1 <= count <= 4:
        raise InputError(f"{where}: channels: wanted grey or red, green and blue, got {count}")
    notes = alpha_notes(pixels[:, :, -1]) if count in (2, 4) else []
    if count < 3:
        return np.broadcast_to(pixels[:, :, :1], (*pixels.shape[:2], 3)), notes
    return pixels[:, :, :3], notes


def alpha_notes(alpha: NDArray[Any]) -> list[str]:
    """Tells that alpha was left out: what is not opaque is no part of the scene."""
    top = np.iinfo(alpha.dtype).max if np.issubdtype(alpha.dtype, np.integer) else 1
    clear = int(np.count_nonzero(alpha < top))
    share = f"{clear} of {alpha.size} pixels are not opaque" if clear else "all pixels are opaque"
    return [f"alpha was left out: {share}"]


def turn_notes(orientation: int) -> list[str]:
    """Tells that a photograph did not lie upright in its file."""
    return [] if orientation == 1 else [f"turned upright: EXIF orientation {orientation}"]


def turned(facts: dict[str, Any], orientation: int) -> dict[str, Any]:
    """Facts of a photograph that was turned: the sides of its sensor change places."""
    size = facts.get("sensorOverallDimensions")
    if orientation < 5 or size is None:
        return facts
    return facts | {"sensorOverallDimensions": (size[1], size[0])}
