"""Cost of a cluster: time against one process, the client's work per pass, and how far it scales.

Usage: bench/cluster.py [--only NAME ...] [--json FILE]

``local``: the demo scene by two local workers of one thread and by one process of two threads,
start-up apart. ``start``: from nothing to the first sums of a local cluster. ``sequence``: eight
frames of 4K by two workers, against one process. ``client``: CPU per answer of 960 x 540.
``scale``: the real client against fake workers in this process, which answer with a recorded pass.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import socket
import statistics
import subprocess
import sys
import tempfile
import time
from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import daguerre as dg
from daguerre.cli.demo import write_scene
from daguerre.cluster import task as on_worker
from daguerre.cluster.address import connected
from daguerre.cluster.answers import Sums, answer_of, head_line, packed_sums
from daguerre.cluster.opened import opened
from daguerre.cluster.pool import WorkerPool
from daguerre.cluster.work import work_of
from daguerre.rendering.session import Session

LENS = "double-gauss-50mm-f2"
#: Time in which fake workers draw a sample, s; and time that a simulation lasts, s.
SAMPLE_S, LASTS_S = 1.0, 60.0


def scene_and_camera() -> tuple[dg.Scene, dg.Camera]:
    """The demo scene through its lens."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "scene.glb"
        write_scene(path)
        scene = dg.load(path)
    return scene, scene.camera().with_(lens=LENS, f_stop=2.0)


def drawn_s(session: Session, work: Any) -> float:
    """Time to draw all work."""
    began = time.monotonic()
    limit = 1.0
    while size := work.prepare(limit):
        at = time.monotonic()
        work.draw(lambda fraction: True)
        limit = size * min(2.0, 3.0 / max(time.monotonic() - at, 1e-9))
    return time.monotonic() - began


def local(rounds: int = 3) -> dict[str, float]:
    """Two workers of one thread against one process of two threads."""
    from daguerre.rendering.schedule import work_of as here

    scene, camera = scene_and_camera()
    settings = dg.RenderSettings.of(resolution=(720, 480), spp=64, threads=2)
    one, two = [], []
    with opened("local:2") as pool:
        for warm in (True, *[False] * rounds):
            sessions = [Session(scene, camera, settings=settings) for _ in range(2)]
            alone = drawn_s(sessions[0], here(sessions[0], (0, 64), None))
            many = drawn_s(sessions[1], work_of(pool)(sessions[1], (0, 64), None, None))
            if not warm:
                one.append(alone)
                two.append(many)
    return {"one_s": min(one), "two_s": min(two), "ratio": min(two) / min(one)}


def start() -> dict[str, float]:
    """From nothing to the first sums of a local cluster."""
    scene, camera = scene_and_camera()
    session = Session(scene, camera, resolution=(240, 160), spp=2)
    began = time.monotonic()
    with opened("local:2") as pool:
        reached = time.monotonic() - began
        work: Any = work_of(pool)(session, (0, 2), None, None)
        while not session.ranges:
            work.prepare(1.0)
            work.draw(lambda fraction: True)
        return {"workers_s": reached, "first_sums_s": time.monotonic() - began}


def sequence(frames: int = 8, spp: int = 8) -> dict[str, float]:
    """Frames of 4K by two workers, against one process of two threads."""
    from daguerre import cli

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "scene.glb"
        write_scene(path)
        words = ["render", str(path), "--lens", LENS, "--res", "3840x2160", "--spp", str(spp)]
        words += ["--frames", f"1-{frames}", "-q"]
        began = time.monotonic()
        assert cli.main([*words, "-o", f"{folder}/a.####.exr", "--threads", "2"]) == 0
        alone = time.monotonic() - began
        with connected("local:2") as client:
            address = client.scheduler.address
            began = time.monotonic()
            assert cli.main([*words, "-o", f"{folder}/b.####.exr", "--cluster", address]) == 0
            many = time.monotonic() - began
    return {"one_s": alone, "two_s": many, "of_perfect": alone / many}


def recorded(size: tuple[int, int]) -> tuple[Session, bytes]:
    """A session, and an answer that a worker might send."""
    scene, camera = scene_and_camera()
    session = Session(scene, camera, resolution=size, spp=1 << 20)
    session.draw(0, 1)
    facts = {"seconds": SAMPLE_S, "set_up_s": 0.0, "pack_s": 0.0, "rays": 1, "tasks": 1}
    began = time.monotonic()
    packed_sums("w", session.key, session.state(), facts)
    facts["pack_s"] = time.monotonic() - began
    data = bytes(packed_sums("w", session.key, session.state(), facts))
    session.clear()
    return session, data


def random_view(size: int) -> memoryview:
    """Bytes as a worker sends them."""
    return memoryview(os.urandom(size))


def client(rounds: int = 20) -> dict[str, float]:
    """CPU of the client for an answer: to fetch it from a worker, and to check and add it."""
    from distributed import Client, wait

    session, data = recorded((960, 540))
    costs = []
    for k in range(rounds):
        began = time.thread_time()
        found = answer_of(data)
        assert isinstance(found, Sums)
        session.add(found.parts, [(k, k + 1)])
        costs.append(1e3 * (time.thread_time() - began))
    with own_processes() as address, Client(address) as real:
        futures = [real.submit(random_view, len(data), pure=False) for _ in range(rounds)]
        wait(futures)
        real.gather(futures[0], direct=True)
        fetches = []
        for future in futures[1:]:
            began = time.process_time()
            real.gather(future, direct=True)
            fetches.append(1e3 * (time.process_time() - began))
    fetch, add = statistics.median(fetches), statistics.median(costs)
    return {"mb": len(data) / 1e6, "fetch_ms": fetch, "add_ms": add, "sum_ms": fetch + add}


