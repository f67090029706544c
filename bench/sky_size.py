"""CPU time of a room under skies of more and more texels: the same light, the same rays.

    python bench/sky_size.py --json [--widths 32 1024 4096] [--room living-room] [--spp 32]
                             [--w 240] [--h 135] [--repeats 3]

The room is one of ``bench/rooms.py``, under its overcast sky and under one with a sun, whose light
is the same at any size (the sun fills no less than a texel). Sizes take turns, on one thread.
Figures are medians over the repeats: CPU us per sample without the set-up, set-up in CPU seconds,
rays per sample, which must agree within 3 %, and ``ratio``, the CPU time over that of the smallest
sky.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE / "ajar_door"))

from sky_rooms import skies  # noqa: E402
from sky_rooms.made import ROOMS  # noqa: E402

import daguerre as dg  # noqa: E402
from daguerre.rendering.session import Session  # noqa: E402

TOWARD = (-0.6, 0.5, -0.62)  # the sun, by windows at -x and at -z
SAME_RAYS = 0.03
KINDS = ("overcast", "sun")
Facts = dict[str, Any]


def sky(kind: str, width: int) -> np.ndarray:
    """A sky by its name."""
    return skies.overcast(width) if kind == "overcast" else skies.sunny(width, TOWARD)


def draw(scene: dg.Scene, options: argparse.Namespace, seed: int) -> Facts:
    """Costs of one picture."""
    size = (options.w, options.h)
    before = time.process_time()
    session = Session(
        scene, resolution=size, seed=seed, filter="box", threads=1, max_depth=12, light_paths="off"
    )
    ready = time.process_time()
    session.draw(0, options.spp)
    samples = options.w * options.h * options.spp
    return {
        "us_per_sample": (time.process_time() - ready) / samples * 1e6,
        "setup_cpu_s": ready - before,
        "rays_per_sample": session.counters.rays / samples,
        "mean": float(session.frame().rgb.mean()),
    }


def measure(kind: str, options: argparse.Namespace) -> Facts:
    """Rows by width."""
    scene = ROOMS[options.room](min(options.widths))
    drawn: dict[int, list[Facts]] = {width: [] for width in options.widths}
    for repeat in range(options.repeats):
        for width in options.widths if repeat % 2 == 0 else options.widths[::-1]:
            scene.set_environment(sky(kind, width))
            drawn[width].append(draw(scene, options, seed=1 + repeat))
    rows = {
        width: {key: round(float(np.median([one[key] for one in all_])), 4) for key in all_[0]}
        for width, all_ in drawn.items()
    }
    first = rows[min(rows)]
    for row in rows.values():
        row["ratio"] = round(row["us_per_sample"] / first["us_per_sample"], 3)
        check_rays(kind, row["rays_per_sample"], first["rays_per_sample"])
    return {str(width): row for width, row in rows.items()}


def check_rays(kind: str, rays: float, first: float) -> None:
    """Ends with an error where two skies cast other rays: their times say nothing then."""
    if abs(rays / first - 1) > SAME_RAYS:
        sys.exit(f"sky_size: {kind}: wanted {first:g} rays a sample under each sky, got {rays:g}")


def main() -> None:
    """Measures and prints one JSON object."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--json", action="store_true", help="accepted for symmetry; always JSON")
    parser.add_argument("--widths", type=int, nargs="+", default=[32, 1024, 4096], help="texels")
    parser.add_argument("--room", choices=("living-room", "classroom", "dining-room"))
    parser.add_argument("--spp", type=int, default=32)
    parser.add_argument("--w", type=int, default=240, help="px")
    parser.add_argument("--h", type=int, default=135, help="px")
    parser.add_argument("--repeats", type=int, default=3)
    parser.set_defaults(room="living-room")
    options = parser.parse_args()
    wrong = [width for width in options.widths if width < 4 or width % 2]
    if wrong:
        parser.error(f"--widths: wanted even numbers from 4, got {wrong[0]}")
    out: Facts = {
        "benchmark": "sky_size",
        "room": options.room,
        "resolution": [options.w, options.h],
        "spp": options.spp,
        "machine": f"{platform.machine()}, {os.cpu_count()} cores",
    }
    print(json.dumps(out | {kind: measure(kind, options) for kind in KINDS}, indent=1))


if __name__ == "__main__":
    main()
