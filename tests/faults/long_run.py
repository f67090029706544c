"""Draws many pictures in one process: ``python -m tests.faults.long_run renders|frames 2000``.

Prints the memory of the process and of Python's objects, MB, as means over the first and the last
tenth of the pictures.
"""

from __future__ import annotations

import os
import sys
import tracemalloc
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

import daguerre as dg
from daguerre.cli import main as program
from daguerre.rendering.job import Job
from daguerre.rendering.picture import Picture

from .scene import write_scene

PAGE = os.sysconf("SC_PAGE_SIZE")


@dataclass(frozen=True)
class Memory:
    """Memory over the pictures: of the process and of Python's objects, MB, shape (pictures,)."""

    process: np.ndarray
    objects: np.ndarray

    def growth(self) -> tuple[float, float]:
        """Mean of the last tenth less that of the first one, MB; the very first are left out."""
        tenth = max(len(self.process) // 10, 1)
        skip = min(20, tenth // 2)
        return tuple(  # type: ignore[return-value]
            float(line[-tenth:].mean() - line[skip:tenth].mean())
            for line in (self.process, self.objects)
        )


class Meter:
    """Notes the memory after each picture."""

    def __init__(self) -> None:
        self.process: list[float] = []
        self.objects: list[float] = []

    def note(self) -> None:
        """Notes it as it is now."""
        pages = int(Path("/proc/self/statm").read_text().split()[1])
        self.process.append(pages * PAGE / 1e6)
        self.objects.append(tracemalloc.get_traced_memory()[0] / 1e6)

    def memory(self) -> Memory:
        """All that was noted."""
        return Memory(np.array(self.process), np.array(self.objects))


def renders(count: int, folder: Path) -> Memory:
    """Calls ``dg.render`` that often, with a scene, a camera and a lens that change."""
    scene = dg.load(write_scene(folder / "s.glb"))
    scene.set_environment(color=(1, 0.9, 0.8))
    meter = Meter()
    for i in range(count):
        lens = {"lens": "double-gauss-50mm-f2"} if i % 4 == 0 else {"lens_model": "thin"}
        camera = scene.camera("left").with_(f_stop=2.8, **lens)
        dg.render(scene, camera, resolution=(24, 16), spp=1, seed=i)
        meter.note()
    return meter.memory()


def frames(count: int, folder: Path) -> Memory:
    """Draws a sequence of that many frames by one call of the command line."""
    meter, finish = Meter(), Job._render

    def drawn(self: Job, picture: Picture, began: float, *, resume: bool) -> bool:
        done = finish(self, picture, began, resume=resume)
        meter.note()
        return done

    Job._render = drawn  # type: ignore[method-assign]
    try:
        out = str(folder / "f.####.exr")
        words = ["render", str(write_scene(folder / "s.glb")), "-o", out, "--quiet"]
        words += ["--camera", "left", "--res", "24x16", "--spp", "1", "--sky", "1,1,1"]
        assert program([*words, "--frames", f"0-{count - 1}", "--fps", str(count)]) == 0
    finally:
        Job._render = finish  # type: ignore[method-assign]
    return meter.memory()


def main(kind: str, count: int) -> None:
    """Prints the figures."""
    tracemalloc.start()
    with TemporaryDirectory() as folder:
        memory = {"renders": renders, "frames": frames}[kind](count, Path(folder))
    process, objects = memory.growth()
    line = memory.process
    print(
        f"{kind}: {count}: process {line[:20].mean():.1f} MB at first, {line[-20:].mean():.1f} MB "
        f"at the end, growth {process:+.2f} MB; objects of Python {objects:+.3f} MB"
    )


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
