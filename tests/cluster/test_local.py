"""Pictures of a local cluster have the bits of one machine, whatever happens to its workers."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import daguerre as dg
from daguerre import cli
from daguerre.cluster import task as on_worker
from daguerre.cluster.address import connected
from daguerre.cluster.pool import WorkerPool
from daguerre.cluster.work import work_of
from daguerre.cluster.workers import reached
from daguerre.errors import InputError
from daguerre.rendering.checkpoint import Checkpoint
from daguerre.rendering.loop import Loop
from daguerre.rendering.reporter import Control, Reporter
from daguerre.rendering.session import Session
from tests.faults.scene import write_scene

from .farm import listening

pytest.importorskip("distributed", reason="needs the extra cluster")
pytestmark = pytest.mark.xdist_group("cluster")
LENS = "double-gauss-50mm-f2"


@pytest.fixture(scope="module")
def client(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("DAGUERRE_CLUSTER_CACHE", str(tmp_path_factory.mktemp("cache")))
        with connected("local:2") as made:
            yield made


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_scene(tmp_path_factory.mktemp("scene") / "scene.glb")


def drawn(pool: WorkerPool, session: Session) -> dg.Frame:
    """Frame of a session that a pool draws."""
    pool.workers.wait()
    sampling = session.settings.sampling
    work = work_of(pool)(session, (0, sampling.most), sampling.noise, None)
    assert Loop(session, work, Checkpoint(None), Reporter(), Control()).run()
    return session.frame()


SETTINGS: dict[str, dict[str, Any]] = {
    "samples": {"spp": 24},
    "noise": {"noise": 0.1, "spp": 128},
    "all layers": {"spp": 8, "aovs": True, "cryptomatte": ("object",), "bands": 4},
    "light paths and flare": {"spp": 8, "light_paths": "auto", "flare": "auto"},
    "crop": {"spp": 8, "crop": (5, 3, 30, 21)},
}


@pytest.mark.parametrize("given", SETTINGS.values(), ids=SETTINGS)
def test_the_bits_are_those_of_one_machine(client: Any, file: Path, given: dict[str, Any]) -> None:
    scene = dg.load(file)
    camera = scene.camera().with_(lens=LENS, shutter_type="electronic")
    settings = dg.RenderSettings.of(resolution=(48, 32), **given)
    alone = dg.render(scene, camera, settings=settings)
    frame = drawn(WorkerPool(client), Session(scene, camera, settings=settings))
    assert np.array_equal(frame.rgb, alone.rgb)
    assert np.array_equal(frame.variance, alone.variance, equal_nan=True)
    assert frame.aovs.keys() == alone.aovs.keys()
    for name, plane in frame.aovs.items():
        assert np.array_equal(plane, alone.aovs[name], equal_nan=True), name


def test_a_scene_travels_once_to_each_worker(client: Any, file: Path) -> None:
    pool, scene = WorkerPool(client), dg.load(file)
    scene.node_positions["only of this test"] = np.zeros(3)
    sent: list[str] = []
    run = client.run
    pool.client = type("Counting", (), {"__getattr__": lambda self, name: getattr(client, name)})()

    def counted(function: Any, *given: Any, **more: Any) -> Any:
        if function is on_worker.keep:
            sent.extend(f"{given[0]} {one}" for one in more["workers"])
        return run(function, *given, **more)

    pool.client.run = counted
    for seed in (1, 2):
        session = Session(scene, LENS and scene.camera(), resolution=(24, 16), spp=8, seed=seed)
        drawn(pool, session)
    name = pool.values.keep(scene)
    of_scene = [one for one in sent if one.startswith(name)]
    assert 1 <= len(of_scene) == len(set(of_scene)) <= 2


def test_a_killed_worker_costs_nothing(client: Any, file: Path) -> None:
    scene = dg.load(file)
    session = Session(scene, scene.camera(), resolution=(96, 64), spp=256)
    alone = dg.render(scene, scene.camera(), resolution=(96, 64), spp=256)
    told: list[str] = []
    pids = client.run(os.getpid)
    victim = pids[sorted(pids)[0]]
    timer = threading.Timer(0.7, os.kill, (victim, signal.SIGKILL))
    timer.start()
    frame = drawn(WorkerPool(client, tell=told.append), session)
    timer.join()
    assert np.array_equal(frame.rgb, alone.rgb)
    end = time.monotonic() + 30
    while victim in client.run(os.getpid).values():
        assert time.monotonic() < end
        time.sleep(0.1)


def test_all_of_a_local_cluster_listens_on_this_machine_alone(client: Any) -> None:
    assert listening(os.getpid()) == {"127.0.0.1"}


def test_answers_come_from_workers_that_can_be_reached(client: Any) -> None:
    there = set(client.nthreads())
    assert reached(client, [*there, "tcp://127.0.0.1:1"]) == there


def test_a_script_without_a_main_guard_is_told_so(file: Path, tmp_path: Path) -> None:
    script = tmp_path / "draw.py"
    script.write_text(
        "import daguerre as dg\n"
        f"dg.render(dg.load({str(file)!r}), resolution=(24, 16), spp=1, cluster='local:1')\n"
    )
    ran = subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=60)
    assert ran.returncode == 1
    assert 'put it under `if __name__ == "__main__":`' in ran.stderr
    assert ran.stderr.strip().splitlines()[-1].startswith("daguerre.errors.InputError: cluster:")


def fails(*given: object) -> bytes:
    """A task on a worker that cannot."""
    raise OSError(28, "No space left on device")


def test_a_task_that_fails_everywhere_is_said(
    client: Any, file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(on_worker, "draw", fails)
    scene = dg.load(file)
    session = Session(scene, scene.camera(), resolution=(24, 16), spp=8)
    with pytest.raises(InputError, match=r"cluster: samples \d+:\d+ failed on .*No space left"):
        drawn(WorkerPool(client), session)


def test_a_worker_of_another_build_is_refused_by_name(client: Any, file: Path) -> None:
    scene = dg.load(file)
    session = Session(scene, scene.camera(), resolution=(24, 16), spp=8)
    session.key["build"] = "1.2.3 of another machine"
    with pytest.raises(InputError, match=r"build: wanted the same as the client's, 1\.2\.3"):
        drawn(WorkerPool(client), session)
    session.clear()
    drawn(WorkerPool(client, mixed=True), session)


@pytest.mark.parametrize(
    "flags",
    [[], ["--exposure", "auto", "--ev", "1"], ["--exposure", "A", "--time", "0.4"]],
    ids=["light", "auto", "A"],
)
def test_the_command(
    client: Any, file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, flags: list[str]
) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "86400")
    words = ["render", str(file), "--res", "48x32", "--spp", "16", "-q", "--sky", "9,9,9", *flags]
    address = client.scheduler.address
    for name, cluster in (("a", []), ("b", ["--cluster", address])):
        files = [f"{tmp_path}/{name}.{end}" for end in ("exr", "png")]
        assert cli.main([*words, "-o", files[0], "-o", files[1], *cluster]) == 0
    a, b = (dg.load_frame(tmp_path / name) for name in ("a.exr", "b.exr"))
    assert np.array_equal(a.rgb, b.rgb)
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()
    for fact in ("exposure", "isoSpeed", "expTime", "metering"):
        assert a.metadata.get(fact) == b.metadata.get(fact), fact


@pytest.mark.parametrize(
    ("address", "said"),
    [
        ("nonsense", "wanted local, local:N, tcp://HOST:PORT"),
        ("tcp://10.1.2.3:8786", "wanted tls:// for another machine"),
        ("http://127.0.0.1:1", "wanted local"),
        ("local:0", "1 to 1024 workers"),
        ("missing.yaml", "missing.yaml: no such file"),
    ],
)
def test_wrong_addresses(
    file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], address: str, said: str
) -> None:
    words = ["render", str(file), "-o", str(tmp_path / "a.exr"), "--cluster", address]
    assert cli.main(words) in (2, 3)
    assert said in capsys.readouterr().err
    assert not (tmp_path / "a.exr").exists()
