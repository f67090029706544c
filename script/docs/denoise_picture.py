"""The picture of docs/denoise.md: parts of the demo's picture as drawn, and denoised.

    script/demo
    python script/docs/denoise_picture.py -o docs/denoise.jpg

Rows: a tumbler, brass before lamps out of focus, cards on wood. Left as drawn, right denoised;
twice as large.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
from PIL import Image

from daguerre.frame.frame import Frame

ROOT = Path(__file__).resolve().parents[2]
PARTS = ((500, 205), (230, 180), (30, 330))
SIZE = 200, 120


def main() -> None:
    """Composes it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("-o", "--output", type=Path, required=True)
    given = parser.parse_args()
    linear = oiio.ImageBuf(str(ROOT / "out/demo.exr")).get_pixels(oiio.FLOAT)[:, :, :3]
    drawn = Frame(np.ascontiguousarray(linear)).display("soft")
    clean = oiio.ImageBuf(str(ROOT / "out/demo.png")).get_pixels(oiio.UINT8)[:, :, :3]
    width, height = SIZE
    rows = [
        np.hstack([picture[y : y + height, x : x + width] for picture in (drawn, clean)])
        for x, y in PARTS
    ]
    sheet = Image.fromarray(np.vstack(rows))
    large = sheet.resize((2 * sheet.width, 2 * sheet.height), Image.Resampling.NEAREST)
    large.save(given.output, quality=88)


if __name__ == "__main__":
    main()
