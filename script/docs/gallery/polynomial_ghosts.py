#!/usr/bin/env python3
"""Ghosts of the sun as polynomials, added to a picture that was rendered without them.

    python script/docs/gallery/polynomial_ghosts.py IN.exr OUT.exr --lens NAME --sun RIGHT,UP
        [--f-stop N] [--diameter DEG] [--luminance CD] [--degree 7] [--count 45]

The polynomials are those of `daguerre lens NAME --flare ANGLE --polynomial DEGREE`: one for each
ghost and channel. The light of a ghost is that of `daguerre lens NAME --flare`. Writes R, G, B and
the layer `flare`.
"""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO as oiio
from numpy.typing import NDArray

import daguerre as dg
import daguerre.polynomial as po
from daguerre import analysis
from daguerre.analysis.ghosts import Ghost, Ghosts, splat

Floats = NDArray[np.float64]
CHANNEL_NM = (650.0, 545.0, 443.0)  # see docs/darkroom.md, "Distortion"
RAYS = 800 * 800  # over the light of a ghost
FULL_MM = 36.0  # width of the film


def main() -> None:
    """Adds the ghosts."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("picture", type=Path)
    parser.add_argument("output", type=Path)
    parser.add_argument("--lens", required=True)
    parser.add_argument("--f-stop", type=float)
    parser.add_argument("--sun", required=True, help="RIGHT,UP in degrees")
    parser.add_argument("--diameter", type=float, default=0.53, help="degrees")
    parser.add_argument("--luminance", type=float, default=9000.0, help="cd/m2")
    parser.add_argument("--color", default="1,0.86,0.66", help="R,G,B of the sun")
    parser.add_argument("--degree", type=int, default=7)
    parser.add_argument("--count", type=int, default=45, help="the brightest ghosts")
    given = parser.parse_args()
    file = oiio.ImageBuf(str(given.picture))
    names, pixels = file.spec().channelnames, file.get_pixels(oiio.FLOAT)
    rgb = np.stack([pixels[:, :, names.index(name)] for name in "RGB"], axis=2)
    bench = analysis.set_up(dg.lenses.load(given.lens), f_stop=given.f_stop)
    flare = ghosts(bench, given, (rgb.shape[0], rgb.shape[1]))
    write(given.output, rgb, np.asarray(flare, np.float32))


def ghosts(bench: analysis.Bench, given: Any, size: tuple[int, int]) -> Floats:
    """The light of all ghosts, scene-linear, shape (H, W, 3)."""
    right, up = (math.tan(math.radians(float(a))) for a in given.sun.split(","))
    toward = np.array([-right, -up, 1.0]) / math.hypot(right, up, 1)  # light goes along +z
    angle = math.degrees(math.acos(toward[2]))
    pitch = FULL_MM / size[1]
    radius_px = bench.order.efl * math.tan(math.radians(given.diameter / 2)) / pitch
    color = np.array([float(c) for c in given.color.split(",")])
    color /= color @ (0.2126, 0.7152, 0.0722)
    whole = given.luminance * math.pi * radius_px**2 * color  # of the sun's picture
    out = np.zeros((*size, 3))
    film = (FULL_MM, FULL_MM * size[0] / size[1])
    for ghost in Ghosts(bench, angle).all[: given.count]:
        for k, points in enumerate(landings(bench, ghost, tuple(toward), given.degree)):
            share = np.full(len(points), ghost.everywhere * whole[k] / max(1, len(points)))
            out[:, :, k] += splat(points, share, film, size)
    return out


def landings(
    bench: analysis.Bench, ghost: Ghost, toward: tuple[float, float, float], degree: int
) -> list[Floats]:
    """Film points (N, 2), mm, of parallel light, by the polynomials of each channel."""
    pair = (ghost.surfaces[0], ghost.surfaces[1])
    points = []
    for nm in CHANNEL_NM:
        light = analysis.ghost_rays(bench, pair, toward, wavelength_nm=nm)
        if not light.passed.any():
            points.append(np.empty((0, 2)))
            continue
        dense = analysis.ghost_rays(bench, pair, toward, rays=RAYS, wavelength_nm=nm)
        landed = po.expand_ghost(light, degree).points(dense.rays[:, :2])
        points.append(landed[np.isfinite(landed[:, 0])])
    return points


def write(path: Path, rgb: NDArray[np.float32], flare: NDArray[np.float32]) -> None:
    """An .exr with the ghosts in the picture and beside it."""
    spec = oiio.ImageSpec(rgb.shape[1], rgb.shape[0], 6, oiio.FLOAT)
    spec.channelnames = ("R", "G", "B", "flare.R", "flare.G", "flare.B")
    made = oiio.ImageBuf(spec)
    made.set_pixels(spec.roi, np.ascontiguousarray(np.concatenate([rgb + flare, flare], axis=2)))
    if not made.write(str(path)):
        raise SystemExit(f"{path}: {made.geterror()}")


if __name__ == "__main__":
    main()
