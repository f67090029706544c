"""Ghosts of a zoom, sun in the frame: error and time from maps of ghosts, and from paths alone.

    python bench/flare.py [--json] [--lens NAME] [--zoom MM] [--seconds 5] [--reference RAYS]

The scene is the sun alone (a ball of 0.53 degrees), so that all time is the flare's. Both ways get
as many paths as take about --seconds of wall-clock time, set-up included, by two short pictures of
each.

For each way two pictures A and B of different seeds. relMSE = mean((A-B)^2 / 2 / (R^2 + 0.01 m^2)),
R their mean and m the mean of R: where the flare is fainter than a tenth of its mean it need not be
exact. ``luminance`` is that of Y. ``rgb_over_y`` is the error of R, G and B over the luminance
there: error of colours that can be seen. ``median`` is the median pixel's, of luminance.

With --reference a third picture is drawn by paths, of that many rays, and all blocks of 16 x 16
pixels are compared with it: ``beyond`` is the share of blocks of A whose mean is farther from the
reference's than 2 % of it and 1 % of the picture's mean; ``reference_beyond`` is the same of the
halves of the reference, which says how much of that is its own noise.
"""

from __future__ import annotations

import argparse
import json
import math
import time
from typing import Any

import numpy as np
from numpy.typing import NDArray

import daguerre as dg
from daguerre import lenses
from daguerre.rendering.session import Session

SUN_DEG = 0.265  # half
LUMINANCE = np.array((0.2126, 0.7152, 0.0722))
BLOCK = 16  # px
WAYS = ("maps", "paths")

Picture = NDArray[np.float64]


def scene(degrees: tuple[float, float]) -> dg.Scene:
    """A sun, as many degrees to the right and up."""
    made = dg.Scene()
    toward = np.array([math.tan(math.radians(d)) for d in degrees] + [-1.0])
    pose = np.eye(4)
    pose[:3, 3] = 1000 * toward / np.linalg.norm(toward)
    made.add_light(dg.SphereLight((1.6e4,) * 3, 1000 * math.tan(math.radians(SUN_DEG))), pose)
    return made


def session(arguments: argparse.Namespace, paths: float, seed: int) -> Session:
    """Ready to draw, from maps."""
    camera = dg.Camera(
        lens=arguments.lens,
        zoom=arguments.zoom,
        focus_distance=math.inf,
        f_stop=arguments.f_stop,
        blades=7,
    )
    size = (arguments.w, arguments.h)
    options = {"flare": paths, "light_paths": "off", "seed": seed, "threads": arguments.threads}
    return Session(scene((9.0, 5.0)), camera, resolution=size, **options)


def alone(made: Session, way: str, paths: float) -> None:
    """Paths alone, with what is learned ("paths") or without ("naive")."""
    core = made.light_plan.core
    core.flare, core.flare_maps, core.flare_learned = paths, False, way != "naive"
    core.prepare_flare(made.prepared.core_scene, made.prepared.setup.core)


def drawn(
    arguments: argparse.Namespace, paths: float, seed: int, way: str
) -> tuple[Session, Picture, dict[str, float]]:
    """A session with its ghosts, and the seconds that they took, of CPU and of wall-clock."""
    made = None if way == "maps" else session(arguments, 1.0, seed)
    cpu, wall = time.process_time(), time.perf_counter()
    if made is None:
        made = session(arguments, paths, seed)
    else:  # set-up is that of the paths, without that of maps
        alone(made, way, paths)
    ready = (time.process_time() - cpu, time.perf_counter() - wall)
    made.draw(0, 1)
    flare = made.frame().flare
    assert flare is not None
    took = {
        "cpu_s": time.process_time() - cpu,
        "wall_s": time.perf_counter() - wall,
        "setup_cpu_s": ready[0],
        "setup_wall_s": ready[1],
    }
    return made, flare.astype(np.float64), took


def paths_in(arguments: argparse.Namespace, way: str) -> float:
    """Paths that take about the wall-clock time that there is, as two short pictures tell."""
    few, many = (k * arguments.w * arguments.h for k in (0.1, 3.0))
    first, second = (drawn(arguments, paths, 0, way)[2]["wall_s"] for paths in (few, many))
    each = max(second - first, 0.0) / (many - few)
    return max((arguments.seconds - first) / each if each > 0 else many, few)


def naive_share(arguments: argparse.Namespace, paths: float) -> float:
    """Share of rays on the film, if nothing is learned."""
    counters = drawn(arguments, paths, 5, "naive")[0].counters
    return counters.flare_hits / counters.flare_rays


