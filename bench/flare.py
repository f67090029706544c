"""Ghosts of a zoom, sun in the frame: share of rays on the film, error and time, learned and naive.

    python bench/flare.py [--json] [--naive] [--lens NAME] [--zoom MM] [--w 1280] [--h 720]

The scene is the sun alone (a ball of 0.53 degrees), so that all time is the flare's. Wanted: 90 %
of the rays on the film (naive, which draws all pairs of surfaces and the whole front lens alike:
15 % published), and relMSE 0.01 after 5 s on 2 cores, set-up included.

relMSE = mean((A - B)^2 / 2 / (R^2 + 0.01 m^2)) of two pictures A and B of different seeds, over
R, G and B; R is the mean of A, B and a picture with --reference times the paths, m the mean of R:
where the flare is fainter than a tenth of its mean it need not be exact. Beside it, as single
samples may bring much of it: of luminance alone; the median pixel's; without the worst pixel in a
thousand (Rousselle 2011 does so). Wall-clock and CPU seconds; the quicker of two pictures.
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
LUMINANCE = (0.2126, 0.7152, 0.0722)


def scene(degrees: tuple[float, float]) -> dg.Scene:
    """A sun, as many degrees to the right and up."""
    made = dg.Scene()
    toward = np.array([math.tan(math.radians(d)) for d in degrees] + [-1.0])
    pose = np.eye(4)
    pose[:3, 3] = 1000 * toward / np.linalg.norm(toward)
    made.add_light(dg.SphereLight((1.6e4,) * 3, 1000 * math.tan(math.radians(SUN_DEG))), pose)
    return made


def session(arguments: argparse.Namespace, paths: float, seed: int) -> Session:
    """Ready to draw."""
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


def drawn(arguments: argparse.Namespace, paths: float, seed: int) -> tuple[Session, Any]:
    """A session with its picture."""
    made = session(arguments, paths, seed)
    made.draw(0, 1)
    return made, made.frame()


def naive_share(arguments: argparse.Namespace, paths: float) -> float:
    """Share of rays on the film, if nothing is learned."""
    made = session(arguments, paths, 5)
    made.light_plan.core.flare_learned = False
    made.light_plan.core.prepare_flare(made.prepared.core_scene, made.prepared.setup.core)
    made.draw(0, 1)
    return made.counters.flare_hits / made.counters.flare_rays


def rel_mse(a: NDArray[Any], b: NDArray[Any], r: NDArray[Any]) -> NDArray[Any]:
    """Relative squared error of one of two pictures, for each pixel."""
    error = (a - b) ** 2 / 2 / (r**2 + 0.01 * r.mean() ** 2)
    return error.mean(axis=-1) if error.ndim == 3 else error


def errors(a: NDArray[Any], b: NDArray[Any], r: NDArray[Any]) -> dict[str, float]:
    """By some definitions."""
    each = np.sort(rel_mse(a, b, r).ravel())
    gray = [x @ np.array(LUMINANCE) for x in (a, b, r)]
    return {
        "rel_mse": float(each.mean()),
        "rel_mse_luminance": float(rel_mse(*gray).mean()),
        "rel_mse_median": float(np.median(each)),
        "rel_mse_999_of_1000": float(each[: -max(1, len(each) // 1000)].mean()),
    }


def main() -> None:
    """Prints one line, or JSON."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--lens", default="canon-ef-24-70mm-f2.8")
    parser.add_argument("--zoom", type=float, default=None)
    parser.add_argument("--f-stop", type=float, default=5.6)
    parser.add_argument("--w", type=int, default=1280)
    parser.add_argument("--h", type=int, default=720)
    parser.add_argument("--paths", type=float, default=None, help="per picture [2 per pixel]")
    parser.add_argument("--error", type=float, default=0.01)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--repeat", type=int, default=1, help="pairs of pictures")
    parser.add_argument("--reference", type=float, default=8, help="times the paths")
    parser.add_argument("--naive", action="store_true", help="measure that share, too")
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    paths = arguments.paths or 2.0 * arguments.w * arguments.h
    pairs, times = [], []
    drawn(arguments, 100.0, 0)  # what is read and compiled once
    for i in range(arguments.repeat):
        pictures = []
        for seed in (2 * i + 1, 2 * i + 2):
            cpu, wall = time.process_time(), time.perf_counter()
            made = session(arguments, paths, seed)
            ready = time.process_time() - cpu
            made.draw(0, 1)
            pictures.append(made.frame().flare.astype(np.float64))
            times.append((time.process_time() - cpu, time.perf_counter() - wall, ready, made))
        pairs.append(pictures)
    cpu, wall, ready, made = min(times, key=lambda run: run[0])
    weight = arguments.reference
    reference = weight * drawn(arguments, weight * paths, 99)[1].flare
    reference = (reference + pairs[0][0] + pairs[0][1]) / (weight + 2)
    found = [errors(*pictures, reference) for pictures in pairs]
    error = {k: float(np.mean([one[k] for one in found])) for k in found[0]}
    lens = lenses.load(arguments.lens)
    facts: dict[str, Any] = {
        "lens": lens.name,
        "surfaces": len(lens.surfaces) - 1,
        "share_on_film": made.counters.flare_hits / made.counters.flare_rays,
        "paths": paths,
        "setup_cpu_s": ready,
        "cpu_s": cpu,
        "wall_s": wall,
        "ns_per_ray": 1e9 * (cpu - ready) / made.counters.flare_rays,
        **error,
        # The error falls with 1 / paths.
        "cpu_s_to_error": ready + (cpu - ready) * error["rel_mse"] / arguments.error,
        "cpu_s_to_luminance_error": ready
        + (cpu - ready) * error["rel_mse_luminance"] / arguments.error,
    }
    if arguments.naive:
        facts["naive_share_on_film"] = naive_share(arguments, paths)
    if arguments.json:
        print(json.dumps(facts, indent=2))
    else:
        print(
            ", ".join(
                f"{k} {v:.4g}" if isinstance(v, float) else f"{k} {v}" for k, v in facts.items()
            )
        )


if __name__ == "__main__":
    main()
