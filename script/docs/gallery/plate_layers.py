#!/usr/bin/env python3
"""Shows a layer of a render for a plate: objects over squares, or what catchers caught.

python script/docs/gallery/plate_layers.py objects|catcher IN.exr OUT.png [TIMES]

Catchers are around middle grey: darker is light that objects take away, lighter is light that they
add, TIMES what it is.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
from numpy.typing import NDArray

import daguerre as dg
from daguerre.color import srgb
from daguerre.plates.composite.composite import white_of

Floats = NDArray[np.float32]
SQUARE = 25  # px
GREYS = 0.16, 0.30  # of the squares, linear
MIDDLE = 0.5  # display


def main() -> None:
    """Reads the command line, draws, writes 8 bits."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", 1)[0])
    parser.add_argument("layer", choices=["objects", "catcher"])
    parser.add_argument("render", type=Path)
    parser.add_argument("output", type=Path)
    parser.add_argument("times", type=float, nargs="?", default=1.0)
    given = parser.parse_args()
    frame = dg.load_frame(given.render)
    if given.layer == "objects":
        write(given.output, over_squares(frame))
    else:
        write(given.output, around_grey(frame, given.times))


def over_squares(frame: dg.Frame) -> Floats:
    """The objects alone, exposed as a photograph, display values."""
    row, column = np.indices((frame.height, frame.width)) // SQUARE
    squares = np.where((row + column) % 2, *GREYS).astype(np.float32)[..., None]
    left = 1 - np.asarray(frame.alpha)[..., None]
    return dg.Frame(frame.rgb / np.float32(white_of(frame)) + left * squares).encoded("soft")


def around_grey(frame: dg.Frame, times: float) -> Floats:
    """The change of light by objects, in shares of the white of a photograph, display values."""
    if frame.catcher is None:
        raise SystemExit("wanted a render with catchers, got one without")
    middle = srgb.to_linear(np.float32(MIDDLE))
    change = frame.catcher * np.float32(times / white_of(frame))
    return np.asarray(srgb.from_linear(np.clip(middle + change, 0, 1)), np.float32)


def write(path: Path, shown: Floats) -> None:
    """Writes display values, 0 to 1."""
    pixels = np.rint(np.clip(shown, 0, 1) * 255).astype(np.uint8)
    picture = oiio.ImageBuf(np.ascontiguousarray(pixels))
    if not picture.write(str(path)):
        raise SystemExit(picture.geterror())


if __name__ == "__main__":
    main()
