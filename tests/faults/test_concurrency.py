"""Threads, forks, pools, asyncio, Ctrl-C: pictures are right or refused in words; none hangs."""

from __future__ import annotations

import asyncio
import sys
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import daguerre as dg
from daguerre.cached import cached_property

from .jobs import CASES, Job, jobs
from .process import ROOT, run

ROUNDS = 3
#: Python 3.12 and later warn of any fork beside a thread.
QUIET = ("-W", "ignore::DeprecationWarning")


@pytest.fixture(scope="module")
def given(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Job]:
    """Pictures to draw."""
    return jobs(tmp_path_factory.mktemp("jobs"))


@pytest.fixture(scope="module")
def alone(given: dict[str, Job]) -> dict[str, np.ndarray]:
    """Pixels of each as drawn alone."""
    return {key: job.draw() for key, job in given.items()}


def at_once(works: list[Callable[[], np.ndarray]]) -> list[np.ndarray]:
    """Results of works that begin at the same moment, each in a thread of its own."""
    start = threading.Barrier(len(works))

    def one(work: Callable[[], np.ndarray]) -> np.ndarray:
        start.wait()
        return work()

    with ThreadPoolExecutor(len(works)) as pool:
        return list(pool.map(one, works))


def test_threads_draw_what_one_draws_alone(
    given: dict[str, Job], alone: dict[str, np.ndarray]
) -> None:
    keys = [*given, "plain", "later", "lens"]  # some pictures twice
    for key, found in zip(keys, at_once([given[key].draw for key in keys]), strict=True):
        assert np.array_equal(found, alone[key]), key


def test_threads_ask_one_scene_for_two_times(given: dict[str, Job]) -> None:
    scene, times = given["plain"].scene, (0.1, 0.25, 0.6, 0.9)

    def asked(time: float) -> np.ndarray:
        return np.array([[i.transform for i in scene.at(time).instances] for _ in range(200)])

    alone = [asked(time) for time in times]
    for _ in range(ROUNDS):
        for found, wanted in zip(
            at_once([lambda t=t: asked(t) for t in times]), alone, strict=True
        ):
            assert np.array_equal(found, wanted)


def test_sessions_take_turns(given: dict[str, Job]) -> None:
    """Two sessions of one built scene draw parts in turn, in two threads."""

    def session(built: object = None) -> dg.Session:
        job = given["moving"]
        return dg.Session(job.scene, job.camera, resolution=(24, 16), built=built)

    def drawn(session: dg.Session) -> np.ndarray:
        for i in range(8):
            session.draw(i, i + 1)
        return session.frame().rgb

    first = session()
    wanted = drawn(session(first.built))
    both = [first, session(first.built)]
    for found in at_once([lambda s=s: drawn(s) for s in both]):
        assert np.array_equal(found, wanted)


def test_results_that_are_kept_hold_up_no_other_object() -> None:
    begun, goes_on = threading.Event(), threading.Event()

    class Slow:
        def __init__(self, waits: bool) -> None:
            self.waits = waits

        @cached_property
        def value(self) -> int:
            if self.waits:
                begun.set()
                assert goes_on.wait(20)
            return 1

    with ThreadPoolExecutor(2) as pool:
        first = pool.submit(lambda: Slow(True).value)
        assert begun.wait(20)
        try:
            assert pool.submit(lambda: Slow(False).value).result(timeout=20) == 1
        finally:
            goes_on.set()
        assert first.result() == 1
    kept = Slow(False)
    assert kept.value is kept.value
    assert vars(kept)["value"] == 1


def test_all_work_of_the_core_is_counted() -> None:
    """A scope that forks do not know of would be taken for one in which nothing is drawn."""
    files = [path for path in (ROOT / "core/bind").iterdir() if path.stem != "unlocked"]
    assert len(files) > 20
    assert [path.name for path in files if "gil_scoped_release" in path.read_text()] == []


@pytest.mark.parametrize("case", CASES)
def test_a_process(case: str, tmp_path: Path) -> None:
    """Forks, pools, Ctrl-C and ends of a program: see ``jobs``."""
    program = [sys.executable, *QUIET, "-m", "tests.faults.jobs"]
    done = run([*program, case, str(tmp_path)], timeout=300)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout == "ok\n"
    assert done.stderr == ""


def test_asyncio_draws_several_at_once(given: dict[str, Job], alone: dict[str, np.ndarray]) -> None:
    async def all_of_them() -> list[np.ndarray]:
        return await asyncio.gather(*(asyncio.to_thread(job.draw) for job in given.values()))

    for (key, wanted), found in zip(alone.items(), asyncio.run(all_of_them()), strict=True):
        assert np.array_equal(found, wanted), key


def test_asyncio_cancels_by_the_progress(given: dict[str, Job], tmp_path: Path) -> None:
    """A thread cannot be cancelled: the task is, and the render ends when its progress says so."""
    job, file = given["plain"], tmp_path / "kept.exr"
    settings = {"resolution": (96, 64), "spp": 256}
    begun, stops = threading.Event(), threading.Event()

    def progress(status: object) -> bool:
        begun.set()
        return not stops.is_set()

    def draw() -> dg.Frame:
        return dg.render(job.scene, job.camera, checkpoint=file, progress=progress, **settings)

    async def cancelled() -> None:
        task = asyncio.create_task(asyncio.to_thread(draw))
        await asyncio.to_thread(begun.wait)
        task.cancel()
        with pytest.raises(asyncio.CancelledError):
            await task
        stops.set()

    asyncio.run(cancelled())  # waits for the thread
    stops.clear()
    wanted = dg.render(job.scene, job.camera, **settings).rgb
    assert np.array_equal(draw().rgb, wanted)
    assert not file.exists()


AT_EXIT = """
import atexit, sys

def last():
    import daguerre as dg
    scene = dg.Scene()
    scene.set_environment(color=(1, 1, 1))
    kept = {"checkpoint": sys.argv[1]} if sys.argv[1:] else {}
    frame = dg.render(scene, dg.Camera(lens_model="pinhole"), resolution=(8, 6), spp=4, **kept)
    print(frame.samples.min())

atexit.register(last)  # before daguerre registers its own, so after it
import daguerre
"""


@pytest.mark.parametrize("kept", [(), ("checkpoint.exr",)], ids=["plain", "checkpoint"])
def test_a_function_called_at_the_exit_of_python_may_draw(
    tmp_path: Path, kept: tuple[str, ...]
) -> None:
    done = run([sys.executable, "-c", AT_EXIT, *kept], tmp_path, timeout=60, check=True)
    assert done.stdout == "4\n", done.stderr
