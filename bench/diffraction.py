"""Diffraction of large pictures: the kernels and the convolution, in seconds and bytes.

    python bench/diffraction.py star|zones --json [--width 6000] [--height 4000] [--threads 2]

``star``: RGB through 7 blades at f/16, pixels of 6 um: 24 wavelengths become a 3 x 3 matrix of
kernels, 2049 px across, one for all of the picture. ``zones``: 16 bands of a film, each with a
kernel for each of 3 x 3 points of the frame, through a double Gauss at f/8. Processor time is
given beside the clock's, for machines that are shared.
"""

from __future__ import annotations

import argparse
import json
import resource
import time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre import analysis, lenses
from daguerre.analysis.diffraction import PlainPupil, window_of
from daguerre.analysis.iris import Iris
from daguerre.analysis.lens_pupil import zone_pupils
from daguerre.color.spectra import band_colors
from daguerre.convolution.convolve import convolve
from daguerre.post.starburst import starburst
from daguerre.rendering import diffraction as waves
from daguerre.rendering import pupil_files

PITCH_MM = 0.006


class Clock:
    """Seconds of parts, by the wall and of the processor."""

    def __init__(self) -> None:
        self.parts: dict[str, Any] = {}
        self._last = time.perf_counter(), time.process_time()

    def lap(self, name: str) -> None:
        """Since the last one."""
        now = time.perf_counter(), time.process_time()
        wall, cpu = (round(b - a, 2) for a, b in zip(self._last, now, strict=True))
        peak = round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20, 2)
        self.parts[name] = {"seconds": wall, "cpu_seconds": cpu, "peak_gib": peak}
        self._last = now


def lamps(height: int, width: int, channels: int) -> NDArray[np.float32]:
    """A dim picture with lamps."""
    rng = np.random.default_rng(1)
    picture = rng.random((height, width, channels), np.float32)
    picture *= np.float32(0.1)
    for y, x in rng.random((50, 2)):
        picture[int(y * height), int(x * width)] = 1e4
    return picture


def star(options: argparse.Namespace) -> dict[str, Any]:
    """One 3 x 3 kernel."""
    picture = lamps(options.height, options.width, 3)
    clock = Clock()
    pupil = PlainPupil(16, Iris(blades=7))
    size = window_of(pupil, PITCH_MM, 2049)
    kernel = starburst(pupil, PITCH_MM, size, threads=options.threads)
    clock.lap("kernel")
    convolve(picture, kernel, threads=options.threads)
    clock.lap("convolution")
    return {"kernel_px": size, "wavelengths": 24, **clock.parts}


class Film:
    """Stands in for a film in ``waves.developed``."""

    def __init__(self, bands: NDArray[np.float32]) -> None:
        self._bands = bands

    def mean_bands(self) -> NDArray[np.float32]:
        """Shape (H, W, bands)."""
        return self._bands

    def mean_xyz(self) -> NDArray[np.float32]:
        """Shape (H, W, 3)."""
        colours = band_colors(self._bands.shape[2]).astype(np.float32)
        out = np.empty((*self._bands.shape[:2], 3), np.float32)
        for y, row in enumerate(self._bands):
            out[y] = row @ colours
        return out


def zones(options: argparse.Namespace) -> dict[str, Any]:
    """Bands with a kernel for each zone."""
    film = Film(lamps(options.height, options.width, 16))
    clock = Clock()
    bench = analysis.set_up(lenses.load("double-gauss-50mm-f2"), f_stop=8)
    frame = options.width * PITCH_MM, options.height * PITCH_MM
    pupils = zone_pupils(bench, frame, 3, Iris(blades=7))
    planned = {"bands": 16, "pitch_mm": PITCH_MM, **pupil_files.to_json(pupils)}
    clock.lap("pupils")
    waves.developed(film, planned, threads=options.threads)
    clock.lap("kernels_and_convolution")
    return {"bands": 16, "zones": 9, **clock.parts}


def main() -> None:
    """Parses the command line, and prints one JSON object."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("what", choices=("star", "zones"))
    parser.add_argument("--json", action="store_true", help="accepted for symmetry; always JSON")
    parser.add_argument("--width", type=int, default=6000)
    parser.add_argument("--height", type=int, default=4000)
    parser.add_argument("--threads", type=int, default=2)
    options = parser.parse_args()
    result = {"star": star, "zones": zones}[options.what](options)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
    size = {"width": options.width, "height": options.height, "threads": options.threads}
    print(json.dumps({"what": options.what, **size, **result, "peak_gib": round(peak, 2)}))


if __name__ == "__main__":
    main()
