"""Reads raw photographs with LibRaw: unprocessed values of the mosaic."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.development.camera_raw import is_flat, opened_raw, tags_of, white_of_shot
from daguerre.errors import InputError
from daguerre.io.images import upright
from daguerre.io.shot_blocks import read_tags

from .display_file import turn_notes, turned
from .photograph import Photograph, RawNumbers
from .shot_facts import facts_and_notes, shot_facts

#: EXIF orientation by LibRaw's flip.
_TURNS = {0: 1, 3: 3, 5: 8, 6: 6}
#: Common period of all known mosaics, photosites.
_PERIOD = 12


def read_raw(path: Path) -> Photograph:
    """Reads a raw file: DNG or a camera's format.

    Raises:
        InputError: LibRaw cannot read the file, or it has no mosaic.
    """
    tags = tags_of(path)
    with opened_raw(path) as opened:
        turn = _TURNS.get(int(opened.sizes.flip), 1)
        raw = _numbers(path, opened, tags, turn)
        facts, notes = raw_facts(path, opened)
    notes = [*turn_notes(turn), *notes]
    return Photograph(path, "raw", None, raw, turned(facts, turn), tuple(notes))


def _numbers(path: Path, opened: Any, tags: Mapping[str, Any], turn: int) -> RawNumbers:
    if not is_flat(opened) or opened.num_colors not in (1, 3):
        raise InputError(
            f"{path}: mosaic: wanted a mosaic of red, green and blue, or grey; got "
            f"{opened.num_colors} colours without a mosaic"
        )
    grey = opened.num_colors == 1
    channels = ("Y",) if grey else ("R", "G", "B")
    letters = "YYYYYYY" if grey else opened.color_desc.decode("ascii", "replace")
    numbers = opened.raw_colors_visible[:_PERIOD, :_PERIOD]
    height, width = opened.raw_image_visible.shape
    cells = np.zeros(numbers.shape, np.uint8)
    black = np.zeros(len(channels))
    for at, level in enumerate(opened.black_level_per_channel):
        if not grey and letters[at] not in channels:
            raise InputError(f"{path}: mosaic: wanted red, green and blue, got {letters[at]}")
        index = 0 if grey else channels.index(letters[at])
        cells[numbers == at] = index
        black[index] = level
    all_cells = cells[np.ix_(np.arange(height) % _PERIOD, np.arange(width) % _PERIOD)]
    return RawNumbers(
        # A copy: LibRaw frees its own values when the file is closed.
        mosaic=np.array(upright(opened.raw_image_visible, turn), np.uint16, order="C"),
        cells=shortest(upright(all_cells, turn)[:_PERIOD, :_PERIOD]),
        channels=channels,
        black=black,
        white=int(opened.white_level),
        white_balance=white_of_shot(path, opened, tags),
    )


def shortest(cells: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Finds the smallest square cell that repeats."""
    for side in (1, 2, 4, 6):
        tiled = np.tile(cells[:side, :side], (_PERIOD // side, _PERIOD // side))
        if np.array_equal(tiled[: cells.shape[0], : cells.shape[1]], cells):
            return np.ascontiguousarray(cells[:side, :side])
    return cells


def raw_facts(path: Path, opened: Any) -> tuple[dict[str, Any], list[str]]:
    """Returns metadata of a raw file as stored, by OpenEXR's names, and notes.

    LibRaw gives values of files without EXIF that can be read, such as CR3.

    Args:
        path: The file.
        opened: The same, opened by rawpy.
    """
    height, width = opened.raw_image_visible.shape
    facts, notes = facts_and_notes(read_tags(path), (width, height))
    other, lens = getattr(opened, "other", None), getattr(opened, "lens", None)
    more = {
        "PhotographicSensitivity": getattr(other, "iso_speed", None),
        "ExposureTime": getattr(other, "shutter_speed", None),
        "FNumber": getattr(other, "aperture", None),
        "FocalLength": getattr(other, "focal_length", None),
        "LensModel": getattr(lens, "model", None),
        "LensMake": getattr(lens, "make", None),
    }
    return shot_facts(more, (width, height)) | facts, notes
