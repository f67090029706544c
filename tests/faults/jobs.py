"""Pictures that threads and processes draw, and what they must be.

``python -m tests.faults.jobs CASE FOLDER`` is a process of its own, since its forks and its end are
what is tested. It says ``ok`` at its end.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time
from collections import Counter
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

import daguerre as dg

from .scene import write_scene

#: Seconds after which a child that waits is killed, which is a fault.
PATIENCE_S = 30


@dataclass(frozen=True)
class Job:
    """A picture."""

    scene: dg.Scene
    camera: dg.Camera
    settings: dict[str, Any] = field(default_factory=dict)

    def draw(self) -> np.ndarray:
        """Its pixels."""
        return dg.render(self.scene, self.camera, resolution=(24, 16), spp=4, **self.settings).rgb


def jobs(folder: Path) -> dict[str, Job]:
    """Pictures of one scene at two times, of another one, of lenses, flare and light paths."""
    path = folder / "s.glb"
    scene = dg.load(path if path.exists() else write_scene(path))
    scene.set_environment(color=(1, 0.9, 0.8))
    still = dg.load(path)
    still.set_environment(color=(0.2, 0.3, 1))
    one, two = scene.camera("left"), scene.camera("right")
    lens = one.with_(lens="double-gauss-50mm-f2", f_stop=2.8)
    return {
        "plain": Job(scene, one),
        "other": Job(still, two),
        "later": Job(scene.at(0.5), one),
        "moving": Job(scene.at(0.3), one.with_(shutter_angle=180)),
        "lens": Job(scene, lens),
        "flare": Job(scene, lens, {"flare": 1000, "light_paths": (1000, 0)}),
        "adaptive": Job(scene, one, {"noise": 0.2}),
    }


def drawn(job: Job) -> np.ndarray:
    """For pools, which want a function of a module."""
    return job.draw()


def forked(work: Callable[[], object], *, leave: bool = False) -> str:
    """Does some work in a fork: ``ok``, words of a ``DaguerreError``, or what went wrong.

    Args:
        work: Returns nothing, or what went wrong.
        leave: Whether the child ends as a program does, not as those of ``multiprocessing``.
    """
    begin, end = os.pipe()
    sys.stdout.flush()
    child = os.fork()
    if child:
        os.close(end)
        with os.fdopen(begin) as file:
            said = file.read()
        code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        return said if code == 0 else f"ended by {code}: {said}"
    signal.signal(signal.SIGALRM, signal.SIG_DFL)
    signal.alarm(PATIENCE_S)
    try:
        said = str(work() or "ok")
    except dg.DaguerreError as error:
        said = f"refused: {error}"
    except BaseException as error:
        said = f"{type(error).__name__}: {error}"
    os.write(end, said.encode())
    if leave:
        sys.exit(0)
    os._exit(0)


def redrawn(job: Job, wanted: np.ndarray) -> str:
    """Draws it again; nothing if it has the same bits."""
    return "" if np.array_equal(job.draw(), wanted) else "other bits"


def idle(folder: Path) -> None:
    """Forks after pictures were drawn and written, with all threads of libraries there."""
    frame = dg.render(
        (plain := jobs(folder)["plain"]).scene, plain.camera, resolution=(600, 400), spp=1
    )
    names = ("exr", "png", "jpg", "tif")

    def work(where: str) -> str:
        for name in names:
            frame.save(folder / f"{where}.{name}")
        given = jobs(folder)
        return "".join(redrawn(given[key], wanted) for key, wanted in alone.items())

    alone = {key: jobs(folder)[key].draw() for key in ("plain", "moving", "lens")}
    with ThreadPoolExecutor(1) as pool:  # a thread that has drawn and lives on
        pool.submit(jobs(folder)["lens"].draw).result()
        assert (said := forked(lambda: draws_alone(jobs(folder)["plain"]))) == "ok", said
    work("parent")
    for leave in (False, True):
        assert (said := forked(lambda: work("child"), leave=leave)) == "ok", said
        for name in names:
            one, two = (folder / f"{where}.{name}" for where in ("parent", "child"))
            assert one.read_bytes() == two.read_bytes(), name


def pool(folder: Path) -> None:
    """Draws in pools of processes of every kind, after the parent has drawn."""
    given = jobs(folder)
    alone = {key: job.draw() for key, job in given.items()}
    for kind in ("fork", "forkserver", "spawn"):
        with multiprocessing.get_context(kind).Pool(2) as processes:
            found = processes.map(drawn, given.values())
        for (key, wanted), got in zip(alone.items(), found, strict=True):
            assert np.array_equal(got, wanted), f"{kind}: {key}"


def drawing(folder: Path) -> None:
    """Forks at any instant while another thread draws; then within a pass, for certain."""
    given = jobs(folder)
    job, wanted = given["lens"], given["lens"].draw()
    ends = threading.Event()

    def work() -> None:
        while not ends.is_set():
            job.draw()

    thread = threading.Thread(target=work)
    thread.start()
    said = Counter(forked(lambda: redrawn(job, wanted), leave=i % 2 > 0) for i in range(20))
    ends.set()
    thread.join()
    assert all(text == "ok" or is_refusal(text) for text in said), said
    session, heard = dg.Session(job.scene, job.camera, resolution=(24, 16)), []

    def progress(share: float) -> bool:
        if not heard:
            heard.append(forked(lambda: redrawn(job, wanted)))
        return True

    session.draw(0, 64, progress)
    assert heard, "the callback was not called"
    assert all(map(is_refusal, heard)), heard
    assert redrawn(job, wanted) == ""
    with ThreadPoolExecutor(1) as pool:  # forks while the main thread, which has drawn, waits
        assert is_refusal(said := pool.submit(forked, lambda: redrawn(job, wanted)).result()), said


def aborting(folder: Path) -> None:
    """A child forked within a pass ends; its libraries, here one that aborts, must not clean up."""
    script = """
