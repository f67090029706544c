#!/usr/bin/env python3
"""A propeller blade between two keys, by each way of interpolation: a sheet with labels.

    python script/docs/gallery/propellers.py [OUT.png] [--scene FILE] [--spp 64] [--size 200]

Rows: 90 and 170 degrees, 90 degrees while it shrinks to a half, and 3 turns, while the shutter is
open. Columns: keys that are interpolated `linear`, by `twist` and `decomposed`, and a `spin`. The
blade shines in the dark, so each point draws its path. Reads what scenes/motion.py makes,
out/motion/plane.glb, and gives its propeller other motions.
"""

from __future__ import annotations

import argparse
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO as oiio
from numpy.typing import NDArray
from sheet import captioned, grid, written

import daguerre as dg

#: Angle between the keys, degrees; size of the second, over that of the first; label.
ROWS = (
    (90, 1.0, "90 degrees"),
    (170, 1.0, "170 degrees"),
    (90, 0.5, "90 degrees,\nhalf as large"),
    (3 * 360, 1.0, "3 turns"),
)
#: Ways of interpolation, and their labels.
WAYS = {"linear": "linear (lerp)", "twist": "twist", "decomposed": "decomposed", "spin": "spin"}
SHUTTER = 1 / 48  # s, around the time 0
HUB = (0.0, 0.0, 0.66)
#: Luminances cd/m2, of the first blade and its tip; the others are hidden.
SHINE = {"blades": (0.5, 0.9, 1.4), "tips": (9.0, 4.0, 0.6)}
LABEL = 96  # px, of the first column


def main() -> None:
    """Renders the sheet."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("output", type=Path, nargs="?", default=Path("out/propellers.png"))
    parser.add_argument("--scene", type=Path, default=Path("out/motion/plane.glb"))
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--size", type=int, default=200)
    given = parser.parse_args()
    rows = []
    for degrees, scale, label in ROWS:
        cells = [picture(given.scene, degrees, scale, way, given) for way in WAYS]
        if not rows:
            cells = [captioned(c, name) for c, name in zip(cells, WAYS.values(), strict=True)]
        rows.append([written(label, LABEL, cells[0].shape[0]), *cells])
    given.output.parent.mkdir(parents=True, exist_ok=True)
    picture_file = oiio.ImageBuf(np.ascontiguousarray(grid(rows)))
    if not picture_file.write(str(given.output)):
        raise SystemExit(picture_file.geterror())


def picture(file: Path, degrees: float, scale: float, way: str,
            given: argparse.Namespace) -> NDArray[np.uint8]:  # fmt: skip
    """One blade alone, while it turns by an angle, by one way of interpolation."""
    scene = dg.load(file, time=0.0)
    for index, material in enumerate(scene.materials):
        scene.materials[index] = replace(material, emission=(0.0, 0.0, 0.0))
    for index, instance in enumerate(scene.instances):
        if instance.name not in SHINE:
            scene.instances[index] = replace(instance, shown=False)
            continue
        light = dg.Material(dg.Diffuse((0, 0, 0)), emission=SHINE[instance.name])
        shining = scene.add_material(light)
        scene.instances[index] = replace(instance, material=shining)
        try:
            scene.motion.instances[index] = motion(instance.transform, degrees, scale, way)
        except dg.InputError:
            return written("an error: twist wants\nrigid matrices", given.size, given.size, 225)
    camera = scene.camera().with_(focal_length=100, shutter_time=SHUTTER)
    size = (given.size, given.size)
    return dg.render(scene, camera, spp=given.spp, resolution=size, max_depth=1).display("soft")


def motion(place: NDArray[np.float64], degrees: float, scale: float, way: str) -> Any:
    """World from local over the exposure; at `scale` 1, `place` is in the middle of it."""
    ends = [moved(place, -degrees / 2, 1.0), moved(place, degrees / 2, scale)]
    times = (-SHUTTER / 2, SHUTTER / 2)
    if way != "spin":
        return dg.keys(list(zip(times, ends, strict=True)), interpolation=way)
    turns_per_second = degrees / 360 / SHUTTER
    hub = np.linalg.inv(place) @ (*HUB, 1)
    sizes = [moved(place, 0.0, size) for size in (1.0, scale)]
    held = place if scale == 1 else dg.keys(list(zip(times, sizes, strict=True)))
    return dg.spin((0, 0, 1), turns_per_second, hub[:3], transform=held)


def moved(place: NDArray[np.float64], degrees: float, scale: float) -> NDArray[np.float64]:
    """A transform turned about the axis of the propeller, the world's z, and scaled."""
    a = math.radians(degrees)
    turn = np.eye(4)
    turn[:2, :2] = scale * np.array([[math.cos(a), -math.sin(a)], [math.sin(a), math.cos(a)]])
    return turn @ place


if __name__ == "__main__":
    main()
