"""Time to read stages of USD: the chess set, and 10^5 copies by a point instancer.

``open_s`` is USD's own opening of the stage, in a process of its own; ``picture_s`` is the whole
of ``daguerre render`` at 960 x 540, 1 spp, from launch to the file on disk; ``beyond_s`` is the
difference. An untimed launch comes first: it writes Python's bytecode, as an installation does.
``copies_s`` is ``dg.load`` of the instancer, ``moving_s`` that of one whose copies have two
samples. Medians of runs, wall time. The result is JSON.

    python bench/usd.py [--chess OpenChessSet/chess_set.usda] [--runs 5]
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from pxr import Gf, Usd, UsdGeom, Vt

import daguerre as dg

_COPIES = 100_000
_OPEN = "import sys; from pxr import Usd; Usd.Stage.Open(sys.argv[1])"


def median(act: Callable[[], object], runs: int) -> float:
    """Median wall time, s."""
    times = []
    for _ in range(runs):
        before = time.perf_counter()
        act()
        times.append(time.perf_counter() - before)
    return round(statistics.median(times), 2)


def crowd(path: Path, *, moving: bool = False) -> Path:
    """Writes a stage of many copies of a cube, at rest or with positions at two times."""
    stage = Usd.Stage.CreateNew(str(path))
    made = UsdGeom.PointInstancer.Define(stage, "/crowd")
    UsdGeom.Cube.Define(stage, "/crowd/cube")
    made.CreatePrototypesRel().AddTarget("/crowd/cube")
    rng = np.random.default_rng(0)
    turns = rng.normal(size=(_COPIES, 4))
    turns /= np.linalg.norm(turns, axis=1, keepdims=True)
    made.CreateProtoIndicesAttr(Vt.IntArray([0] * _COPIES))
    places = np.ascontiguousarray(rng.uniform(-900, 900, (_COPIES, 3)), np.float32)
    positions = made.CreatePositionsAttr(Vt.Vec3fArray.FromNumpy(places))
    for code in (0, 1) if moving else ():
        positions.Set(Vt.Vec3fArray.FromNumpy(places + np.float32(code)), code)
    made.CreateOrientationsAttr(Vt.QuathArray([Gf.Quath(*map(float, turn)) for turn in turns]))
    stage.GetRootLayer().Save()
    return path


def main() -> None:
    """Measures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--chess", type=Path)
    parser.add_argument("--runs", type=int, default=5)
    given = parser.parse_args()
    found: dict[str, float] = {}
    with tempfile.TemporaryDirectory() as folder:
        stage = crowd(Path(folder) / "crowd.usdc")
        moving = crowd(Path(folder) / "moving.usdc", moving=True)
        found["copies_s"] = median(lambda: dg.load(stage), given.runs)
        found["moving_s"] = median(lambda: dg.load(moving), given.runs)
        if given.chess is not None:
            command = [sys.executable, "-m", "daguerre", "render", str(given.chess)]
            command += ["--res", "960x540", "--spp", "1", "--sky", "1,1,1", "--quiet"]
            command += ["-o", f"{folder}/out.png"]

            variables = os.environ | {"PYTHONPYCACHEPREFIX": f"{folder}/bytecode"}
            variables.pop("PYTHONDONTWRITEBYTECODE", None)

            def run(words: list[str]) -> None:
                subprocess.run(words, check=True, capture_output=True, env=variables)

            opened = [sys.executable, "-c", _OPEN, str(given.chess)]
            run(command)
            found["open_s"] = median(lambda: run(opened), given.runs)
            found["picture_s"] = median(lambda: run(command), given.runs)
            found["beyond_s"] = round(found["picture_s"] - found["open_s"], 2)
    print(json.dumps(found, indent=1))


if __name__ == "__main__":
    main()
