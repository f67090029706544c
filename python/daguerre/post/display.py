"""Writes results of the darkroom as PNG for viewing."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Self

import numpy as np

from daguerre.frame.frame import Frame
from daguerre.pictures.exr.facts import read_facts
from daguerre.pictures.png import PngWriter

from .picture import Canvas, Image


class Display:
    """Writes a PNG row by row, in the picture's exposure mode, like ``Frame.save``."""

    def __init__(self, path: Path, canvas: Canvas, target: str | os.PathLike[str]) -> None:
        """Begins a file at ``path``; messages call it ``target``."""
        self._alpha, self._facts = canvas.alpha, read_facts(canvas.facts)
        self._writer = PngWriter(path, canvas.width, canvas.height, target=target)

    def write(self, image: Image) -> None:
        """Writes the next rows, shape (rows, W, C), without alpha."""
        colors = image[:, :, : image.shape[2] - self._alpha]
        rgb = np.broadcast_to(colors, (*colors.shape[:2], 3))
        self._writer.write(Frame(np.ascontiguousarray(rgb), metadata=self._facts).display())

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        if kind is None:
            self._writer.close()
