"""Rays through exact lenses, on one core: how many a second, and the share that passes.

    python bench/lens_rays.py --json [--lens NAME] [--f-stop 2 --f-stop 8] [--seconds 1] [--no-zoom]

Film points are uniform over the film (36 x 24 mm unless the lens says otherwise), wavelengths over
380-780 nm, lens samples random; weights and transmittances are included, and the function that
draws the rays is the renderer's own, called from one thread. A valid ray passes glass, mounts and
iris; seconds are CPU seconds of that thread. ``valid_rays_per_second`` is that of the slowest stop.
``zoom`` holds the same of a zoom of more than 30 surfaces, wide open and two stops down.
"""

from __future__ import annotations

import math
import statistics
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from one_core import command, machine, report

import daguerre as dg
from daguerre import _core

SAMPLES = 1 << 14
ROUNDS = 7
DISTANCE_M = 3.0
F_STOPS = [2.0, 4.0, 8.0]
ZOOM = "nikon-af-s-70-200mm-f2.8"


@dataclass(frozen=True)
class Subject:
    """A lens to be measured: at its zoom, focused at 3 m, before a film in mm."""

    lens: dg.lenses.Lens
    film_z: float
    film_mm: tuple[float, float]

    @classmethod
    def of(cls, name: str, zoom_mm: float | None = None) -> Subject:
        """Makes a subject from a lens of the library or a file."""
        focused = dg.lenses.load(name).focused(DISTANCE_M, zoom_mm=zoom_mm)
        film = [float(side) for side in (focused.lens.data.get("format") or "36x24").split("x")]
        return cls(focused.lens, focused.film_z_mm, (film[0], film[1]))

    def set_up(self, f_stop: float) -> tuple[_core.ExactLens, float]:
        """The lens ready to draw, and the shortest of three set-ups in seconds."""
        half = math.hypot(*self.film_mm) / 2
        settings = _core.ExactLensSettings(
            f_stop=f_stop, half_diagonal_mm=1.0002 * half, film_z_mm=self.film_z
        )
        times = []
        for _ in range(3):
            started = time.thread_time()
            exact = _core.ExactLens(self.lens.prescription, settings)
            times.append(time.thread_time() - started)
        return exact, min(times)

    def stops(self, f_stops: list[float], seconds: float) -> dict[str, dict[str, float]]:
        """Measures at each f-stop."""
        found = {}
        for seed, f_stop in enumerate(f_stops):
            exact, setup = self.set_up(f_stop)
            rays = measure(exact, self.film_mm, seconds, seed)
            found[f"f/{f_stop:g}"] = {**rays, "setup_seconds": setup}
        return found


def measure(
    exact: _core.ExactLens, film_mm: tuple[float, float], seconds: float, seed: int
) -> dict[str, float]:
    """Valid rays/s (median and spread of several rounds) and the share of rays that pass."""
    random = np.random.default_rng(seed)
    film = ((random.random((SAMPLES, 2)) - 0.5) * film_mm).astype(np.float32)
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


def zoom(seconds: float) -> dict[str, Any]:
    """The zoom at its shortest, wide open and two stops down."""
    shortest = (dg.lenses.load(ZOOM).zoom_range_mm or (None,))[0]
    subject = Subject.of(ZOOM, shortest)
    widest = math.ceil(100 * subject.lens.first_order().f_number) / 100
    stops = subject.stops([widest, 2 * widest], seconds)
    open_wide, stopped = stops.values()
    return {
        "lens": ZOOM,
        "zoom_mm": shortest,
        "surfaces": len(subject.lens.surfaces),
        "valid_rays_per_second": min(s["valid_rays_per_second"] for s in stops.values()),
        "pass_fraction": open_wide["pass_fraction"],
        "pass_fraction_two_stops_down": stopped["pass_fraction"],
        "stops": stops,
    }


def run(lens_name: str, f_stops: list[float], seconds: float, with_zoom: bool) -> dict[str, Any]:
    """The whole measurement as one JSON object."""
    subject = Subject.of(lens_name)
    lens = subject.lens
    stops = subject.stops(f_stops, seconds)
    return {
        "bench": "lens_rays",
        "lens": lens_name,
        "patent": lens.patent,
        "surfaces": len(lens.surfaces),
        "valid_rays_per_second": min(s["valid_rays_per_second"] for s in stops.values()),
        "pass_fraction": min(s["pass_fraction"] for s in stops.values()),
        "setup_seconds": max(s["setup_seconds"] for s in stops.values()),
        "stops": stops,
        **({"zoom": zoom(seconds)} if with_zoom else {}),
        **machine(),
    }


def main() -> int:
    """Measures and prints."""
    parser = command(__doc__)
    parser.add_argument("--lens", default="double-gauss-50mm-f2", help="library name or file")
    parser.add_argument("--f-stop", type=float, action="append", help="default: 2, 4 and 8")
    parser.add_argument("--seconds", type=float, default=1.0, help="per f-stop")
    parser.add_argument("--no-zoom", action="store_true", help="the lens alone")
    options = parser.parse_args()
    f_stops = options.f_stop or F_STOPS
    return report(
        options, lambda: run(options.lens, f_stops, options.seconds, not options.no_zoom), lines
    )


def lines(result: dict[str, Any]) -> Iterator[str]:
    """For people: the lens, and the zoom if it was measured."""
    yield result["lens"]
    yield from stop_lines(result["stops"])
    if "zoom" in result:
        found = result["zoom"]
        yield f"{found['lens']} at {found['zoom_mm']:g} mm, {found['surfaces']} surfaces"
        yield from stop_lines(found["stops"])


def stop_lines(stops: dict[str, dict[str, float]]) -> Iterator[str]:
    """A line for each f-stop."""
    for name, stop in stops.items():
        yield (
            f"  {name}: {stop['valid_rays_per_second'] / 1e6:.1f} M valid rays/s, "
            f"{stop['pass_fraction']:.1%} pass, set-up {stop['setup_seconds'] * 1e3:.0f} ms"
        )


if __name__ == "__main__":
    sys.exit(main())
