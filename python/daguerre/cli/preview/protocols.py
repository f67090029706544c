"""Bytes that draw a picture at the cursor, for each terminal protocol.

Sources: sw.kovidgoyal.net/kitty/graphics-protocol; iterm2.com/documentation-images.html;
VT330/VT340 Programmer Reference Manual, chapter 14.
"""

from __future__ import annotations

import struct
import zlib
from base64 import b64encode

import numpy as np
from numpy.typing import NDArray

from daguerre.pictures.png_chunks import encoded

from .terminal import Way

Pixels = NDArray[np.uint8]
#: Number of the picture for Kitty; sending it again replaces the picture.
NUMBER = 8128
#: Maximum size of a chunk for Kitty, bytes of base64.
PIECE = 4096
#: Steps of each colour for Sixel: 6 x 6 x 6 are a palette of 216.
STEPS = 6
#: Bayer's matrix, for dither.
BAYER = np.array([[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]])


def drawn(way: Way, pixels: Pixels, columns: int, rows: int) -> bytes:
    """Draws pixels (H, W, 3) over a number of cells from the cursor, which may move."""
    if way is Way.SIXEL:
        return sixel(pixels)
    data = b64encode(png(pixels))
    if way is Way.ITERM:
        size = f"width={columns};height={rows};preserveAspectRatio=1;size={len(data)}"
        return f"\x1b]1337;File=inline=1;{size}:".encode() + data + b"\x07"
    pieces = [data[i : i + PIECE] for i in range(0, len(data), PIECE)]
    keys = f"a=T,f=100,i={NUMBER},p=1,q=2,C=1,c={columns},r={rows},"
    return b"".join(
        f"\x1b_G{keys if i == 0 else ''}m={int(i + 1 < len(pieces))};".encode() + piece + b"\x1b\\"
        for i, piece in enumerate(pieces)
    )


def png(pixels: Pixels) -> bytes:
    """Encodes a PNG fast."""
    height, width = pixels.shape[:2]
    lines = np.zeros((height, 1 + 3 * width), np.uint8)  # each begins with the filter: none
    lines[:, 1:] = pixels.reshape(height, -1)
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    parts = ((b"IHDR", header), (b"IDAT", zlib.compress(lines.tobytes(), 1)), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(encoded(kind, data) for kind, data in parts)


def sixel(pixels: Pixels) -> bytes:
    """Encodes a picture in Sixel, dithered to a palette."""
    height, width = pixels.shape[:2]
    index = palette_index(pixels)
    out = [f'\x1bPq"1;1;{width};{height}'.encode()]
    for c in range(STEPS**3):
        share = [round(100 * (c // STEPS**k % STEPS) / (STEPS - 1)) for k in (2, 1, 0)]
        out.append("#{};2;{};{};{}".format(c, *share).encode())
    for top in range(0, height, 6):
        band = index[top : top + 6]
        lines = [b"#%d" % c + _run_lengths(_columns(band == c)) for c in np.unique(band)]
        out.append(b"$".join(lines) + b"-")
    return b"".join(out) + b"\x1b\\"


def palette_index(pixels: Pixels) -> NDArray[np.intp]:
    """Indices of the nearest palette colours, with dither, shape (H, W)."""
    height, width = pixels.shape[:2]
    tiles = np.tile((BAYER + 0.5) / 16, (height // 4 + 1, width // 4 + 1))[:height, :width, None]
    steps = np.floor(pixels / 255 * (STEPS - 1) + tiles).clip(0, STEPS - 1).astype(np.intp)
    return np.asarray(steps @ np.array([STEPS**2, STEPS, 1]))


def _columns(where: NDArray[np.bool_]) -> NDArray[np.uint8]:
    """Encodes six rows as one character a column: bit k is row k."""
    bits = (where * (1 << np.arange(len(where)))[:, None]).sum(0)
    return np.asarray(bits + 63, np.uint8)


def _run_lengths(characters: NDArray[np.uint8]) -> bytes:
    """Encodes repeats as ``!count character``, and drops empty characters at the end."""
    starts = np.flatnonzero(np.diff(characters, prepend=-1))
    counts = np.diff(starts, append=len(characters))
    runs = list(zip(characters[starts].tolist(), counts.tolist(), strict=True))
    if runs and runs[-1][0] == 63:
        runs.pop()
    return b"".join(
        b"!%d%c" % (count, character) if count > 3 else bytes([character]) * count
        for character, count in runs
    )
