"""The price of Cryptomatte: CPU time and memory with mattes and without.

    python bench/cryptomatte.py [--json] [--spp 64] [--res 480x320] [--runs 5]

Two scenes: ``few``, a dozen balls on a ground; ``many``, 20,000 small balls out of focus. ``ratio``
is the CPU time with all three layers over that without, the median of pairs that are run one after
the other; ``low`` and ``high`` are the least and the largest pair. ``bytes`` is what the lists of
the film take for each pixel, ``names`` the mean number of objects in one.
"""

from __future__ import annotations

import argparse
import json
import statistics
from collections.abc import Callable
from typing import Any

import numpy as np
from catchers import ball, cpu

import daguerre as dg
from daguerre.rendering.session import Session

HEAD, ENTRY = 4, 16  # bytes of the film per pixel, and of each object in it


def scene(count: int, radius: float, depth: float) -> dg.Scene:
    """Balls at random places before the camera, each with a name, over a ground."""
    made = dg.Scene()
    corners = np.array([(-30, -1.2, 10), (30, -1.2, 10), (30, -1.2, -60), (-30, -1.2, -60)])
    ground = made.add_mesh(corners, np.array([(0, 1, 2), (0, 2, 3)]))
    made.add_instance(ground, dg.Diffuse((0.4, 0.4, 0.4)), name="ground")
    mesh = made.add_mesh(*ball(12, radius))
    colors = [made.add_material(dg.Diffuse(c)) for c in ((0.7, 0.2, 0.1), (0.1, 0.3, 0.7))]
    rng = np.random.default_rng(1)
    for i in range(count):
        far = rng.uniform(2, depth)
        pose = np.eye(4)
        pose[:3, 3] = rng.uniform(-0.4, 0.4) * far, rng.uniform(-0.25, 0.25) * far, -far
        made.add_instance(mesh, colors[i % 2], pose, name=f"ball {i}")
    made.set_environment(color=(0.5, 0.6, 0.8))
    return made


SCENES: dict[str, tuple[Callable[[], dg.Scene], dg.Camera]] = {
    "few": (lambda: scene(12, 0.35, 5.0), dg.Camera(f_stop=2.8, focus_distance=3.0)),
    "many": (lambda: scene(20000, 0.03, 12.0), dg.Camera(f_stop=1.4, focus_distance=1.0)),
}


def measure(name: str, size: tuple[int, int], spp: int, runs: int) -> dict[str, float]:
    """Pairs of pictures of one scene, with mattes and without."""
    make, camera = SCENES[name]
    made = make()
    options: dict[str, Any] = {"resolution": size, "light_paths": "off"}
    built = Session(made, camera, **options).built
    ratios = []
    for _ in range(runs):
        plain = Session(made, camera, built=built, **options)
        keeps = Session(made, camera, built=built, cryptomatte="object,material,asset", **options)
        times = [cpu(lambda session=session: session.draw(0, spp))[1] for session in (keeps, plain)]
        ratios.append(times[0] / times[1])
    words = keeps.state()["objects"]
    entries = int((words[:, :, 0] != 0xFFFFFFFF).sum())
    pixels = size[0] * size[1]
    return {
        "ratio": statistics.median(ratios),
        "low": min(ratios),
        "high": max(ratios),
        "bytes": HEAD + ENTRY * entries / pixels,
        "names": entries / pixels,
    }


def main() -> None:
    """Prints a line for each scene."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--res", default="480x320")
    parser.add_argument("--runs", type=int, default=5)
    arguments = parser.parse_args()
    width, height = map(int, arguments.res.split("x"))
    found = {name: measure(name, (width, height), arguments.spp, arguments.runs) for name in SCENES}
    if arguments.json:
        print(json.dumps(found))
        return
    for name, one in found.items():
        print(
            f"{name:5} CPU with mattes {one['ratio']:.3f} of that without "
            f"({one['low']:.3f} to {one['high']:.3f}); {one['names']:.1f} objects and "
            f"{one['bytes']:.0f} bytes per pixel"
        )


if __name__ == "__main__":
    main()
