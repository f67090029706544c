"""Ghosts for pictures that follow a hand: how far off, and how long they take.

    python bench/live_flare.py [--json] [--lens NAME ...] [--paths 1e6] [--rounds 5] [-w 480 -h 270]

A lamp as large as the sun shines on each lens from several angles, alone. The ghosts of live
pictures are compared with exact ones of --paths paths, in blocks of 16 x 16 pixels that are
brighter than 2 % of the brightest: ``rms`` and ``most`` are the errors of their luminance,
``halves`` is the RMS of two exact pictures against each other, and ``sum`` the share of all light.
CPU and wall-clock time are medians of --rounds pictures, set-up included; ``rays`` are exact ones
of a picture.
"""

from __future__ import annotations

import argparse
import json
import math
import statistics
import time
from typing import Any

import numpy as np
from flare import LUMINANCE, Picture, blocks, scene

import daguerre as dg
import daguerre._core as _core
from daguerre.rendering.session import Session

LENSES = ("tessar-50mm-f2.8", "double-gauss-50mm-f2", "sigma-17-40mm-f1.8")
ANGLES = ((9.0, 5.0), (2.0, -3.0), (-22.0, 4.0))  # degrees to the right and up


def session(
    arguments: argparse.Namespace, lens: str, degrees: tuple[float, float], seed: int
) -> Session:
    """Ready to draw ghosts alone."""
    camera = dg.Camera(lens=lens, focus_distance=math.inf, f_stop=arguments.f_stop, blades=7)
    options = {"flare": arguments.paths, "light_paths": "off", "seed": seed}
    return Session(scene(degrees), camera, resolution=(arguments.w, arguments.h), **options)


def exact(made: Session) -> Picture:
    """The exact ghosts of a session."""
    made.draw(0, 1)
    return np.asarray(made.frame().flare, float)


def live(made: Session, rounds: int) -> tuple[Picture, dict[str, float]]:
    """Live ghosts of a session's picture, and what they take."""
    drawer, one, times = _core.LiveFlare(), made.prepared, []
    for _ in range(rounds):
        cpu, wall = time.process_time(), time.perf_counter()
        rgb = drawer.draw(one.core_scene, one.setup.core, made.light_plan.core)
        times.append((time.process_time() - cpu, time.perf_counter() - wall))
    facts = {
        "cpu_s": statistics.median(t[0] for t in times),
        "wall_s": statistics.median(t[1] for t in times),
        "ghosts": drawer.ghosts,
        "rays": drawer.rays,
        "arrivals": drawer.arrivals,
    }
    return np.asarray(rgb, float), facts


def errors(light: Picture, other: Picture, reference: Picture) -> Picture:
    """Relative errors of bright blocks."""
    bright = blocks(reference)
    lit = bright > 0.02 * bright.max()
    return np.asarray((blocks(light) - blocks(other))[lit] / bright[lit])


def measured(
    arguments: argparse.Namespace, lens: str, degrees: tuple[float, float]
) -> dict[str, Any]:
    """A row of the table."""
    a, b = (exact(session(arguments, lens, degrees, seed)) for seed in (1, 2))
    mean = (a + b) / 2
    light, facts = live(session(arguments, lens, degrees, 3), arguments.rounds)
    off = errors(light, mean, mean)
    return {
        "lens": lens,
        "degrees": degrees,
        "rms": float(np.sqrt((off**2).mean())),
        "most": float(np.abs(off).max()),
        "halves": float(np.sqrt((errors(a, b, mean) ** 2).mean())),
        "sum": float((light @ LUMINANCE).sum() / (mean @ LUMINANCE).sum()),
        **facts,
    }


def main() -> None:
    """Prints the table, or lines of JSON."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0], add_help=False)
    parser.add_argument("--help", action="help")
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--lens", nargs="+", default=LENSES)
    parser.add_argument("--paths", type=float, default=1e6)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--f-stop", type=float, default=5.6)
    parser.add_argument("-w", type=int, default=480)
    parser.add_argument("-h", type=int, default=270)
    arguments = parser.parse_args()
    for lens in arguments.lens:
        for degrees in ANGLES:
            row = measured(arguments, lens, degrees)
            if arguments.json:
                print(json.dumps(row), flush=True)
                continue
            print(
                f"{lens} {degrees}: RMS {row['rms']:.1%}, most {row['most']:.0%}, halves "
                f"{row['halves']:.1%}, light {row['sum']:.3f}, {row['cpu_s'] * 1e3:.0f} ms of CPU, "
                f"{row['wall_s'] * 1e3:.0f} ms, {row['ghosts']} ghosts, {row['rays']} rays",
                flush=True,
            )


if __name__ == "__main__":
    main()
