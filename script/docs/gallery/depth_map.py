#!/usr/bin/env python3
"""Shows the depth of a picture in colours, near red and far blue, over a scale in metres.

python script/docs/gallery/depth_map.py IN.exr OUT.png [NEAR FAR]    (default: its own range)

The picture needs `--aov depth`, sharp with `--gt-time mid`; matplotlib comes with the extra `plot`.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

import daguerre as dg

STRIP = 40  # px, below the picture


def main() -> None:
    """Reads the command line, colours, writes 8 bits."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", 1)[0])
    parser.add_argument("picture", type=Path)
    parser.add_argument("output", type=Path)
    parser.add_argument("range", type=float, nargs="*", metavar="M")
    given = parser.parse_args()
    frame = dg.load_frame(given.picture)
    if "depth.Z" not in frame.aovs:
        raise SystemExit(f"{given.picture}: wanted the channel depth.Z (--aov depth), got none")
    depth = np.where(frame.aovs["depth.Z"] > 0, frame.aovs["depth.Z"], np.nan)  # 0: nothing is seen
    near, far = given.range or (float(np.nanmin(depth)), float(np.nanmax(depth)))
    matplotlib.rcParams["font.family"] = "DejaVu Sans"
    _draw(depth, near, far).savefig(given.output)


def _draw(
    depth: np.ndarray[tuple[int, ...], np.dtype[np.float64]], near: float, far: float
) -> Figure:
    """A pixel of the picture for each of the depth, and the strip."""
    high, wide = depth.shape
    figure = Figure(figsize=(wide / 100, (high + STRIP) / 100), dpi=100, facecolor="white")
    FigureCanvasAgg(figure)
    scale = Normalize(near, far)
    colours = matplotlib.colormaps["turbo_r"].with_extremes(bad="black")
    figure.figimage(colours(scale(np.ma.masked_invalid(depth))), 0, STRIP)
    bar = figure.add_axes((0.05, 26 / (high + STRIP), 0.90, 10 / (high + STRIP)))
    figure.colorbar(ScalarMappable(scale, colours), bar, orientation="horizontal")
    bar.tick_params(labelsize=8, length=3, pad=2)
    bar.text(1.01, 0.5, "m", transform=bar.transAxes, fontsize=8, va="center")
    return figure


if __name__ == "__main__":
    main()
