"""How long 24 MP take from exposure to file, and how much memory.

Usage: bench/development.py [--json] [--sensor NAME] [--size WIDTHxHEIGHT]

Each step runs in a process of its own, which has the frame already; the memory is the largest that
the process had, less what it had with the frame alone, plus the frame (RGB as float32).
Goals: expose + DNG 3 s, DNG to JPEG 4 s on two cores, memory at most 6 frames.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import daguerre as dg

FACTS = {"expTime": 1 / 125, "aperture": 2.8, "luminance_exposure": 0.5, "isoSpeed": 400}


def frame_of(width: int, height: int) -> dg.Frame:
    """Lamps and gradients of all colours: nothing that compresses to nothing."""
    x = np.linspace(0, 1, width, dtype=np.float32)[None]
    y = np.linspace(0, 1, height, dtype=np.float32)[:, None]
    waves = [0.11 + 0.1 * np.sin(40 * x * (k + 1) + 25 * y + k) for k in range(3)]
    return dg.Frame(rgb=np.stack(waves, axis=2), metadata=dict(FACTS))


def steps(sensor: str, folder: Path) -> dict[str, Callable[[dg.Frame], Any]]:
    """By name; each takes a frame."""
    raw_file = folder / "x.dng"

    def dng(frame: dg.Frame) -> None:
        frame.expose(sensor, iso=400).save(raw_file)

    def jpeg_of_raw(frame: dg.Frame) -> None:
        frame.expose(sensor, iso=400).save(folder / "x.jpg")

    def jpeg_of_dng(_: dg.Frame) -> None:
        from daguerre.development.camera_raw import read_shot

        dg.development.develop(read_shot(raw_file), look="standard").save(folder / "y.jpg")

    def jpeg_of_frame(frame: dg.Frame) -> None:
        dg.development.develop(frame, look="standard").save(folder / "z.jpg")

    def sharp_jpeg_of_dng(_: dg.Frame) -> None:
        from daguerre.development.camera_raw import read_shot

        picture = dg.development.develop(read_shot(raw_file), look="standard", sharpen=0.5)
        picture.save(folder / "s.jpg")

    return {
        "expose + DNG": dng,
        "expose + JPEG": jpeg_of_raw,
        "DNG to JPEG": jpeg_of_dng,
        "DNG to JPEG, sharpened": sharp_jpeg_of_dng,
        "frame to JPEG": jpeg_of_frame,
    }


def measured(name: str, sensor: str, folder: str, width: int, height: int) -> dict[str, float]:
    """One step: seconds on the clock and of all processors, memory in frames."""
    import OpenImageIO  # noqa: F401  (libraries are no part of it)
    import rawpy  # noqa: F401
    import tifffile  # noqa: F401

    frame = frame_of(width, height)
    step = steps(sensor, Path(folder))[name]
    small = frame_of(64, 64)
    if name.startswith("expose"):
        small.expose(sensor, iso=400)
    before = resident("VmRSS")
    clock, spent = time.perf_counter(), time.process_time()
    step(frame)
    clock, spent = time.perf_counter() - clock, time.process_time() - spent
    peak = resident("VmHWM") - before
    return {
        "clock_s": round(clock, 2),
        "processors_s": round(spent, 2),
        "memory_frames": round(1 + peak / frame.rgb.nbytes, 2),
    }


def resident(key: str) -> int:
    """Bytes, now (VmRSS) or at most (VmHWM); ru_maxrss would count the process before this one."""
    lines = Path("/proc/self/status").read_text().splitlines()
    return int(next(line for line in lines if line.startswith(key)).split()[1]) << 10


def main() -> None:
    """Prints a table, or JSON."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--sensor", default="sony-a7r-ii")
    parser.add_argument("--size", default="6000x4000")
    given = parser.parse_args()
    width, height = map(int, given.size.split("x"))
    context = multiprocessing.get_context("spawn")
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        for name in steps(given.sensor, Path(folder)):
            with context.Pool(1) as pool:
                arguments = (name, given.sensor, folder, width, height)
                found[name] = pool.apply(measured, arguments)
    if given.json:
        print(json.dumps({"sensor": given.sensor, "size": given.size, "steps": found}, indent=1))
        return
    print(f"{given.size}, {given.sensor}")
    for name, row in found.items():
        print(f"{name:24}" + "".join(f"  {key} {value:6.2f}" for key, value in row.items()))


if __name__ == "__main__":
    main()
