"""Computes rows of an STMap from displacements, and writes STMaps block by block."""

from __future__ import annotations

import os
from collections.abc import Mapping

import numpy as np

from daguerre.convolution.rows import Rows
from daguerre.files.atomic import atomic_path
from daguerre.pictures.exr.header import new_header
from daguerre.pictures.exr.rows import ExrWriter

from .picture import Canvas, Image
from .tiles import BLOCK
from .warp import Warp


def st_rows(warp: Warp, canvas: Canvas, rows: Rows) -> Image:
    """Returns s and t of rows, shape (rows, W, 2)."""
    moved = warp.core.displacements(canvas.width, *rows).astype(np.float64)
    width, height = canvas.full_size
    s = (moved[:, :, 0] + np.arange(canvas.width) + canvas.corner[0] + 0.5) / width
    row = np.arange(rows.begin, rows.end) + canvas.corner[1] + 0.5
    t = 1 - (moved[:, :, 1] + row[:, None]) / height
    return np.stack([s, t], axis=2).astype(np.float32)


def write_stmap(
    path: str | os.PathLike[str],
    warp: Warp,
    canvas: Canvas,
    attributes: Mapping[str, str] = {},
) -> None:
    """Writes the STMap of a picture, in bands, atomically: R is s, G is t.

    B is 1 where the map is defined, else 0, as in UV passes of renderers.

    Args:
        path: Path of an .exr.
        warp: Map to write.
        canvas: Facts about the picture, for its windows.
        attributes: Attributes of the file.

    Raises:
        OutputError: The file cannot be written.
    """
    header = new_header(
        ("B", "G", "R"), canvas.corner, (canvas.width, canvas.height), canvas.full_size
    )
    with atomic_path(path) as temp, ExrWriter(temp, header, attributes) as writer:
        for begin in range(0, canvas.height, BLOCK):
            rows = Rows(begin, min(begin + BLOCK, canvas.height))
            st = st_rows(warp, canvas, rows)
            there = np.asarray(np.isfinite(st[:, :, 0]) & np.isfinite(st[:, :, 1]), np.float32)
            writer.write({"R": st[:, :, 0], "G": st[:, :, 1], "B": there})
