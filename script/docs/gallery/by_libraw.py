#!/usr/bin/env python3
"""Develops a raw file by LibRaw alone, as other programs do: camera white balance, sRGB.

python script/docs/gallery/by_libraw.py IN.dng OUT.png
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import rawpy


def main() -> None:
    """Reads the command line, develops, writes 8 bits."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", 1)[0])
    parser.add_argument("raw", type=Path)
    parser.add_argument("output", type=Path)
    given = parser.parse_args()
    with rawpy.imread(str(given.raw)) as raw:
        pixels = raw.postprocess(
            use_camera_wb=True,
            output_color=rawpy.ColorSpace.sRGB,
            gamma=(2.4, 12.92),
            no_auto_bright=True,
            output_bps=8,
        )
    picture = oiio.ImageBuf(np.ascontiguousarray(pixels))
    if not picture.write(str(given.output)):
        raise SystemExit(picture.geterror())


if __name__ == "__main__":
    main()
