"""Rays through the exact lens: the claim of at least 12 M valid rays/s on one AVX-512 core.

    python bench/lens_rays.py --json [--lens NAME] [--f-stop 2 --f-stop 8] [--seconds 1]

Film points are uniform over 36 x 24 mm, wavelengths over 380-780 nm, lens samples random; weights
are included, and the function that draws the rays is the renderer's own, called from one thread. A
valid ray passes glass, mounts and iris; seconds are CPU seconds of that thread.
``valid_rays_per_second`` is that of the slowest stop.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import statistics
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

import daguerre as dg
from daguerre import _core

SAMPLES = 1 << 14
ROUNDS = 7


def set_up(lens: dg.lenses.Lens, f_stop: float) -> tuple[_core.ExactLens, float]:
    """The lens ready to draw, and the shortest of three set-ups in seconds."""
    times = []
    for _ in range(3):
        started = time.thread_time()
        exact = _core.ExactLens(lens.prescription, f_stop, _core.Iris(), 3.0, False, 21.64)
        times.append(time.thread_time() - started)
    return exact, min(times)


def measure(exact: _core.ExactLens, seconds: float, seed: int) -> dict[str, float]:
    """Valid rays/s (median and spread of several rounds) and the share of rays that pass."""
    random = np.random.default_rng(seed)
    film = ((random.random((SAMPLES, 2)) - 0.5) * (36, 24)).astype(np.float32)
    u_lens = random.random((SAMPLES, 2)).astype(np.float32)
    wavelengths = (380 + 400 * random.random(SAMPLES)).astype(np.float32)
    _, warm = exact.time_generate(film, u_lens, wavelengths, 20)
    repeats = max(1, int(seconds / ROUNDS / (warm / 20)))
    rates, passed = [], 0
    for _ in range(ROUNDS):
        passed, elapsed = exact.time_generate(film, u_lens, wavelengths, repeats)
        rates.append(passed / elapsed)
    return {
        "valid_rays_per_second": statistics.median(rates),
        "slowest_round": min(rates),
        "fastest_round": max(rates),
        "pass_fraction": passed / (SAMPLES * repeats),
    }


def processor() -> str:
    """Name of the processor."""
    info = Path("/proc/cpuinfo")
    if info.is_file():
        for line in info.read_text().splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    return platform.processor() or platform.machine()


def run(lens_name: str, f_stops: list[float], seconds: float) -> dict[str, Any]:
    """The whole measurement as one JSON object."""
    lens = dg.lenses.load(lens_name)
    stops: dict[str, dict[str, float]] = {}
    for seed, f_stop in enumerate(f_stops):
        exact, setup = set_up(lens, f_stop)
        stops[f"f/{f_stop:g}"] = {**measure(exact, seconds, seed), "setup_seconds": setup}
    return {
        "bench": "lens_rays",
        "lens": lens_name,
        "patent": lens.patent,
        "surfaces": len(lens.surfaces),
        "valid_rays_per_second": min(s["valid_rays_per_second"] for s in stops.values()),
        "pass_fraction": min(s["pass_fraction"] for s in stops.values()),
        "setup_seconds": max(s["setup_seconds"] for s in stops.values()),
        "stops": stops,
        "threads": 1,
        "clock": "CPU seconds of the thread",
        "simd_target": _core.simd_target(),
        "machine": processor(),
        "cores": os.cpu_count(),
        "version": dg.__version__,
    }


def main() -> int:
    """Measures and prints."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--json", action="store_true", help="one JSON object on stdout")
    parser.add_argument("--lens", default="double-gauss-50mm-f2", help="library name or file")
    parser.add_argument("--f-stop", type=float, action="append", help="default: 2 and 8")
    parser.add_argument("--seconds", type=float, default=1.0, help="per f-stop")
    options = parser.parse_args()
    try:
        result = run(options.lens, options.f_stop or [2.0, 8.0], options.seconds)
    except ValueError as error:
        print(f"lens_rays: {error}", file=sys.stderr)
        return 2
    if options.json:
        print(json.dumps(result))
        return 0
    print(f"{result['lens']}, {result['machine']}, {result['simd_target']}, one core")
    for name, stop in result["stops"].items():
        print(
            f"  {name}: {stop['valid_rays_per_second'] / 1e6:.1f} M valid rays/s, "
            f"{stop['pass_fraction']:.1%} pass, set-up {stop['setup_seconds'] * 1e3:.0f} ms"
        )
    return 0


if __name__ == "__main__":
    sys.exit(main())
