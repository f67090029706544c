"""Reads raw photographs: unprocessed values of the mosaic."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.development import libraw
from daguerre.development.camera_raw import tags_of, white_of_shot
from daguerre.development.libraw import RawFile
from daguerre.errors import InputError
from daguerre.pictures.images import upright
from daguerre.pictures.shot_blocks import read_tags

from .display_file import turn_notes, turned
from .photograph import Photograph, RawNumbers
from .shot_facts import facts_and_notes, shot_facts

#: EXIF orientation by LibRaw's flip.
_TURNS = {0: 1, 3: 3, 5: 8, 6: 6}


def read_raw(path: Path) -> Photograph:
    """Reads a raw file: DNG or a camera's format.

    Raises:
        InputError: LibRaw cannot read the file, or it has no mosaic.
    """
    tags = tags_of(path)
    file = libraw.read(path, "mosaic")
    turn = _TURNS.get(file.flip, 1)
    raw = _numbers(path, file, tags, turn)
    facts, notes = raw_facts(path, file)
    notes = [*turn_notes(turn), *notes]
    return Photograph(path, "raw", None, raw, turned(facts, turn), tuple(notes))


def _numbers(path: Path, file: RawFile, tags: Mapping[str, Any], turn: int) -> RawNumbers:
    if file.mosaic is None or file.colors not in (1, 3):
        raise InputError(
            f"{path}: mosaic: wanted a mosaic of red, green and blue, or grey; got "
            f"{file.colors} colours without a mosaic"
        )
    grey = file.colors == 1
    channels = ("Y",) if grey else ("R", "G", "B")
    letters = "YYYYYYY" if grey else file.letters
    height, width = file.mosaic.shape
    cells = np.zeros(file.cells.shape, np.uint8)
    black = np.zeros(len(channels))
    for at, level in enumerate(file.black):
        if not grey and letters[at] not in channels:
            raise InputError(f"{path}: mosaic: wanted red, green and blue, got {letters[at]}")
        index = 0 if grey else channels.index(letters[at])
        cells[file.cells == at] = index
        black[index] = level
    rows, columns = np.arange(height) % libraw.PERIOD, np.arange(width) % libraw.PERIOD
    all_cells = cells[np.ix_(rows, columns)]
    return RawNumbers(
        mosaic=np.array(upright(file.mosaic, turn), np.uint16, order="C"),
        cells=shortest(upright(all_cells, turn)[: libraw.PERIOD, : libraw.PERIOD]),
        channels=channels,
        black=black,
        white=int(file.white),
        white_balance=white_of_shot(path, file, tags),
    )


def shortest(cells: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Finds the smallest square cell that repeats."""
    for side in (1, 2, 4, 6):
        tiled = np.tile(cells[:side, :side], (libraw.PERIOD // side, libraw.PERIOD // side))
        if np.array_equal(tiled[: cells.shape[0], : cells.shape[1]], cells):
            return np.ascontiguousarray(cells[:side, :side])
    return cells


def raw_facts(path: Path, file: RawFile) -> tuple[dict[str, Any], list[str]]:
    """Returns metadata of a raw file as stored, by OpenEXR's names, and notes.

    LibRaw gives values of files without EXIF that can be read, such as CR3.

    Args:
        path: The file.
        file: The same, as LibRaw reads it.
    """
    height, width = file.size
    facts, notes = facts_and_notes(read_tags(path), (width, height))
    return shot_facts(file.facts, (width, height)) | facts, notes
