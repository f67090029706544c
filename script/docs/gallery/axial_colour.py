#!/usr/bin/env python3
"""Colour along the axis in 2D: the depth of field of red, green and blue, each with its own focus.

    python script/docs/gallery/axial_colour.py IN.exr OUT.exr --lens NAME [--f-stop N] [--focus M]
        [--sensor-width MM]

IN.exr was rendered through a pinhole, with depth: `daguerre render SCENE --lens NAME
--lens-model pinhole --aov depth --gt-time mid -o IN.exr`. Shows `dg.post` from Python.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
import OpenImageIO as oiio

import daguerre as dg
from daguerre import analysis

CHANNEL_NM = (650.0, 545.0, 443.0)  # see docs/darkroom.md, "Distortion"


def main() -> None:
    """Blurs the three colours."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("picture", type=Path)
    parser.add_argument("output", type=Path)
    parser.add_argument("--lens", required=True)
    parser.add_argument("--f-stop", type=float)
    parser.add_argument("--focus", type=float, default=3.0, help="m")
    parser.add_argument("--sensor-width", type=float, default=36.0, help="of the whole frame, mm")
    given = parser.parse_args()
    bench = analysis.set_up(dg.lenses.load(given.lens), f_stop=given.f_stop, focus_m=given.focus)

    file = oiio.ImageBuf(str(given.picture))
    spec, pixels = file.spec(), file.get_pixels(oiio.FLOAT)
    depth = np.ascontiguousarray(pixels[:, :, spec.channelnames.index("depth.Z")])
    sensor = given.sensor_width * spec.width / spec.full_width
    blurred = [
        dg.post.depth_of_field(
            np.ascontiguousarray(pixels[:, :, spec.channelnames.index(name)][:, :, None]),
            depth,
            focal_length=bench.order.efl,
            f_stop=bench.f_stop,
            focus=focus_m,
            sensor=(sensor, sensor * spec.height / spec.width),
        )
        for name, focus_m in zip("RGB", sharp_distances(bench, given.focus), strict=True)
    ]
    write(given.output, np.concatenate(blurred, axis=2), spec)


def sharp_distances(bench: analysis.Bench, focus_m: float) -> list[float]:
    """Distances, m, that each colour has in focus while 587.56 nm has another.

    A colour whose image lies by a behind the film is sharp for what is farther away: from
    1 / s + 1 / s' = 1 / f the inverse distance is less by a / s'^2.
    """
    film_mm = 1 / (1 / bench.order.efl - 1e-3 / focus_m)
    behind_mm = analysis.axial_colour(bench, CHANNEL_NM)
    return [1 / (1 / focus_m - 1e3 * float(a) / film_mm**2) for a in behind_mm]


def write(path: Path, rgb: np.ndarray[tuple[int, int, int], np.dtype[np.float32]],
          like: oiio.ImageSpec) -> None:  # fmt: skip
    """An .exr with the windows of another."""
    spec = oiio.ImageSpec(like.width, like.height, 3, oiio.FLOAT)
    for name in ("x", "y", "full_x", "full_y", "full_width", "full_height"):
        setattr(spec, name, getattr(like, name))
    made = oiio.ImageBuf(spec)
    made.set_pixels(like.roi, np.ascontiguousarray(rgb, dtype=np.float32))
    if not made.write(str(path)):
        raise SystemExit(f"{path}: {made.geterror()}")


if __name__ == "__main__":
    main()
