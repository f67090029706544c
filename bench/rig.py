"""Cost of a rig of four cameras over the sum of its cameras.

    python bench/rig.py --json [--rounds 5] [--spp 8]

Four calibrated cameras look at the chess set in daylight. ``drawing``: ``render_rig``, from the
loaded scene to four frames, over one building of the scene and the samples of each camera, drawn in
sessions that stand ready. ``calls``: the same over four calls of ``render``, each of which builds
the scene. Processor time on one thread; the least of several rounds, by turns, as other work only
adds to it. Wanted of ``drawing``: at most 1.05.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable
from typing import Any

import numpy as np
from projections import CHESS, SUNSET

import daguerre as dg
from daguerre.rendering.session import Session
from daguerre.setup.built_scene import BuiltScene

SIZE = (480, 270)
BROWN = (-0.28, 0.09, 1e-3, -2e-3, -0.01)
FISHEYE = (0.01, -0.003, 0.001, -2e-4)


def rig(base: dg.Camera) -> dict[str, dg.Camera]:
    """A stereo pair through a phone's numbers, another through a fisheye's."""
    found = {}
    for model, parameters in (("opencv", BROWN), ("kannala_brandt", FISHEYE)):
        projection = dg.Projection.of_field(model, SIZE, 50, parameters)
        still = base.with_(lens=None, focal_length=None, projection=projection, motion={})
        pair = dg.stereo_pair(still, 0.06)
        found |= {f"{model}, {side}": camera for side, camera in pair.items()}
    return found


def measure(rounds: int, spp: int) -> dict[str, Any]:
    """Seconds of the parts, and ratios."""
    scene = dg.load(CHESS)
    scene.set_environment(SUNSET)
    cameras = rig(scene.camera())
    options: dict[str, Any] = {"resolution": SIZE, "threads": 1}
    rows: list[tuple[float, ...]] = []
    for _ in range(rounds):
        whole = seconds(lambda: dg.render_rig(scene, cameras, spp=spp, **options))
        calls = seconds(
            lambda: [dg.render(scene, one, spp=spp, **options) for one in cameras.values()]
        )
        built, ready = None, []
        for camera in cameras.values():
            ready.append(Session(scene, camera, built=built, **options))
            built = ready[-1].built
        interval = ready[0].interval
        building = seconds(lambda at=interval: BuiltScene(scene, at))
        drawing = [seconds(lambda one=one: one.draw(0, spp)) for one in ready]
        rows.append((whole, calls, building, *drawing))
    whole, calls, building, *drawing = np.min(rows, axis=0)
    found = {
        "drawing": whole / (building + sum(drawing)),
        "calls": whole / calls,
        "rig_cpu_s": whole,
        "building_cpu_s": building,
    }
    return {name: round(float(value), 3) for name, value in found.items()}


def seconds(work: Callable[[], Any]) -> float:
    """Seconds of the processor."""
    started = time.process_time()
    work()
    return time.process_time() - started


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--json", action="store_true", help="accepted for symmetry; always JSON")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--spp", type=int, default=8)
    options = parser.parse_args()
    if not (CHESS.is_file() and SUNSET.is_file()):
        print(json.dumps({"skipped": f"no {CHESS} and {SUNSET}"}))
        return
    print(json.dumps(measure(options.rounds, options.spp), indent=2))


if __name__ == "__main__":
    main()
