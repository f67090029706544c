"""Scattered light: time to a clean picture of a sun beside the frame, and veiling glare of lenses.

    python bench/scatter.py [--json] [--lens NAME] [--w 240] [--h 160] [--paths N] [--glare NAME..]

The scene is the sun alone (a ball of 0.53 degrees), ``--degrees`` to the right of the middle, so
all time is that of scatter. relMSE is that of two pictures A and B of different seeds,
mean((A - B)^2 / 2) / mean(R)^2 with R their mean; it falls as 1 / paths. Process CPU seconds,
set-up apart. Veiling glare is that of ``daguerre lens NAME --veiling-glare``, wide open.
"""

from __future__ import annotations

import argparse
import json
import math
import time
from typing import Any

import numpy as np

import daguerre as dg
from daguerre import lenses
from daguerre.analysis import set_up
from daguerre.analysis.glare import VeilingGlare
from daguerre.rendering.session import Session

SUN_DEG = 0.265  # half


def scene(degrees: float) -> dg.Scene:
    """A sun, as many degrees to the right."""
    made = dg.Scene()
    toward = np.array([math.tan(math.radians(degrees)), 0.0, -1.0])
    pose = np.eye(4)
    pose[:3, 3] = 1000 * toward / np.linalg.norm(toward)
    made.add_light(dg.SphereLight((1.6e9,) * 3, 1000 * math.tan(math.radians(SUN_DEG))), pose)
    return made


def noise(arguments: argparse.Namespace) -> dict[str, Any]:
    """Noise of two pictures."""
    camera = dg.Camera(
        lens=arguments.lens, focus_distance=math.inf, f_stop=arguments.f_stop, blades=7
    )
    pictures, cpu = [], []
    for seed in (1, 2):
        session = Session(
            scene(arguments.degrees),
            camera,
            resolution=(arguments.w, arguments.h),
            scatter=arguments.paths,
            light_paths="off",
            seed=seed,
        )
        started = time.process_time()
        session.draw(0, 1)
        cpu.append(time.process_time() - started)
        frame = session.frame()
        pictures.append(np.asarray(frame.flare, np.float64))
    a, b = pictures
    error = float(((a - b) ** 2).mean() / 2 / (0.5 * (a + b).mean()) ** 2)
    blocks = [
        p[..., 1].reshape(p.shape[0] // 8, 8, p.shape[1] // 8, 8).mean((1, 3)) for p in pictures
    ]
    coarse = float(((blocks[0] - blocks[1]) ** 2).mean() / 2 / (0.5 * (a + b).mean()) ** 2)
    draw = float(np.mean(cpu))
    return {
        "lens": arguments.lens,
        "degrees": arguments.degrees,
        "paths_per_pixel": arguments.paths / (arguments.w * arguments.h),
        "share_on_film": session.counters.scatter_hits / session.counters.scatter_paths,
        "cpu_s": draw,
        "us_per_path": 1e6 * draw / arguments.paths,
        "rel_mse": error,
        "rel_mse_of_8x8_green": coarse,
        "paths_per_pixel_to_rel_mse_0.01": arguments.paths
        * error
        / 0.01
        / (arguments.w * arguments.h),
    }


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
    parser.add_argument("--degrees", type=float, default=26.0)
    parser.add_argument("--w", type=int, default=240)
    parser.add_argument("--h", type=int, default=160)
    parser.add_argument("--paths", type=float, default=400000)
    parser.add_argument("--walks", type=int, default=240000)
    parser.add_argument(
        "--glare",
        nargs="*",
        default=["double-gauss-50mm-f2", "sonnar-50mm-f2", "canon-ef-24-70mm-f2.8"],
    )
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    drawn = noise(arguments)
    glares = [glare(name, arguments.walks) for name in arguments.glare]
    if arguments.json:
        print(json.dumps({"noise": drawn, "veiling_glare": glares}, indent=2))
        return
    for line in (drawn, *glares):
        print(
            ", ".join(
                f"{k} {v:.4g}" if isinstance(v, float) else f"{k} {v}" for k, v in line.items()
            )
        )


if __name__ == "__main__":
    main()
