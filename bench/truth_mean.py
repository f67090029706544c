"""Cost of ground truth as means over rays, and how well so many rays know a share of light.

    python bench/truth_mean.py --json

A grid of small squares 4 m away, out of focus, before a sky: where coverage is between 0.02 and
0.98, the root mean square of its error against 16384 rays of each pixel; and CPU seconds per ray,
on one core, through a thin lens and a traced one.
"""

from __future__ import annotations

import sys
import time
from typing import Any

import numpy as np
from one_core import command, machine, report

import daguerre as dg
from daguerre.rendering.truth import GroundTruth

SIZE = (120, 80)
RAYS = (16, 64, 256, 1024)
REFERENCE = 16384
LENSES = {"thin": "thin", "exact": "double-gauss-50mm-f2"}


def squares() -> dg.Scene:
    """Eight by six of them, each 0.15 m wide."""
    scene = dg.Scene()
    corners = 0.075 * np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], float)
    mesh = scene.add_mesh(corners, np.array([(0, 1, 2), (0, 2, 3)]))
    for x in range(8):
        for y in range(6):
            transform = np.eye(4)
            transform[:3, 3] = 0.33 * (x - 3.5), 0.33 * (y - 2.5), -4
            scene.add_instance(mesh, transform=transform)
    scene.set_environment(color=(1, 1, 1))
    return scene


def measure() -> dict[str, Any]:
    """By lens and number of rays."""
    result: dict[str, Any] = {"name": "truth_mean", **machine()}
    for name, lens in LENSES.items():
        camera = dg.Camera(lens=lens, f_stop=2.0, focus_distance=1.2, shutter_time=0.0)
        truth = GroundTruth(squares(), camera, SIZE, (0, 0, *SIZE), "mid", "mean", REFERENCE, 1)
        now = truth.moment(0)

        def coverage(rays: int, shot: Any = now.shot) -> np.ndarray:
            seen = dg._core.see_mean(*shot, (0, 0, *SIZE), rays)
            return np.asarray(seen.plane("coverage.Y"), np.float64)

        wanted = coverage(REFERENCE)
        partial = (wanted > 0.02) & (wanted < 0.98)
        begun = time.process_time()
        coverage(1)
        setup = time.process_time() - begun
        rows = {}
        for rays in RAYS:
            begun = time.process_time()
            error = (coverage(rays) - wanted)[partial]
            seconds = time.process_time() - begun - setup
            rows[str(rays)] = {
                "coverage_rms": round(float(np.sqrt((error**2).mean())), 4),
                "us_per_ray": round(1e6 * seconds / (rays * SIZE[0] * SIZE[1]), 3),
            }
        result[name] = {"pixels": int(partial.sum()), "setup_seconds": round(setup, 2), **rows}
    return result


def lines(result: dict[str, Any]) -> list[str]:
    """For people."""
    return [
        f"{name}: {rays} rays: rms of a share {row['coverage_rms']}, {row['us_per_ray']} us per ray"
        for name in LENSES
        for rays, row in result[name].items()
        if isinstance(row, dict)
    ]


if __name__ == "__main__":
    sys.exit(report(command(__doc__).parse_args(), measure, lines))
