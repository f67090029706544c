#!/usr/bin/env python3
"""Composes the pictures of an imperfection into one sheet.

    python script/docs/gallery/sheet.py NAME OUT.png

Reads the OpenEXR pictures that the commands of docs/gallery/imperfections.md write.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray
from ways import OUT, Panel, Word
from words import WORDS

import daguerre as dg

Floats = NDArray[np.float32]
Box = tuple[int, int, int, int]
STRIP = 26  # px, for the caption
GAP = 6  # px between panels
INK, PAPER = 40, 255


def main() -> None:
    """Writes the sheet of one word."""
    parser = argparse.ArgumentParser(description="Composes the pictures of an imperfection.")
    words = {word.name: word for word in WORDS}
    parser.add_argument("name", choices=words)
    parser.add_argument("output", type=Path)
    given = parser.parse_args()
    write(compose(words[given.name], Path(OUT)), given.output)


def write(pixels: NDArray[np.uint8], file: Path, quality: int = 90) -> None:
    """Writes a picture; the quality counts for a JPEG."""
    picture = oiio.ImageBuf(np.ascontiguousarray(pixels))
    picture.specmod().attribute("Compression", f"jpeg:{quality}")
    if not picture.write(str(file)):
        raise SystemExit(picture.geterror())


def read(file: Path, layer: str = "") -> tuple[dict[str, Floats], Box]:
    """Channels of an .exr by name, and its data window (x, y, width, height)."""
    picture = oiio.ImageBuf(str(file))
    if picture.has_error:
        raise SystemExit(f"{file}: {picture.geterror()}")
    spec = picture.spec()
    pixels = picture.get_pixels(oiio.FLOAT)
    planes = {name: pixels[:, :, k] for k, name in enumerate(spec.channelnames)}
    return planes, (spec.x, spec.y, spec.width, spec.height)


def colours(planes: dict[str, Floats], layer: str = "") -> Floats:
    """R, G and B of a layer, shape (H, W, 3)."""
    prefix = f"{layer}." if layer else ""
    return np.stack([planes[f"{prefix}{c}"] for c in "RGB"], axis=2)


def cut(image: Floats, have: Box, want: Box) -> Floats:
    """The part of a picture that another one shows."""
    left, top = want[0] - have[0], want[1] - have[1]
    part = image[max(top, 0) : top + want[3], max(left, 0) : left + want[2]]
    if part.shape[:2] != (want[3], want[2]):
        raise SystemExit(f"sheet: wanted pixels {want}, the picture has {have} (x, y, w, h)")
    return part


def compose(word: Word, folder: Path) -> NDArray[np.uint8]:
    """The sheet of a word."""
    rows = []
    for row in word.rows:
        window = _window(row, folder)
        rows.append([_panel(p, folder, window, word.exposure) for p in row])
    return grid(rows)


def grid(rows: list[list[NDArray[np.uint8]]]) -> NDArray[np.uint8]:
    """Rows of panels as one picture."""
    lines = [_beside(row) for row in rows]
    wide = max(line.shape[1] for line in lines)
    return np.concatenate([_padded(line, wide) for line in lines])


def captioned(pixels: NDArray[np.uint8], caption: str) -> NDArray[np.uint8]:
    """A picture under its caption."""
    return np.concatenate([written(caption, pixels.shape[1], STRIP), pixels])


def _window(row: tuple[Panel, ...], folder: Path) -> Box:
    """That of the first picture of a row."""
    first = next(panel for panel in row if panel.file)
    return read(folder / f"{first.file}.exr")[1]


def _panel(panel: Panel, folder: Path, window: Box, exposure: float) -> NDArray[np.uint8]:
    """A picture under its caption."""
    if panel.none:
        shown = written(panel.none, window[2], window[3], 235)
    else:
        planes, have = read(folder / f"{panel.file}.exr")
        image = cut(colours(planes, panel.layer), have, window)
        shown = dg.Frame(np.ascontiguousarray(exposure * image)).display("soft")
    return captioned(shown, panel.caption)


def _beside(panels: list[NDArray[np.uint8]]) -> NDArray[np.uint8]:
    """Panels from left to right with paper between them, and below."""
    gap = np.full((panels[0].shape[0], GAP, 3), PAPER, np.uint8)
    parts = [part for panel in panels for part in (panel, gap)][:-1]
    row = np.concatenate(parts, axis=1)
    return np.concatenate([row, np.full((GAP, row.shape[1], 3), PAPER, np.uint8)])


def _padded(row: NDArray[np.uint8], wide: int) -> NDArray[np.uint8]:
    missing = np.full((row.shape[0], wide - row.shape[1], 3), PAPER, np.uint8)
    return np.concatenate([row, missing], axis=1)


def written(text: str, wide: int, high: int, paper: int = PAPER) -> NDArray[np.uint8]:
    """Words on paper, in its middle."""
    figure = Figure(figsize=(wide / 100, high / 100), dpi=100, facecolor=str(paper / 255))
    canvas = FigureCanvasAgg(figure)
    shade = str(INK / 255)
    figure.text(
        0.5, 0.5, text, family="DejaVu Sans", fontsize=11, color=shade, ha="center", va="center"
    )
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[:, :, :3].copy()


if __name__ == "__main__":
    main()