import ctypes, os, sys, threading
libc = ctypes.CDLL(None)
assert libc.__cxa_atexit(libc.abort, None, None) == 0  # as a destructor of a library does
import daguerre as dg
import tests.faults.jobs as jobs
job = jobs.jobs(jobs.Path(sys.argv[1]))["plain"]
began, forked = threading.Event(), threading.Event()
session = dg.Session(job.scene, job.camera, resolution=(24, 16))
progress = lambda share: began.set() or forked.wait()
threading.Thread(target=session.draw, args=(0, 64, progress), daemon=True).start()
began.wait()
if not (child := os.fork()):
    print("the child", end="")
    sys.exit(3)
forked.set()
print([os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])], flush=True)
os._exit(0)
"""
    done = subprocess.run(
        [sys.executable, "-c", script, str(folder)], capture_output=True, text=True
    )
    assert (done.stdout, done.stderr) == ("the child[3]\n", ""), done.stdout + done.stderr


def draws_alone(job: Job) -> str:
    """Draws; what is wrong if no thread of oneTBB helps where there are several cores."""

    def threads() -> int:
        return len(list(Path("/proc/self/task").iterdir()))

    before = threads()
    job.draw()
    helped = threads() > before
    return "" if helped or len(os.sched_getaffinity(0)) == 1 else "one thread drew"


def is_refusal(text: str) -> bool:
    """Whether a child said that it cannot draw, and what to do instead."""
    return text.startswith("refused: ") and "spawn or forkserver" in text


def writing(folder: Path) -> None:
    """Forks while another thread writes an .exr."""
    frame = dg.Frame(np.random.default_rng(1).random((256, 256, 3), np.float32))
    frame.save(folder / "a.exr")  # no module is imported while it forks
    ended = threading.Event()

    def work() -> None:
        while not ended.is_set():
            frame.save(folder / "a.exr")

    thread = threading.Thread(target=work)
    thread.start()
    try:
        said = [forked(lambda: frame.save(folder / "b.exr")) for _ in range(8)]
    finally:
        ended.set()
        thread.join()
    assert said == ["ok"] * 8, said


def interrupt(folder: Path) -> None:
    """Ctrl-C in the main thread, while another one draws and keeps its samples."""
    job = jobs(folder)["plain"]
    settings: dict[str, Any] = {"resolution": (96, 64), "spp": 64}
    wanted = dg.render(job.scene, job.camera, **settings).rgb
    found: list[np.ndarray] = []
    began = threading.Event()

    def work() -> None:
        frame = dg.render(
            job.scene, job.camera, checkpoint=folder / "c.exr",
            progress=lambda status: began.set(), **settings,
        )  # fmt: skip
        found.append(frame.rgb)

    thread = threading.Thread(target=work)
    thread.start()
    try:
        began.wait()
        signal.raise_signal(signal.SIGINT)
        time.sleep(10)
    except KeyboardInterrupt:
        thread.join()
    assert np.array_equal(found[0], wanted)


def leave(folder: Path) -> None:
    """Ends while daemon threads draw; what takes them minutes is not waited for."""
    job = jobs(folder)["plain"]
    session = dg.Session(job.scene, job.camera, resolution=(2560, 1440))
    began = threading.Event()

    def long() -> None:
        session.draw(0, 100, lambda share: began.set() or True)

    def short() -> None:
        while True:
            job.draw()

    for work in (long, short, short):
        threading.Thread(target=work, daemon=True).start()
    began.wait()


CASES = {case.__name__: case for case in (idle, pool, drawing, aborting, writing, interrupt, leave)}

if __name__ == "__main__":
    os.environ["SOURCE_DATE_EPOCH"] = "0"  # the date of a file is no part of its picture
    CASES[sys.argv[1]](Path(sys.argv[2]))
    print("ok", flush=True)
