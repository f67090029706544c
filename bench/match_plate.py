"""How long ``match_plate`` takes for a photograph of 24 MP, and how near it comes.

    python bench/match_plate.py [--json] [--size 6000x4000] [--iso 400] [--rounds 3]

A wedge, a gradient and slanted squares, taken by the sony-a7r-ii through a Gaussian of 0.7 px: as
DNG, as JPEG and as linear EXR. Seconds are the median over rounds, each in a process of its own
that has its libraries; memory is the largest that it had, less what it began with. Errors are those
of gain and read noise of the DNG, in per cent. The spread that is found, px, is beside the pixel's
own area, which these edges do not have: sqrt(0.7^2 - 1/12) = 0.64. Goal: 5 s on two cores.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import statistics
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import daguerre as dg

SENSOR, SIGMA, SIDE = "sony-a7r-ii", 0.7, 120.0
FACTS = {
    "expTime": 1 / 125,
    "aperture": 5.6,
    "nominalFocalLength": 35.0,
    "lensMake": "Canon",
    "lensModel": "EF24-70mm f/2.8L II USM",
    "sensorOverallDimensions": (35.9, 24.0),
}


def light_of(width: int, height: int) -> NDArray[np.float32]:
    """Squares above, steps and a gradient below; shares of white, shape (H, W)."""
    x = np.arange(width, dtype=np.float32)[None]
    y = np.arange(height, dtype=np.float32)[:, None]
    along, across = x + 0.1 * y, y - 0.1 * x
    edges = []
    for t in (along, across):
        distance = np.abs((t / SIDE) % 2 - 1) * SIDE - SIDE / 2
        steep = np.clip(-1.702 * distance / np.float32(SIGMA), -50, 50)
        edges.append(1 / (1 + np.exp(steep)))
    squares = 0.25 + 0.75 * edges[0] * edges[1]
    steps = 2.0 ** -np.floor(12 * x / width)
    light = np.where(y < height / 2, squares, np.where(y < 0.75 * height, steps, x / width))
    light[int(0.95 * height) :] = 0
    return np.asarray(light, np.float32)


def files(folder: Path, width: int, height: int, iso: float) -> None:
    """The photographs."""
    light = light_of(width, height)
    rgb = np.repeat(light[:, :, None], 3, axis=2)
    facts = FACTS | {"luminance_exposure": 0.6 * 78 / iso, "isoSpeed": iso}
    frame = dg.Frame(rgb=rgb, metadata=facts)
    raw = frame.expose(SENSOR, iso, seed=1)
    raw.save(folder / "x.dng")
    raw.save(folder / "x.jpg", look="standard")
    frame.save(folder / "x.exr")


def measured(path: str) -> dict[str, Any]:
    """One match: seconds, memory, and what it found."""
    import OpenImageIO  # noqa: F401  (libraries are no part of it)
    import rawpy  # noqa: F401
    import tifffile  # noqa: F401

    from daguerre.plates.match.transfer import Transfer

    before = resident("VmRSS")
    start, spent = time.perf_counter(), time.process_time()
    found = dg.match_plate(path)
    clock, spent = time.perf_counter() - start, time.process_time() - spent
    row: dict[str, Any] = {
        "clock_s": clock,
        "processors_s": spent,
        "memory_mb": (resident("VmHWM") - before) / 1e6,
        "sigma_px": None if found.sharpness is None else found.sharpness.blur.sigma,
    }
    if isinstance(found.noise, Transfer):
        sensor, iso = dg.sensors.load(SENSOR), float(found.camera.iso)
        dark = float(np.hypot(sensor.read_noise_at(iso), sensor.dsnu))
        row["gain_error_percent"] = 100 * (found.noise.gain / sensor.gain(iso) - 1)
        row["read_noise_error_percent"] = 100 * (found.noise.read_noise / dark - 1)
    return row


def resident(key: str) -> int:
    """Bytes, now (VmRSS) or at most (VmHWM)."""
    lines = Path("/proc/self/status").read_text().splitlines()
    return int(next(line for line in lines if line.startswith(key)).split()[1]) << 10


def main() -> None:
    """Prints a line for each photograph, or JSON."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--size", default="6000x4000")
    parser.add_argument("--iso", type=float, default=400)
    parser.add_argument("--rounds", type=int, default=3)
    given = parser.parse_args()
    width, height = map(int, given.size.split("x"))
    context = multiprocessing.get_context("spawn")
    found: dict[str, Any] = {}
    with tempfile.TemporaryDirectory() as folder:
        with context.Pool(1) as pool:
            pool.apply(files, (Path(folder), width, height, given.iso))
        for ending in ("dng", "jpg", "exr"):
            rows = []
            for _ in range(given.rounds):
                with context.Pool(1) as pool:
                    rows.append(pool.apply(measured, (f"{folder}/x.{ending}",)))
            best = rows[0]
            found[ending] = {
                key: None if value is None else round(statistics.median(r[key] for r in rows), 3)
                for key, value in best.items()
            }
    if given.json:
        print(json.dumps({"size": given.size, "iso": given.iso, "files": found}, indent=1))
        return
    for ending, row in found.items():
        print(f"{ending:4}" + "".join(f"  {key} {value}" for key, value in row.items()))


if __name__ == "__main__":
    main()