def rel_mse(a: Picture, b: Picture, r: Picture) -> Picture:
    """Relative squared error of one of two pictures, for each pixel."""
    error = (a - b) ** 2 / 2 / (r**2 + 0.01 * r.mean() ** 2)
    return error.mean(axis=-1) if error.ndim == 3 else error


def errors(a: Picture, b: Picture) -> dict[str, float]:
    """By the definitions above."""
    y = [x @ LUMINANCE for x in (a, b)]
    mean = (y[0] + y[1]) / 2
    each = rel_mse(*y, mean)
    colors = ((a - b) ** 2 / 2).mean(axis=-1) / (mean**2 + 0.01 * mean.mean() ** 2)
    return {
        "luminance": float(each.mean()),
        "rgb_over_y": float(colors.mean()),
        "median": float(np.median(each)),
    }


def blocks(picture: Picture) -> Picture:
    """Mean luminance of each block that is whole."""
    y = picture @ LUMINANCE
    high, wide = (n // BLOCK for n in y.shape)
    y = y[: high * BLOCK, : wide * BLOCK]
    return y.reshape(high, BLOCK, wide, BLOCK).mean(axis=(1, 3))


def beyond(picture: Picture, reference: Picture) -> dict[str, float]:
    """Share of blocks that are off by more than the limit; and how far off the 99th of 100 is."""
    own, wanted = blocks(picture), blocks(reference)
    off = np.abs(own - wanted) / (0.02 * wanted + 0.01 * wanted.mean())
    return {"beyond": float((off > 1).mean()), "off_99": float(np.percentile(off, 99))}


def reference(arguments: argparse.Namespace) -> list[Picture]:
    """Two halves, by paths alone."""
    paths = arguments.reference / 8  # four rays each
    return [drawn(arguments, paths, seed, "paths")[1] for seed in (98, 99)]


def measured(arguments: argparse.Namespace, way: str, halves: list[Picture]) -> dict[str, Any]:
    """Time and errors of one way."""
    paths = arguments.paths or paths_in(arguments, way)
    first, second = (drawn(arguments, paths, seed, way) for seed in (1, 2))
    made, took = min((first[0], first[2]), (second[0], second[2]), key=lambda run: run[1]["cpu_s"])
    counters, core = made.counters, made.light_plan.core
    facts: dict[str, Any] = {
        "paths": paths,
        "arrivals": counters.flare_arrivals,
        "rays": counters.flare_rays,
        "share_on_film": counters.flare_hits / counters.flare_rays,
        **took,
        **errors(first[1], second[1]),
    }
    if way == "maps":
        facts["map_error"] = core.flare_map_error
        facts["ghosts_by_rays"] = core.flare_ghosts_by_rays
    if halves:
        whole = (halves[0] + halves[1]) / 2
        light = first[1].mean(axis=(0, 1)) / whole.mean(axis=(0, 1))
        facts |= {"light": [round(float(v), 5) for v in light], **beyond(first[1], whole)}
    return facts


def show(facts: dict[str, Any]) -> str:
    """On one line."""
    words = [f"{k} {v:.4g}" if isinstance(v, float) else f"{k} {v}" for k, v in facts.items()]
    return ", ".join(words)


def main() -> None:
    """Prints a line for each way, or JSON."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--lens", default="canon-ef-24-70mm-f2.8")
    parser.add_argument("--zoom", type=float, default=None)
    parser.add_argument("--f-stop", type=float, default=5.6)
    parser.add_argument("--w", type=int, default=1280)
    parser.add_argument("--h", type=int, default=720)
    parser.add_argument("--seconds", type=float, default=5.0, help="wall-clock, for a picture")
    parser.add_argument("--paths", type=float, default=None, help="instead of so many seconds")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--reference", type=float, default=0, help="rays of a reference")
    parser.add_argument("--naive", action="store_true", help="measure naive paths, too")
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    drawn(arguments, 100.0, 0, "maps")  # what is read and compiled once
    halves = reference(arguments) if arguments.reference else []
    lens = lenses.load(arguments.lens)
    facts: dict[str, Any] = {"lens": lens.name, "surfaces": len(lens.surfaces) - 1}
    for way in WAYS:
        facts[way] = measured(arguments, way, halves)
    if halves:
        facts["reference_beyond"] = beyond(halves[0], halves[1])["beyond"]
    if arguments.naive:
        facts["naive_share_on_film"] = naive_share(arguments, 1e6)
    if arguments.json:
        print(json.dumps(facts, indent=2))
    else:
        for name, value in facts.items():
            print(f"{name}: {show(value) if isinstance(value, dict) else value}")


if __name__ == "__main__":
    main()
