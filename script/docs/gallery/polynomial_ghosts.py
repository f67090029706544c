#!/usr/bin/env python3
"""Ghosts of the sun as polynomials, added to a picture that was rendered without them.

    python script/docs/gallery/polynomial_ghosts.py IN.exr OUT.exr --lens NAME --sun RIGHT,UP
        [--f-stop N] [--diameter DEG] [--luminance CD] [--degree 7] [--count 45]

Each pair of surfaces is one Taylor polynomial from the plane before the lens to the film (Hullin,
Hanika and Heidrich 2012): where a ray of the sun lands is a few multiplications. A second one, to
the iris, says whether it passes there. What other mounts cut is not known. How much light a ghost
has is that of `daguerre lens NAME --flare`. Writes R, G, B and the layer `flare`.
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
from daguerre.analysis.ghosts import Ghosts
from daguerre.lenses.lens import Lens

Floats = NDArray[np.float64]
CHANNEL_NM = (650.0, 545.0, 443.0)  # see docs/darkroom.md, "Distortion"
GRID = 800  # rays across the light of a ghost
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
    out, failed = np.zeros((*size, 3)), 0
    for ghost in Ghosts(bench, angle).all[: given.count]:
        pair = (min(ghost.surfaces), max(ghost.surfaces))
        try:
            points_of = footprint(bench, pair, toward, given.degree)
        except dg.InputError:  # the ray about which to expand does not get through
            failed += ghost.everywhere > 0
            continue
        for k, points in enumerate(points_of):
            if len(points):
                share = spread(points, pitch, size)
                out[:, :, k] += ghost.everywhere * whole[k] * share
    if failed:
        print(f"{failed} ghosts that have no Taylor series there are left out")
    return out


def footprint(
    bench: analysis.Bench, pair: tuple[int, int], toward: Floats, degree: int
) -> list[Floats]:
    """Film points (N, 2), mm, of parallel light that fills the front, for each channel.

    A first expansion about the middle of the front finds where the ghost's light enters, and the
    second is about the middle of that: a Taylor series is best near its own ray.
    """
    front = bench.lens.surfaces[0].semi_diameter
    window = np.array([[-front, front], [-front, front]])
    middle = np.zeros(2)
    for _ in range(2):
        rays = front_rays(window, toward)
        passed = through_iris(bench, pair, rays, (*middle, *toward[:2]), 3)
        passed &= np.hypot(*rays[:, :2].T) < front
        if not passed.any():
            return [np.empty((0, 2))] * len(CHANNEL_NM)
        entered = rays[passed, :2]
        low, high = entered.min(axis=0), entered.max(axis=0)
        margin = 0.1 * (high - low) + 1e-3 * front
        window = np.stack([low - margin, high + margin], axis=1)
        middle = entered.mean(axis=0)
    points, about = [], (*middle, *toward[:2])
    for nm in CHANNEL_NM:
        rays = front_rays(window, toward)
        passed = through_iris(bench, pair, rays, about, degree, nm)
        passed &= np.hypot(*rays[:, :2].T) < front
        film = po.from_lens(
            bench.lens, degree, ghost=pair, wavelength=nm, about=about, film_z=bench.film_z
        )
        points.append(film(rays[passed])[:, :2])
    return points


def front_rays(window: Floats, toward: Floats) -> Floats:
    """Parallel rays, (N, 4), one in each cell of a window of the plane before the lens."""
    cells = np.stack(np.meshgrid(*[np.arange(GRID)] * 2), axis=-1).reshape(-1, 2)
    at = (cells + np.random.default_rng(1).random(cells.shape)) / GRID
    points = window[:, 0] + at * (window[:, 1] - window[:, 0])
    return np.concatenate([points, np.broadcast_to(toward[:2], points.shape)], axis=1)


def through_iris(
    bench: analysis.Bench,
    pair: tuple[int, int],
    rays: Floats,
    about: tuple[float, ...],
    degree: int,
    nm: float = 587.56,
) -> NDArray[np.bool_]:
    """Which rays pass the iris whenever the ghost crosses it."""
    passed = np.ones(len(rays), bool)
    between = pair[0] < stop_index(bench.lens) < pair[1]
    for crossing in range(3 if between else 1):
        iris = po.from_lens(
            bench.lens, degree, ghost=pair, wavelength=nm, about=about, to_iris=crossing
        )
        passed &= np.hypot(*iris(rays)[:, :2].T) < bench.iris_radius
    return passed


def stop_index(lens: Lens) -> int:
    """Index of the surface that is the stop."""
    return next(
        k for k, surface in enumerate(lens.surfaces) if surface.stop or surface.kind == "stop"
    )


def spread(points: Floats, pitch: float, size: tuple[int, int]) -> Floats:
    """The share of the points that each pixel holds; the picture stands upside down on the film."""
    rows, columns = size
    edges = [(np.arange(n + 1) - n / 2) * pitch for n in (rows, columns)]
    held, _, _ = np.histogram2d(points[:, 1], -points[:, 0], bins=edges)
    return np.asarray(held / len(points))


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
