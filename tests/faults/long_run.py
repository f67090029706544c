"""Draws many pictures in one process: ``python -m tests.faults.long_run renders|frames 2000``.

Prints how memory grew, MB, from the first tenth of the pictures to the last one: that of the
process, which keeps what it once had, and what is in use in it, of malloc and of Python's objects.
"""

from __future__ import annotations

import ctypes
import gc
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


class _MallInfo2(ctypes.Structure):
    """Counts of glibc's malloc, bytes (mallinfo(3))."""

    _fields_ = (
        ("arena", ctypes.c_size_t * 4),
        ("hblkhd", ctypes.c_size_t),
        ("fsmblks", ctypes.c_size_t * 2),
        ("uordblks", ctypes.c_size_t),
        ("fordblks", ctypes.c_size_t * 2),
    )


_mallinfo2 = ctypes.CDLL(None).mallinfo2
_mallinfo2.restype = _MallInfo2


@dataclass(frozen=True)
class Memory:
    """Memory over the pictures, MB, each of shape (pictures,).

    Attributes:
        process: Memory of the process: what it needs, and what malloc keeps for later.
        malloc: Memory in use of malloc, in all of its arenas: the core, libraries, large arrays.
        objects: Memory in use of Python's objects.
    """

    process: np.ndarray
    malloc: np.ndarray
    objects: np.ndarray

    def growth(self) -> tuple[float, float, float]:
        """Mean of the last tenth less that of the first one, MB; the very first are left out."""
        tenth = max(len(self.process) // 10, 1)
        skip = min(20, tenth // 2)
        return tuple(  # type: ignore[return-value]
            float(line[-tenth:].mean() - line[skip:tenth].mean())
            for line in (self.process, self.malloc, self.objects)
        )


class Meter:
    """Notes the memory after each picture."""

    def __init__(self) -> None:
        self.process: list[float] = []
        self.malloc: list[float] = []
        self.objects: list[float] = []

    def note(self) -> None:
        """Notes it as it is now."""
        pages = int(Path("/proc/self/statm").read_text().split()[1])
        self.process.append(pages * PAGE / 1e6)
        if len(self.process) % 10 == 1:  # circles of objects would hide what is kept
            gc.collect()
        used = _mallinfo2()
        self.malloc.append((used.uordblks + used.hblkhd) / 1e6)
        self.objects.append(tracemalloc.get_traced_memory()[0] / 1e6)

    def memory(self) -> Memory:
        """All that was noted."""
        return Memory(*map(np.array, (self.process, self.malloc, self.objects)))


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
    if not tracemalloc.is_tracing():  # better by -X tracemalloc, before any module is there
        tracemalloc.start()
    with TemporaryDirectory() as folder:
        memory = {"renders": renders, "frames": frames}[kind](count, Path(folder))
    process, malloc, objects = memory.growth()
    line = memory.process
    print(
        f"{kind}: {count}: process {line[:20].mean():.1f} MB at first, {line[-20:].mean():.1f} MB "
        f"at the end, growth {process:+.2f} MB; in use of malloc {malloc:+.3f} MB, "
        f"of objects of Python {objects:+.3f} MB"
    )


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
