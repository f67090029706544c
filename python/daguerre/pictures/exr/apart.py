"""Unpacks pictures of other compressions in a separate process.

Libraries that decode PIZ, PXR24, B44, DWA, HTJ2K and RLE have crashed on damaged files. Here only
another process crashes: :mod:`daguerre.pictures.decoder` has it write plain pixels into a temporary
file, which is then read with the same checks as any other file.
"""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

from daguerre.errors import InputError
from daguerre.pictures import decoder

from .layout import COMPRESSIONS, Layout

#: Time limit: seconds for any picture, and bytes per second in addition.
PATIENCE, PACE = 8.0, 50e6


def plain_copy(layout: Layout, folder: TemporaryDirectory[str]) -> Path:
    """Writes the first part of a file into a folder, with plain pixels.

    Raises:
        InputError: The file cannot be decoded, or the process failed, crashed or took too long.
    """
    kind = COMPRESSIONS[layout.compression][0]
    if layout.index != 0:
        raise InputError(
            f"{layout.path}: part {layout.index}: wanted pixels that are plain or deflated (NONE, "
            f"ZIPS, ZIP), got {kind}"
        )
    target = Path(folder.name) / "plain.exr"
    wanted = decoder.Wanted("openexr", target, layout.size, PATIENCE + layout.size / PACE)
    decoder.run(layout.path, wanted, str(layout.path), f"{kind} pixels")
    return target
