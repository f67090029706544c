"""Cost of one wheel for all Pythons: the same calls through nanobind as a package and linked.

Usage: bench/wheel.py LINKED SPLIT [--rounds N]: two Python interpreters, one with a build from
source, one with the wheel (script/make-wheels). Alternates them and prints nanoseconds per call and
CPU seconds per render, at their best, and their ratio.
"""

from __future__ import annotations

import argparse
import json
import subprocess

INSIDE = """
import json, resource, timeit
import numpy as np
import daguerre as dg
from daguerre import _core

def cpu():
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime

def ns(call, count):
    return min(timeit.repeat(call, number=count, repeat=7)) / count * 1e9

def picture():
    scene = dg.Scene()
    scene.add_mesh(np.array([[-1, -1, -3], [1, -1, -3], [0, 1, -3]]), np.array([[0, 1, 2]]))
    scene.set_environment(color=(1, 1, 1))
    camera = dg.Camera(lens="double-gauss-50mm-f2", f_stop=2.0, focus_distance=3.0)
    begun = cpu()
    dg.render(scene, camera, resolution=(480, 320), spp=32, threads=2)
    return cpu() - begun

plane = np.zeros((4, 4), np.float32)
lens = dg.lenses.load("double-gauss-50mm-f2")
origin, direction = np.zeros((1, 3)), np.array([[0, 0, -1.0]])
print(json.dumps({
    "a number in and out (ns)": ns(lambda: _core.air_index(550.0), 200_000),
    "a list out (ns)": ns(lambda: _core.rgb_from_xyz((1.0, 1.0, 1.0)), 100_000),
    "an array in and out (ns)": ns(lambda: _core.mean_of_next_colour(plane, 1), 50_000),
    "a render (CPU s)": min(picture() for _ in range(3)),
}))
"""


def measured(python: str) -> dict[str, float]:
    """Returns what one process of an interpreter measured."""
    done = subprocess.run([python, "-c", INSIDE], capture_output=True, text=True, check=True)
    figures: dict[str, float] = json.loads(done.stdout)
    return figures


def main() -> None:
    """Prints a table."""
    parser = argparse.ArgumentParser(description="cost of the stable-ABI wheel")
    parser.add_argument("linked", help="interpreter with a build from source")
    parser.add_argument("split", help="interpreter with the wheel")
    parser.add_argument("--rounds", type=int, default=5)
    options = parser.parse_args()
    rounds = [(measured(options.linked), measured(options.split)) for _ in range(options.rounds)]
    for name in rounds[0][0]:
        linked = min(one[name] for one, _ in rounds)
        split = min(other[name] for _, other in rounds)
        print(f"{name:28} linked {linked:9.3f}   wheel {split:9.3f}   ratio {split / linked:.3f}")


if __name__ == "__main__":
    main()
