"""Limit of the hardware: rays a second through a lens if nothing but its arithmetic took time.

    python bench/lens_limit.py [NAME] [--ghz 3.7] [--lanes 16] [--json]

Operations are counted from the kernel (core/optics/trace: trace-inl.h, meet-inl.h,
transmission-inl.h; core/optics/aim/pupil-inl.h), per vector of rays. A multiplication, fused or
not, takes the pipe for 1 cycle, and so does a comparison; a division keeps the divider busy for
6 cycles and a root for 10, of which the pipe sees 2 each, and additions have a pipe of their own:
measured on Zen 4 with 512 bits. The limit is the busier of pipe and divider. Aspheres count as
spheres; absorption, gathers, loads and stores are not counted.
"""

from __future__ import annotations

import argparse
import json
from dataclasses import dataclass
from typing import Any

import daguerre as dg
from daguerre import _core

DIVIDE, ROOT, ON_THE_PIPE = 6, 10, 2  # cycles of 512 bits


@dataclass(frozen=True)
class Work:
    """Operations on one vector."""

    multiplies: int = 0
    divisions: int = 0
    roots: int = 0

    def __add__(self, other: Work) -> Work:
        return Work(
            self.multiplies + other.multiplies,
            self.divisions + other.divisions,
            self.roots + other.roots,
        )

    @property
    def cycles(self) -> int:
        """Cycles of the busier unit."""
        slow = self.divisions * DIVIDE + self.roots * ROOT
        return max(self.multiplies + ON_THE_PIPE * (self.divisions + self.roots), slow)


INDEX = Work(2)  # a polynomial of degree 2 (glasses by nd and Abbe number)
MEET_SPHERE, MEET_PLANE = Work(18, 1, 1), Work(5, 1)
RIM = Work(3)
IRIS = Work(4)
SNELL = Work(12, 1, 1)
COATED, BARE = Work(29, 1), Work(13, 1)  # table of a single layer, s and p; cemented
START = Work(9, 2, 1)  # unit direction, wavelength
DRAW = Work(40, 3, 1)  # meridian, column of the visible iris, weight


def aim(degree: int) -> Work:
    """The polynomial and its derivatives: Horner in four variables (slope_lanes)."""
    count = 20
    for i in range(degree + 1):
        for j in range(degree - i + 1):
            count += sum(2 * ((degree - i - j - p) // 2 + 1) for p in range(degree - i - j + 1))
            count += 4
        count += 6
    return Work(count)


def trace(lens: dg.lenses.Lens) -> Work:
    """From the film to the scene."""
    total = Work()
    before = ""
    for surface in lens.surfaces:
        total += RIM + INDEX + (IRIS if surface.stop else Work())
        total += MEET_SPHERE if surface.radius is not None else MEET_PLANE
        if surface.glass != before:
            total += SNELL + (BARE if surface.glass and before else COATED)
        before = surface.glass
    return total


def limit(name: str, ghz: float, lanes: int) -> dict[str, Any]:
    """Operations, cycles and rays a second."""
    lens = dg.lenses.load(name)
    settings = _core.ExactLensSettings(focus_distance_m=3.0)
    degree = _core.ExactLens(lens.prescription, settings).aim_degree
    parts = {"trace": trace(lens), "aim": aim(degree) + START + DRAW}
    total = parts["trace"] + parts["aim"]
    return {
        "bench": "lens_limit",
        "lens": name,
        "surfaces": len(lens.surfaces),
        "aim_degree": degree,
        "operations": {k: [w.multiplies, w.divisions, w.roots] for k, w in parts.items()},
        "cycles": {k: w.cycles for k, w in parts.items()} | {"both": total.cycles},
        "rays_per_second": ghz * 1e9 * lanes / total.cycles,
    }


def main() -> None:
    """Prints the limit."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("name", nargs="?", default="double-gauss-50mm-f2")
    parser.add_argument("--ghz", type=float, default=3.7)
    parser.add_argument("--lanes", type=int, default=16)
    parser.add_argument("--json", action="store_true", help="one JSON object on stdout")
    given = parser.parse_args()
    found = limit(given.name, given.ghz, given.lanes)
    if given.json:
        print(json.dumps(found))
        return
    for part, work in found["operations"].items():
        print(f"{part}: {work[0]} multiplies, {work[1]} divisions, {work[2]} roots")
    print(f"{found['cycles']} cycles, at most {found['rays_per_second'] / 1e6:.0f} M rays/s")


if __name__ == "__main__":
    main()
