#!/usr/bin/env python3
"""A propeller between two keys, by each way of interpolation: a sheet of sixteen pictures.

    python script/docs/gallery/propellers.py [OUT.png] [--scene FILE] [--spp 64] [--size 150]

Rows: 10, 45 and 170 degrees and 3 turns while the shutter is open. Columns: keys that are
interpolated `linear`, by `twist` and `decomposed`, and a `spin`. Reads what
scenes/motion.py makes, out/motion/plane.glb, and gives its propeller other motions.
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

import daguerre as dg

ANGLES_DEG = (10, 45, 170, 3 * 360)
WAYS = ("linear", "twist", "decomposed", "spin")
SHUTTER = 1 / 48  # s, around the time 0
HUB = (0.0, 0.0, 0.66)
MOVING = ("blades", "tips", "spinner")
PAPER = (0.72, 0.8, 0.88)  # what stands behind it, cd/m2


def main() -> None:
    """Renders the sheet."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("output", type=Path, nargs="?", default=Path("out/propellers.png"))
    parser.add_argument("--scene", type=Path, default=Path("out/motion/plane.glb"))
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--size", type=int, default=150)
    given = parser.parse_args()
    rows = [
        [picture(given.scene, degrees, way, given.spp, given.size) for way in WAYS]
        for degrees in ANGLES_DEG
    ]
    sheet = np.concatenate([np.concatenate(row, axis=1) for row in rows])
    given.output.parent.mkdir(parents=True, exist_ok=True)
    picture_file = oiio.ImageBuf(np.ascontiguousarray(sheet))
    if not picture_file.write(str(given.output)):
        raise SystemExit(picture_file.geterror())


def picture(file: Path, degrees: float, way: str, spp: int, size: int) -> NDArray[np.uint8]:
    """The propeller alone, while it turns by an angle, by one way of interpolation."""
    scene = dg.load(file, time=0.0)
    for index, instance in enumerate(scene.instances):
        if instance.name.startswith(MOVING):
            scene.motion.instances[index] = motion(instance.transform, degrees, way)
        elif instance.name != "softbox":
            scene.instances[index] = replace(instance, shown=False)
    scene.set_environment(color=PAPER)
    camera = scene.camera().with_(focal_length=100, shutter_time=SHUTTER)
    frame = dg.render(scene, camera, spp=spp, resolution=(size, size))
    return frame.display("soft")


def motion(place: NDArray[np.float64], degrees: float, way: str) -> Any:
    """World from local over the exposure; `place` is in the middle of it."""
    if way == "spin":
        turns_per_second = degrees / 360 / SHUTTER
        hub = np.linalg.inv(place) @ (*HUB, 1)
        return dg.spin((0, 0, 1), turns_per_second, hub[:3], transform=place)
    ends = [turned(place, side * degrees / 2) for side in (-1, 1)]
    return dg.keys([(-SHUTTER / 2, ends[0]), (SHUTTER / 2, ends[1])], interpolation=way)


def turned(place: NDArray[np.float64], degrees: float) -> NDArray[np.float64]:
    """A transform turned about the axis of the propeller."""
    a = math.radians(degrees)
    turn = np.eye(4)
    turn[:2, :2] = [[math.cos(a), -math.sin(a)], [math.sin(a), math.cos(a)]]
    return turn @ place  # the axis is the world's z


if __name__ == "__main__":
    main()
