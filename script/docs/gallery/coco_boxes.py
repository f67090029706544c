#!/usr/bin/env python3
"""Draws the boxes and masks of a COCO file over one of its pictures.

python script/docs/gallery/coco_boxes.py COCO.json PICTURE OUT.png

matplotlib comes with the extra `plot`.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
import OpenImageIO as oiio
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from numpy.typing import NDArray

NARROW = 20  # px; names of narrower things would cover each other


def main() -> None:
    """Reads the command line, draws, writes 8 bits."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", 1)[0])
    parser.add_argument("coco", type=Path)
    parser.add_argument("picture", type=Path)
    parser.add_argument("output", type=Path)
    given = parser.parse_args()
    data = json.loads(given.coco.read_text())
    name = given.picture.name
    images = [image for image in data["images"] if Path(image["file_name"]).name == name]
    if not images:
        raise SystemExit(f"{given.coco}: wanted the picture {name}, got none of that name")
    shown = [one for one in data["annotations"] if one["image_id"] == images[0]["id"]]
    pixels = oiio.ImageBuf(str(given.picture)).get_pixels(oiio.FLOAT)[..., :3]
    names = {one["id"]: one["name"] for one in data["categories"]}
    matplotlib.rcParams["font.family"] = "DejaVu Sans"
    _draw(pixels, shown, names).savefig(given.output)


def _draw(
    pixels: NDArray[np.float32], annotations: list[dict[str, Any]], names: dict[int, str]
) -> Figure:
    """Pixel by pixel, the large things first."""
    high, wide = pixels.shape[:2]
    figure = Figure(figsize=(wide / 100, high / 100), dpi=100)
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set_axis_off()
    order = {number: k for k, number in enumerate(sorted(names))}
    colours = matplotlib.colormaps["hsv"](np.arange(len(order)) / len(order))[:, :3]
    boxes = []
    for one in sorted(annotations, key=lambda one: -one["area"]):
        colour = colours[order[one["category_id"]]]
        mask = _mask(one["segmentation"])[..., None]
        pixels = np.where(mask, 0.7 * pixels + 0.3 * colour, pixels)
        boxes.append((one["bbox"], colour, names[one["category_id"]]))
    # Pixel (0, 0) of a COCO box is the upper left edge of the picture.
    axes.imshow(pixels, extent=(0, wide, high, 0), interpolation="nearest")
    for (x, y, width, height), colour, name in boxes:
        axes.add_patch(Rectangle((x, y), width, height, fill=False, edgecolor=colour, lw=1.2))
        if width < NARROW:
            continue
        label = {"facecolor": colour, "edgecolor": "none", "pad": 1.2, "alpha": 0.85}
        axes.text(x, max(y, 9), name, fontsize=7, va="bottom", bbox=label)
    axes.set(xlim=(0, wide), ylim=(high, 0))
    return figure


def _mask(runs: dict[str, Any]) -> NDArray[np.bool_]:
    """Run lengths that are not compressed: down the columns, the first one outside."""
    high, wide = runs["size"]
    inside = np.arange(len(runs["counts"])) % 2 == 1
    return np.repeat(inside, runs["counts"]).reshape(wide, high).T


if __name__ == "__main__":
    main()
