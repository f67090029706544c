"""Scattered light: noise after some seconds, on nodes and on pixels; veiling glare.

    python bench/scatter.py [--json] [--lens NAME] [--degrees 25 10] [--cpu 20] [--reference PATHS]
                            [--glare NAME..]

The scene is the sun alone (a ball of 0.53 degrees), ``--degrees`` to the right of the middle, so
all time is that of scatter: ``--cpu`` process CPU seconds for a picture, set-up apart. Both ways to
the film are drawn: light on nodes (the default) and on the pixels of each path (``scatter_nodes =
False`` of the core's settings).

``noise`` is that of two pictures A and B of different seeds, RMS of (A - B) / sqrt(2) of a pixel's
luminance over the mean of the picture; ``median_noise`` is the median pixel's, relative to itself.
With --reference so many paths draw two pictures C and D by pixels, a quarter as large. ``bias`` is
that of blocks of 16 x 16 pixels, RMS, relative to the light about them and a tenth of the mean: the
root of the mean of (A - C) (B - D) and (A - D) (B - C), which have no noise in common; negative
where that mean is below 0. ``bias_error`` is the root of the mean's standard error. ``light`` is
the light of all over the reference's.

Veiling glare is that of ``daguerre lens NAME --veiling-glare``, wide open.
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
from daguerre.analysis import set_up
from daguerre.analysis.glare import VeilingGlare
from daguerre.rendering.session import Session

SUN_DEG = 0.265  # half
LUMINANCE = np.array((0.2126, 0.7152, 0.0722))
WAYS = ("nodes", "pixels")
BLOCK, SHRINK = 16, 4  # px

Picture = NDArray[np.float64]


def scene(degrees: float) -> dg.Scene:
    """A sun, as many degrees to the right."""
    made = dg.Scene()
    toward = np.array([math.tan(math.radians(degrees)), 0.0, -1.0])
    pose = np.eye(4)
    pose[:3, 3] = 1000 * toward / np.linalg.norm(toward)
    made.add_light(dg.SphereLight((1.6e9,) * 3, 1000 * math.tan(math.radians(SUN_DEG))), pose)
    return made


def drawn(
    arguments: argparse.Namespace,
    degrees: float,
    paths: float,
    way: str,
    seed: int,
    shrink: int = 1,
) -> tuple[Picture, float, Session]:
    """Luminance of a picture by so many paths, the CPU seconds that it took, and its session."""
    camera = dg.Camera(
        lens=arguments.lens,
        zoom=arguments.zoom,
        focus_distance=math.inf,
        f_stop=arguments.f_stop,
        blades=7,
    )
    made = Session(
        scene(degrees),
        camera,
        resolution=(arguments.w // shrink, arguments.h // shrink),
        scatter=paths,
        light_paths="off",
        seed=seed,
        threads=arguments.threads,
    )
    made.light_plan.core.scatter_nodes = way == "nodes"
    started = time.process_time()
    made.draw(0, 1)
    cpu = time.process_time() - started
    return np.asarray(made.frame().flare, np.float64) @ LUMINANCE, cpu, made


def paths_in(arguments: argparse.Namespace, degrees: float, way: str) -> float:
    """Paths that take about the CPU time that there is."""
    trial = 1e5
    first, second = (drawn(arguments, degrees, n, way, 9)[1] for n in (trial, 2 * trial))
    fixed = max(2 * first - second, 0.0)  # nodes to the film
    return float(trial) * (arguments.cpu - fixed) / max(second - first, 0.1 * first)


def blocks(picture: Picture, side: int) -> Picture:
    """Mean of each block."""
    high, wide = (n // side for n in picture.shape)
    return np.asarray(picture.reshape(high, side, wide, side).mean(axis=(1, 3)))


def around(values: Picture) -> Picture:
    """Mean of a block and those within two of it."""
    padded = np.pad(values, 2, mode="edge")
    views = np.lib.stride_tricks.sliding_window_view(padded, (5, 5))
    return np.asarray(views.mean(axis=(2, 3)))


def root(value: float) -> float:
    """Square root with its sign."""
    return math.copysign(math.sqrt(abs(value)), value)


def bias(pair: list[Picture], halves: list[Picture]) -> dict[str, float]:
    """Error of blocks that the pictures of a pair share."""
    (a, b), (c, d) = [blocks(p, BLOCK) for p in pair], [blocks(p, BLOCK // SHRINK) for p in halves]
    reference = (c + d) / 2
    scale = (around(reference) + 0.1 * reference.mean()) ** 2
    squares = ((a - c) * (b - d) + (a - d) * (b - c)) / 2 / scale
    return {
        "light": float((a + b).mean() / 2 / reference.mean()),
        "bias": root(float(squares.mean())),
        "bias_error": root(float(squares.std()) / math.sqrt(squares.size)),
    }


def measured(
    arguments: argparse.Namespace, degrees: float, way: str, halves: list[Picture]
) -> dict[str, Any]:
    """Noise and time of one way."""
    paths = arguments.paths or paths_in(arguments, degrees, way)
    (a, cpu, made), (b, other, _) = (drawn(arguments, degrees, paths, way, n) for n in (1, 2))
    mean, off = (a + b) / 2, np.abs(a - b) / math.sqrt(2)
    facts: dict[str, Any] = {
        "lens": arguments.lens,
        "degrees": degrees,
        "way": way,
        "paths_per_pixel": paths / (arguments.w * arguments.h),
        "share_on_film": made.counters.scatter_hits / made.counters.scatter_paths,
        "cpu_s": (cpu + other) / 2,
        "us_per_path": 1e6 * (cpu + other) / 2 / paths,
        "noise": float(np.sqrt((off**2).mean()) / mean.mean()),
        "median_noise": float(np.median(off / np.maximum(mean, 1e-3 * mean.mean())) / 0.6745),
    }
    return facts | (bias([a, b], halves) if halves else {})


def compared(arguments: argparse.Namespace, degrees: float) -> list[dict[str, Any]]:
    """Both ways."""
    paths = arguments.reference / 2
    halves = [
        drawn(arguments, degrees, paths, "pixels", seed, SHRINK)[0] for seed in (98, 99) if paths
    ]
    return [measured(arguments, degrees, way, halves) for way in WAYS]


def glare(name: str, walks: int) -> dict[str, Any]:
    """Veiling glare of one lens."""
    started = time.process_time()
    found = VeilingGlare(set_up(lenses.load(name)), walks=walks)
    return {"lens": name, **found.facts(), "cpu_s": time.process_time() - started}


def main() -> None:
    """Prints lines, or JSON."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--lens", default="double-gauss-50mm-f2")
    parser.add_argument("--f-stop", type=float, default=4.0)
    parser.add_argument("--zoom", type=float, default=None)
    parser.add_argument("--degrees", type=float, nargs="*", default=[25.0, 10.0])
    parser.add_argument("--w", type=int, default=1280)
    parser.add_argument("--h", type=int, default=720)
    parser.add_argument("--cpu", type=float, default=20.0, help="seconds for a picture")
    parser.add_argument("--paths", type=float, default=None, help="instead of so many seconds")
    parser.add_argument("--reference", type=float, default=0, help="paths of a reference")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--walks", type=int, default=240000)
    parser.add_argument(
        "--glare",
        nargs="*",
        default=["double-gauss-50mm-f2", "sonnar-50mm-f2", "canon-ef-24-70mm-f2.8"],
    )
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    noise = [line for degrees in arguments.degrees for line in compared(arguments, degrees)]
    glares = [glare(name, arguments.walks) for name in arguments.glare]
    if arguments.json:
        print(json.dumps({"noise": noise, "veiling_glare": glares}, indent=2))
        return
    for line in (*noise, *glares):
        print(
            ", ".join(
                f"{k} {v:.4g}" if isinstance(v, float) else f"{k} {v}" for k, v in line.items()
            )
        )


if __name__ == "__main__":
    main()
