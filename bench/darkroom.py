"""24 MP distortion through the map of a lens, against OpenCV's map and remap with cubics.

    python bench/darkroom.py [--size 6000x4000] [--rounds 5] [--lens NAME] [--json]

Both bend the same float RGB picture on all cores; rounds alternate, and the ratio is that of the
medians. Ours: the map from chief rays, for one colour and for three (lateral colour), then the
picture. OpenCV: ``initUndistortRectifyMap`` (5 coefficients) and ``remap`` with INTER_CUBIC.
Wanted: at most 1.5 times OpenCV's time, the map included. ``cpu`` is of both cores; ``user`` is
the same without the kernel, which clears fresh pages: in a virtual machine whose host takes free
memory back that is slow, and most for who takes most of it. ``peak_mb`` is what ``daguerre post``
takes for the same as files, above the imported package (Linux only).
"""

from __future__ import annotations

import argparse
import json
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np

from daguerre import lenses
from daguerre.analysis.bench import set_up
from daguerre.distortion.lens import LensDistortion
from daguerre.post import distort
from daguerre.post.effects.distortion import CHANNEL_NM

CHILD = """
import json, sys
import daguerre, OpenEXR
def resident(key):  # ru_maxrss would count the process that started this one
    lines = open("/proc/self/status").read().splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith(key)) * 1024
before = resident("VmRSS")
from daguerre.cli import main
code = main(sys.argv[1:])
print(json.dumps({"code": code or 0, "peak_mb": (resident("VmHWM") - before) / 1e6}))
"""


def timed(job: Callable[[], object]) -> dict[str, float]:
    """Seconds by kind."""
    wall, before = time.perf_counter(), resource.getrusage(resource.RUSAGE_SELF)
    job()
    after = resource.getrusage(resource.RUSAGE_SELF)
    user = after.ru_utime - before.ru_utime
    kernel = after.ru_stime - before.ru_stime
    return {"": time.perf_counter() - wall, "_cpu": user + kernel, "_user": user}


def opencv(image: np.ndarray, focal: float) -> None:
    """Map and picture."""
    height, width = image.shape[:2]
    matrix = np.array([[focal, 0, width / 2 - 0.5], [0, focal, height / 2 - 0.5], [0, 0, 1]])
    numbers = np.array([-0.15, 0.02, 0.001, -0.002, 0.003])
    size = (width, height)
    x, y = cv2.initUndistortRectifyMap(matrix, numbers, np.eye(3), matrix, size, cv2.CV_32FC1)
    cv2.remap(image, x, y, cv2.INTER_CUBIC)


def ours(image: np.ndarray, name: str, wavelengths: tuple[float, ...]) -> None:
    """Chief rays, maps and picture."""
    pitch = 36 / image.shape[1]
    bench = set_up(lenses.load(name))
    models = LensDistortion.of_colours(bench, 22.0, wavelengths)
    distort(image, models, focal_px=models[0].focal_length_mm / pitch)


def peak_mb(image: np.ndarray, name: str) -> float:
    """Peak memory of the command line, from file to file, MB."""
    import OpenEXR

    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder) / "in.exr", Path(folder) / "out.exr"
        kind = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
        with OpenEXR.File(kind, {"RGB": image}) as file:
            file.write(str(source))
        effect = f"distortion:model=lens,lens={name},sensor=36x24"
        words = ["post", str(source), "-o", str(target), "--effect", effect, "--quiet"]
        run = subprocess.run(
            [sys.executable, "-c", CHILD, *words], capture_output=True, text=True, check=True
        )
    return float(json.loads(run.stdout)["peak_mb"])


def main() -> int:
    """Prints a line for each number."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--size", default="6000x4000")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--lens", default="canon-ef-11-24mm-f4")
    parser.add_argument("--json", action="store_true")
    given = parser.parse_args()
    width, height = map(int, given.size.split("x"))
    image = np.random.default_rng(1).random((height, width, 3), dtype=np.float32)
    jobs: dict[str, Callable[[], object]] = {
        "opencv": lambda: opencv(image, 0.83 * width),
        "one_colour": lambda: ours(image, given.lens, CHANNEL_NM[1:2]),
        "three_colours": lambda: ours(image, given.lens, CHANNEL_NM),
    }
    rounds = [{name: timed(job) for name, job in jobs.items()} for _ in range(given.rounds + 1)][1:]
    result = {"size": given.size, "lens": given.lens, "threads": cv2.getNumThreads()}
    for kind in ("", "_cpu", "_user"):
        took = {name: statistics.median(r[name][kind] for r in rounds) for name in jobs}
        result |= {f"{name}{kind}_s": round(took[name], 3) for name in jobs}
        for name in ("one_colour", "three_colours"):
            result[f"{name}{kind}_ratio"] = round(took[name] / took["opencv"], 2)
    result["peak_mb"] = round(peak_mb(image, given.lens))
    if given.json:
        print(json.dumps(result))
    else:
        print("\n".join(f"{key:20} {value}" for key, value in result.items()))
    return 0


if __name__ == "__main__":
    sys.exit(main())
