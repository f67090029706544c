"""Renders one picture by two processes, each some of its samples, and adds them exactly.

    python examples/worker.py SCENE.glb [FOLDER]        (default: out)

Shows: a render farm in a few lines. A worker gets a range of samples and leaves a pass file; the
passes add up in any order to the bits of a render in one go. Workers can be other machines.
"""

from __future__ import annotations

import sys
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import daguerre as dg
from daguerre.rendering import Job, Output, Picture, View

WORKERS = 2


def draw(scene: str, file: Path, settings: dg.RenderSettings, samples: tuple[int, int]) -> Path:
    """Draws samples [begin, end) of every pixel into a pass file."""
    output = Output((file,), is_pass=True)
    Job(dg.load(scene), [Picture(View(), settings, output, samples)]).run(resume=True)
    return file


def main(scene: str, folder: str = "out", width: int = 480, spp: int = 64) -> dg.Frame:
    """Renders passes of 16 samples by two processes and merges them."""
    Path(folder).mkdir(parents=True, exist_ok=True)
    settings = dg.RenderSettings.of(resolution=(width, 9 * width // 16), spp=spp, threads=1)
    ranges = [(a, min(a + 16, spp)) for a in range(0, spp, 16)]
    with ProcessPoolExecutor(WORKERS, mp_context=get_context("spawn")) as pool:
        files = [Path(folder, f"pass_{a:06}.exr") for a, _ in ranges]
        work = [
            pool.submit(draw, scene, f, settings, r) for f, r in zip(files, ranges, strict=True)
        ]
        passes = [one.result() for one in work]
    return dg.merge(passes, [f"{folder}/worker.exr", f"{folder}/worker.png"], strict=True)


if __name__ == "__main__":
    main(*sys.argv[1:3])
