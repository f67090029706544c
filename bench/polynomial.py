"""Fitted lenses: error by degree, time of the fit, nanoseconds a ray on one core.

    python bench/polynomial.py --json [--lens NAME[:DEGREE,DEGREE]] [--terms 40] [--repeats 400]

Errors are those of rays that the fit has not seen, inside the clear pupil, all over the film (its
format with a margin of 2 %) and 380 to 780 nm: direction RMS and worst ray (rad), and what that is
on the film (um). ``fit_seconds`` is the CPU time of the shortest of three fits, the report of the
error included; ``ns_to_scene`` that of all outputs (scene ray, iris, mounts, transmittance) in the
kernels of this machine's instruction set, ``ns_to_film`` that of the way back.
"""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from one_core import command, machine, report

import daguerre as dg
from daguerre.polynomial import LensFit, fit

HERE = Path(__file__).parent / "lenses"
# Name, degrees, segments; the first two are those of the published figures.
SUBJECTS: list[tuple[str, list[int], int]] = [
    (str(HERE / "us3376090.json"), [3, 5, 7, 9, 11], 1),
    (str(HERE / "us5537259.json"), [3, 5, 7, 9, 11], 1),
    ("double-gauss-50mm-f2", [3, 5, 7, 9, 11], 1),
    ("nikon-af-s-70-200mm-f2.8", [3, 5, 7, 9, 11], 1),
    ("canon-ef-15mm-f2.8-fisheye", [7, 9, 11, 13], 1),
    ("canon-ef-15mm-f2.8-fisheye", [7, 9], 4),
    ("fisheye-16mm-f2.8", [11, 13], 6),
    ("tessar-50mm-f2.8", [7], 1),
    ("wide-angle-28mm-f3.5", [7, 9], 1),
    ("canon-ef-85mm-f1.8", [7, 9], 1),
    ("telephoto-200mm-f1.8", [7, 9], 1),
    ("schneider-anamorphic-60mm", [5, 7], 1),
]


def film_rays(fitted: LensFit, count: int = 8192) -> tuple[Any, Any, Any]:
    """Random rays over film and pupil, wavelengths included."""
    data, random = fitted.to_dict(), np.random.default_rng(0)
    half, pupil = data["film"]["half"], data["pupil"]

    def disc() -> Any:
        angle, radius = 2 * math.pi * random.random(count), np.sqrt(random.random(count))
        return radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], 1)

    f, q = disc(), disc()
    slopes = (q - f * pupil["by_film"] - pupil["shift"]) / pupil["by_slope"]
    return f * half, slopes, 380 + 400 * random.random(count)


def measure(
    lens: dg.lenses.Lens, degree: int, segments: int, terms: int | None, repeats: int
) -> dict[str, Any]:
    """One fit of one lens."""
    times = []
    for _ in range(3):
        started = time.process_time()
        fitted = fit(lens, degree, segments=segments, terms=terms)
        times.append(time.process_time() - started)
    error = fitted.error
    out, back = fitted.core.seconds_a_ray(*film_rays(fitted), repeats)
    blocks = fitted.to_dict()["segments"][0]
    return {
        "lens": lens.name,
        "surfaces": len(lens.surfaces),
        "degree": degree,
        "segments": segments,
        "terms": terms,
        "monomials": len((blocks["direction"].get("x") or blocks["direction"])["powers"]),
        "mounts": len(fitted.core.mounts),
        "direction_rms_rad": error.direction_rad[0],
        "direction_worst_rad": error.direction_rad[1],
        "worst_over_rms": error.direction_rad[1] / error.direction_rad[0],
        "film_rms_um": error.film_um[0],
        "film_worst_um": error.film_um[1],
        "iris_rms_mm": error.iris_mm[0],
        "transmittance_rms": error.transmittance[0],
        "lost": error.lost,
        "leaked": error.leaked,
        "fit_seconds": min(times),
        "ns_to_scene": 1e9 * out,
        "ns_to_film": 1e9 * back,
    }


def run(subjects: list[tuple[str, list[int], int]], terms: int | None, repeats: int) -> Any:
    """All subjects as one JSON object."""
    rows = [
        measure(dg.lenses.load(name), degree, segments, terms, repeats)
        for name, degrees, segments in subjects
        for degree in degrees
    ]
    return {
        "bench": "polynomial",
        "rows": rows,
        **machine(),
    }


def subject(text: str) -> tuple[str, list[int], int]:
    """NAME, NAME:7,9 or NAME:7,9:4 (segments)."""
    name, _, rest = text.partition(":")
    degrees, _, segments = rest.partition(":")
    return name, [int(d) for d in (degrees or "7").split(",")], int(segments or 1)


def lines(result: dict[str, Any]) -> Iterator[str]:
    """For people: a line for each fit."""
    for row in result["rows"]:
        yield (
            f"{row['lens'][:32]:32} degree {row['degree']:2} x{row['segments']}: "
            f"{row['direction_rms_rad']:.1e} rad ({row['worst_over_rms']:.1f} x), "
            f"{row['film_rms_um']:.2g} um, T {row['transmittance_rms']:.1e}, "
            f"fit {row['fit_seconds']:.2f} s, "
            f"{row['ns_to_scene']:.1f} ns out, {row['ns_to_film']:.1f} ns back"
        )


def main() -> int:
    """Measures and prints."""
    parser = command(__doc__)
    parser.add_argument("--lens", action="append", type=subject, help="NAME[:DEGREES[:SEGMENTS]]")
    parser.add_argument("--terms", type=int, help="of each vector, chosen by matching pursuit")
    parser.add_argument("--repeats", type=int, default=40)
    options = parser.parse_args()
    subjects = options.lens or SUBJECTS
    return report(options, lambda: run(subjects, options.terms, options.repeats), lines)


if __name__ == "__main__":
    sys.exit(main())
