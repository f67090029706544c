"""Draws many pictures in one process: ``python -m tests.faults.long_run renders|frames 2000``.

Prints how the memory of the process grew from the first tenth of the pictures to the last one, and
how much each picture keeps. A process keeps what it once had; what is in use tells more.
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

    def growth(self) -> float:
        """Memory of the process in the last tenth less that in the first one, MB."""
        first, *_, last = _tenths(self.process)
        return last - first

    def steady(self) -> tuple[float, float]:
        """Bytes that each picture keeps, of malloc and of objects: the median over the tenths.

        A table that grows once, as that of Python's known words, is a step between two of them.
        """
        kept = len(self.process) // 10 / 1e6
        of_malloc, of_objects = (
            float(np.median(np.diff(_tenths(line)))) / kept for line in (self.malloc, self.objects)
        )
        return of_malloc, of_objects


def _tenths(line: np.ndarray) -> list[float]:
    """Means over the tenths; the very first pictures are left out."""
    skip = min(20, len(line) // 20)
    return [
        float(part[skip * (i == 0) :].mean()) for i, part in enumerate(np.array_split(line, 10))
    ]


class Meter:
    """Notes the memory after each picture, and needs none for it."""

    def __init__(self, count: int) -> None:
        self.noted, self.count = np.zeros((3, count)), 0

    def note(self) -> None:
        """Notes it as it is now."""
        if self.count % 10 == 0:  # circles of objects would hide what is kept
            gc.collect()
        used = _mallinfo2()
        pages = int(Path("/proc/self/statm").read_text().split()[1])
        objects = tracemalloc.get_traced_memory()[0]
        self.noted[:, self.count] = pages * PAGE, used.uordblks + used.hblkhd, objects
        self.count += 1

    def memory(self) -> Memory:
        """All that was noted."""
        return Memory(*self.noted / 1e6)


def renders(count: int, folder: Path) -> Memory:
    """Calls ``dg.render`` that often, with a scene, a camera and a lens that change."""
    scene = dg.load(write_scene(folder / "s.glb"))
    scene.set_environment(color=(1, 0.9, 0.8))
    meter = Meter(count)
    for i in range(count):
        lens = {"lens": "double-gauss-50mm-f2"} if i % 4 == 0 else {"lens_model": "thin"}
        camera = scene.camera("left").with_(f_stop=2.8, **lens)
        dg.render(scene, camera, resolution=(24, 16), spp=1, seed=i)
        meter.note()
    return meter.memory()


def frames(count: int, folder: Path) -> Memory:
    """Draws a sequence of that many frames by one call of the command line."""
    meter, finish = Meter(count), Job._render

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


def main(kind: str, count: int, leak: int = 0) -> None:
    """Prints the figures.

    Args:
        kind: Either ``renders`` or ``frames``.
        count: Number of pictures.
        leak: Bytes that each picture keeps, to show that it would be seen.
    """
    if leak:
        note, kept = Meter.note, []
        Meter.note = lambda self: (kept.append(bytes(leak)), note(self))[1]  # type: ignore[method-assign]
    if not tracemalloc.is_tracing():  # better by -X tracemalloc, before any module is there
        tracemalloc.start()
    with TemporaryDirectory() as folder:
        memory = {"renders": renders, "frames": frames}[kind](count, Path(folder))
    line, (malloc, objects) = memory.process, memory.steady()
    print(
        f"{kind}: {count}: process {line[:20].mean():.1f} MB at first, {line[-20:].mean():.1f} MB "
        f"at the end, growth {memory.growth():+.2f} MB; each keeps {malloc:+.0f} B of malloc, "
        f"{objects:+.0f} B of objects"
    )


if __name__ == "__main__":
    main(sys.argv[1], *map(int, sys.argv[2:]))
