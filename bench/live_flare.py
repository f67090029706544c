"""Ghosts for pictures that follow a hand: how far off, and how long they take.

    python bench/live_flare.py [--json] [--lens NAME ...] [--paths 1e6] [--rounds 5] [-w 480 -h 270]

A lamp as large as the sun shines on each lens, alone: from several angles, and at several stops
and focus distances. The ghosts of live pictures are compared with exact ones of --paths paths, in
blocks of 16 x 16 pixels that are brighter than 2 % of the brightest: ``rms`` and ``most`` are the
errors of their luminance, ``halves`` is the RMS of two exact pictures against each other, and
``sum`` the share of all light. CPU and wall-clock time are medians of --rounds pictures after a
lens was seen twice: ``first`` is the CPU time of the first picture, which finds its ghosts anew,
and ``second`` that of the second one, which also finds what is kept. ``rays`` are exact ones of a
picture.
"""

from __future__ import annotations

import argparse
import json
import math
import statistics
import time
from typing import Any, NamedTuple

import numpy as np
from flare import LUMINANCE, Picture, blocks, scene

import daguerre as dg
import daguerre._core as _core
from daguerre.rendering.session import Session


class Case(NamedTuple):
    """A lens, and the sun's degrees to the right and up."""

    lens: str
    degrees: tuple[float, float]
    f_stop: float = 5.6
    focus: float = math.inf  # m


TESSAR, GAUSS, ZOOM = "tessar-50mm-f2.8", "double-gauss-50mm-f2", "sigma-17-40mm-f1.8"
CASES = (
    *(Case(n, d) for n in (TESSAR, GAUSS, ZOOM) for d in ((9.0, 5.0), (2.0, -3.0), (-22.0, 4.0))),
    Case(TESSAR, (9.0, 5.0), focus=0.5),
    Case(GAUSS, (9.0, 5.0), focus=0.5),
    Case(GAUSS, (9.0, 5.0), f_stop=2),
    Case(GAUSS, (9.0, 5.0), f_stop=11),
    Case(ZOOM, (9.0, 5.0), f_stop=2.8),
    Case("zeiss-biotar-50mm-f1.4", (9.0, 5.0), f_stop=1.4),
    Case("leica-summilux-r-50mm-f1.4", (9.0, 5.0), f_stop=1.4),
    Case("fisheye-16mm-f2.8", (20.0, 10.0)),
    Case("nikon-af-s-120-300mm-f2.8", (1.5, 1.0)),
    Case("schneider-anamorphic-60mm", (4.0, 3.0)),
)


def session(arguments: argparse.Namespace, case: Case, seed: int) -> Session:
    """Ready to draw ghosts alone."""
    camera = dg.Camera(lens=case.lens, focus_distance=case.focus, f_stop=case.f_stop, blades=7)
    options = {"flare": arguments.paths, "light_paths": "off", "seed": seed}
    return Session(scene(case.degrees), camera, resolution=(arguments.w, arguments.h), **options)


def exact(made: Session) -> Picture:
    """The exact ghosts of a session."""
    made.draw(0, 1)
    return np.asarray(made.frame().flare, float)


def live(made: Session, rounds: int) -> tuple[Picture, dict[str, float]]:
    """Live ghosts of a session's picture, and what they take."""
    drawer, one, times = _core.LiveFlare(), made.prepared, []
    for _ in range(2 + rounds):
        cpu, wall = time.process_time(), time.perf_counter()
        rgb = drawer.draw(one.core_scene, one.setup.core, made.light_plan.core)
        times.append((time.process_time() - cpu, time.perf_counter() - wall))
    facts = {
        "cpu_s": statistics.median(t[0] for t in times[2:]),
        "wall_s": statistics.median(t[1] for t in times[2:]),
        "first_cpu_s": times[0][0],
        "second_cpu_s": times[1][0],
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


def measured(arguments: argparse.Namespace, case: Case) -> dict[str, Any]:
    """A row of the table."""
    a, b = (exact(session(arguments, case, seed)) for seed in (1, 2))
    mean = (a + b) / 2
    light, facts = live(session(arguments, case, 3), arguments.rounds)
    off = errors(light, mean, mean)
    return {
        **case._asdict(),
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
    parser.add_argument("--lens", nargs="+", default=None)
    parser.add_argument("--paths", type=float, default=1e6)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("-w", type=int, default=480)
    parser.add_argument("-h", type=int, default=270)
    arguments = parser.parse_args()
    for case in CASES:
        if arguments.lens and case.lens not in arguments.lens:
            continue
        row = measured(arguments, case)
        if arguments.json:
            print(json.dumps(row), flush=True)
            continue
        print(
            f"{case.lens} {case.degrees} f/{case.f_stop} {case.focus} m: RMS {row['rms']:.1%}, "
            f"most {row['most']:.0%}, halves {row['halves']:.1%}, light {row['sum']:.3f}, "
            f"{row['cpu_s'] * 1e3:.0f} ms of CPU (first {row['first_cpu_s'] * 1e3:.0f}, "
            f"second {row['second_cpu_s'] * 1e3:.0f}), {row['wall_s'] * 1e3:.0f} ms, "
            f"{row['ghosts']} ghosts, {row['rays']} rays",
            flush=True,
        )


if __name__ == "__main__":
    main()