@contextmanager
def own_processes() -> Iterator[str]:
    """Scheduler and a worker in processes of their own, as on a farm; yields the address."""
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    address, here = f"tcp://127.0.0.1:{port}", str(Path(__file__).parent)
    path = os.environ.get("PYTHONPATH", "")
    started = [
        subprocess.Popen(
            [sys.executable, "-m", "daguerre", *words],
            stderr=subprocess.DEVNULL,
            env=os.environ | {"PYTHONPATH": f"{here}{os.pathsep}{path}"},
        )
        for words in (["scheduler", "--port", str(port)], ["worker", address, "--threads", "1"])
    ]
    try:
        yield address
    finally:
        for one in reversed(started):
            one.terminate()
            one.wait()


class FakeFuture:
    """Answer that is there after a while."""

    def __init__(self, data: bytes, ready: float, tasks: int, seconds: float) -> None:
        self._data, self._ready, self.key = data, ready, str(id(self))
        self.tasks, self.seconds = tasks, seconds

    @property
    def status(self) -> str:
        """Status of a future of Dask."""
        return "finished" if time.monotonic() >= self._ready else "pending"

    type = memoryview  # of the answer

    def result(self) -> memoryview:
        """The answer, of as many tasks as were folded; copied, as if it had come by a network."""
        head, words = self._data.split(b"\n", 1)
        told = json.loads(head)
        told["facts"] |= {"tasks": self.tasks, "seconds": self.seconds}
        told["facts"]["pack_s"] *= self.tasks
        return memoryview(head_line(**told) + words)


class FakeClient:
    """Client of Dask with many workers, each of which draws a sample in SAMPLE_S."""

    scheduler = SimpleNamespace(address="fake")
    security = None
    status = "running"

    def __init__(self, count: int, data: bytes) -> None:
        self._names = {f"w{k:04d}": 1 for k in range(count)}
        self._data = data
        # Workers begin at different times, as they do after a while.
        now = time.monotonic()
        self._free = deque(now + 15 * SAMPLE_S * k / count for k in range(count))
        self.answers = self.folds = 0

    def nthreads(self) -> dict[str, int]:
        """All workers."""
        return self._names

    def sync(self, function: Any) -> list[str]:
        """Workers that the client reaches: all."""
        return list(self._names)

    def gather(self, future: FakeFuture, direct: bool) -> memoryview:
        """The answer."""
        return future.result()

    def run(self, function: Any, *given: Any, workers: Any, **how: Any) -> dict[str, Any]:
        """Result of a short function on workers."""
        return {name: function(*given) for name in workers} if not given else {}

    def submit(self, function: Any, text: str, *given: Any, **how: Any) -> FakeFuture:
        """A task: drawn by the worker that is free next; folds take a second."""
        if function is on_worker.fold:
            self.folds += 1
            tasks, seconds = sum(one.tasks for one in given), sum(one.seconds for one in given)
            return FakeFuture(self._data, time.monotonic() + 1.0, tasks, seconds)
        self.answers += 1
        task = json.loads(text)
        seconds = SAMPLE_S * (task["end"] - task["begin"])
        ready = max(time.monotonic(), self._free.popleft()) + seconds
        self._free.append(ready)
        return FakeFuture(self._data, ready, 1, seconds)

    def processing(self) -> dict[str, list[str]]:
        """No worker is idle."""
        return {name: ["task"] for name in self._names}

    def cancel(self, futures: Any, **how: Any) -> None:
        """Nothing to stop."""


def simulated(size: tuple[int, int], count: int) -> dict[str, float]:
    """The real client against fake workers for a while."""
    session, data = recorded(size)
    fake = FakeClient(count, data)
    pool = WorkerPool(fake)
    pool.workers.wait()
    pool.per_second = 1 / SAMPLE_S
    work: Any = work_of(pool)(session, (0, 1 << 20), None, None)
    began, cpu, taken = time.monotonic(), time.process_time(), 0
    late = 0
    while time.monotonic() - began < LASTS_S:
        if work.prepare(1.0):
            taken += work._arrived is not None
            work.draw(lambda fraction: True)
        late = max(late, sum(one.done for one in pool.submissions))
    wall = time.monotonic() - began
    return {
        "workers": count,
        "width": size[0],
        "mb_per_answer": len(data) / 1e6,
        "cpu_share": (time.process_time() - cpu) / wall,
        "answers": fake.answers,
        "samples_added": sum(b - a for a, b in session.ranges),
        "taken": taken,
        "folds": fake.folds,
        "waiting_at_most": late,
        "rss_mb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
    }


def scale() -> Iterator[dict[str, float]]:
    """Rows over sizes and numbers of workers."""
    for size in ((960, 540), (3840, 2160)):
        for count in (10, 100, 1000):
            yield simulated(size, count)


BENCHES = {one.__name__: one for one in (start, client, local, sequence, scale)}


def main() -> None:
    """Prints figures."""
    parser = argparse.ArgumentParser(description="cost of a cluster")
    parser.add_argument("--only", nargs="+", choices=BENCHES, default=list(BENCHES))
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    found: dict[str, Any] = {}
    for name in options.only:
        made = BENCHES[name]()
        found[name] = []
        for row in [made] if isinstance(made, dict) else made:
            found[name].append(row)
            print(name, *(f"{key}={value:.4g}" for key, value in row.items()), flush=True)
    if options.json:
        options.json.write_text(json.dumps(found, indent=2) + "\n")


if __name__ == "__main__":
    main()
