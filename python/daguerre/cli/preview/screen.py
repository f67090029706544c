"""In-place display in a terminal: a picture, messages below it, and a line of progress."""

from __future__ import annotations

import fcntl
import os
import struct
import termios
import time
from dataclasses import dataclass
from typing import TextIO

import numpy as np

from daguerre.cli import console
from daguerre.cli.progress import Silent, describe
from daguerre.rendering.progress import AnyStatus

from .protocols import Pixels, drawn
from .terminal import Way

#: Size of a cell, px, if the terminal does not report it.
CELL = 8, 16
#: Rows that a picture leaves free.
FREE = 3
#: Time between two lines of progress, s.
PERIOD_S = 0.2


@dataclass(frozen=True)
class Cells:
    """Size of a terminal: columns, rows, and size of a cell, px."""

    columns: int
    rows: int
    width: float
    height: float

    @classmethod
    def of(cls, out: TextIO) -> Cells:
        """Reads the present size of the terminal."""
        asked = fcntl.ioctl(out.fileno(), termios.TIOCGWINSZ, b"\0" * 8)
        rows, columns, width, height = struct.unpack("HHHH", asked)
        columns, rows = columns or 80, rows or 24
        if not (width and height):
            return cls(columns, rows, *CELL)
        return cls(columns, rows, width / columns, height / rows)

    def box(self, width: int, height: int) -> tuple[int, int]:
        """Columns and rows for a picture of this size, px: in full size if that fits."""
        wide, high = (self.columns - 1) * self.width, (self.rows - FREE) * self.height
        scale = min(1.0, wide / width, high / height)
        columns, rows = width * scale / self.width, height * scale / self.height
        return max(round(columns), 1), max(int(rows), 1)


class Screen(Silent):
    """Draws in place on a terminal."""

    def __init__(self, way: Way, out: TextIO) -> None:
        self._way, self._out = way, out
        self.which = ""  # picture, where there are several
        self._rows = self._below = 0  # of the picture, and of lines below it
        self._next = 0.0

    def picture(self, pixels: Pixels) -> None:
        """Draws the picture in place of the last picture, or below the present text."""
        cells = Cells.of(self._out)
        height, width = pixels.shape[:2]
        columns, rows = cells.box(width, height)
        if rows != self._rows or rows + self._below > cells.rows - 2:
            self._write(b"\r\x1b[K" + b"\n" * rows)
            self._rows, self._below = rows, 0
        size = min(width, round(columns * cells.width)), min(height, round(rows * cells.height))
        image = drawn(self._way, resized(pixels, *size), columns, rows)
        up = b"%d" % (self._rows + self._below)
        self._write(b"\r\x1b[" + up + b"A\x1b7" + image + b"\x1b8\x1b[" + up + b"B")

    def update(self, status: AnyStatus) -> None:
        """Writes the line of progress."""
        if time.monotonic() < self._next:
            return
        self._next = time.monotonic() + PERIOD_S
        text = f"{self.which}{describe(status)}"[: Cells.of(self._out).columns - 1]
        self._write(b"\r" + text.encode() + b"\x1b[K")

    def say(self, line: str) -> None:
        """Writes a permanent line."""
        self._write(b"\r\x1b[K" + line.encode() + b"\n")
        self._below += 1 + max(len(line) - 1, 0) // Cells.of(self._out).columns

    def start(self) -> None:
        """Starts to print messages below the picture."""
        console.writer = self.say

    def stop(self) -> None:
        """Removes the line of progress."""
        self._write(b"\r\x1b[K")

    def _write(self, data: bytes) -> None:
        self._out.flush()
        try:
            while data:
                data = data[os.write(self._out.fileno(), data) :]
        except OSError:  # the terminal has gone; the picture is still wanted
            console.nobody_reads(self._out)


def resized(pixels: Pixels, width: int, height: int) -> Pixels:
    """Reduces a picture to fewer pixels."""
    import OpenImageIO as oiio

    if (height, width) == pixels.shape[:2]:
        return pixels
    roi = oiio.ROI(0, width, 0, height, 0, 1, 0, 3)
    small = oiio.ImageBufAlgo.resize(oiio.ImageBuf(pixels), roi=roi)
    return np.asarray(small.get_pixels(oiio.UINT8), np.uint8).reshape(height, width, 3)
