"""The pool and the sharing of a picture, with workers in this process that do what a test wants."""

from __future__ import annotations

import json
import time
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np
import pytest

import daguerre as dg
from daguerre.cluster import sharing, store, workers
from daguerre.cluster import task as on_worker
from daguerre.cluster.answers import Failed, Needs, Sums, answer_of, head_line
from daguerre.cluster.pool import WorkerPool
from daguerre.cluster.spread import Spread
from daguerre.cluster.work import work_of
from daguerre.errors import InputError
from daguerre.rendering import Job, Output, Picture, View, auto_exposure, in_order, light_plan
from daguerre.rendering.checkpoint import Checkpoint
from daguerre.rendering.identity import build
from daguerre.rendering.loop import Loop
from daguerre.rendering.reporter import Control, Reporter
from daguerre.rendering.session import Session
from tests.viewfinder.test_painter import scene

from .fake import PLAN, Fake

HOW = dg.RenderSettings.of(resolution=(24, 16), spp=64)


@pytest.fixture(autouse=True)
def in_a_folder(tmp_path: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(store.FOLDER, str(tmp_path))
    monkeypatch.setattr(workers, "LOOK_S", 0.0)


def drawn(pool: WorkerPool, settings: dg.RenderSettings = HOW) -> dg.Frame:
    """Picture that a pool draws."""
    pool.workers.wait()
    made = scene()
    session = Session(made, made.camera(), settings=settings)
    sampling = settings.sampling
    work = work_of(pool)(session, (0, sampling.most), sampling.noise, None)
    assert Loop(session, work, Checkpoint(None), Reporter(), Control()).run()
    return session.frame()


def alone(settings: dg.RenderSettings = HOW) -> dg.Frame:
    made = scene()
    return dg.render(made, made.camera(), settings=settings)


@pytest.mark.parametrize("noise", [None, 0.08])
@pytest.mark.parametrize("adding", [1e9, 1e-9], ids=["by the client", "folded"])
def test_folded_or_not_the_bits_are_those_of_one_machine(
    monkeypatch: pytest.MonkeyPatch, adding: float, noise: float | None
) -> None:
    settings = HOW.with_(noise=noise)
    monkeypatch.setattr(sharing, "ADDING", adding)
    monkeypatch.setattr(sharing, "TASK_S", 1e-4)
    fake = Fake([f"w{k}" for k in range(9)])
    assert np.array_equal(drawn(WorkerPool(fake), settings).rgb, alone(settings).rgb)
    assert ("fold" in {what for _, what in fake.done}) == (adding < 1)


@pytest.mark.parametrize("mode", ["auto", "A"])
def test_workers_never_meter(monkeypatch: pytest.MonkeyPatch, mode: str) -> None:
    """The client does, once; workers get what it chose. Frames of a sequence share it."""
    metered: list[dg.Camera] = []
    choose = auto_exposure.choose

    def counted(scene: dg.Scene, camera: dg.Camera, *given: Any) -> Any:
        metered.append(camera)
        return choose(scene, camera, *given)

    monkeypatch.setattr(auto_exposure, "choose", counted)
    made = scene()
    camera = made.camera().with_(exposure=mode, shutter_time=None)
    pool = WorkerPool(Fake(["one", "two"]))
    pool.workers.wait()
    session = Session(made, camera, settings=HOW)
    work = work_of(pool)(session, (0, 8), None, None)
    assert Loop(session, work, Checkpoint(None), Reporter(), Control()).run()
    assert len(metered) == 1
    frame, by_one = session.frame(), dg.render(made, camera, settings=HOW.with_(spp=8))
    assert np.array_equal(frame.rgb, by_one.rgb)
    for fact in ("exposure", "isoSpeed", "expTime"):
        assert frame.metadata[fact] == by_one.metadata[fact]


def failed_on(bad: set[str], reason: str = "no space") -> PLAN:
    def plan(worker: str, function: Any, given: tuple[Any, ...]) -> Any:
        if worker in bad and function is on_worker.draw:
            return Failed(worker, reason).to_bytes()
        return function(*given)

    return plan


def test_a_failed_task_is_drawn_elsewhere() -> None:
    told: list[str] = []
    pool = WorkerPool(Fake(["good", "bad"], failed_on({"bad"})), tell=told.append)
    assert np.array_equal(drawn(pool).rgb, alone().rgb)
    assert pool.drawn_again > 0
    assert "cluster: bad: no space; its task is drawn again elsewhere" in told


def test_what_fails_in_a_fold_is_drawn_again(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sharing, "ADDING", 1e-9)
    monkeypatch.setattr(sharing, "TASK_S", 1e-4)
    fake = Fake([f"w{k}" for k in range(9)], failed_on({"w3"}))
    assert np.array_equal(drawn(WorkerPool(fake)).rgb, alone().rgb)
    assert "fold" in {what for _, what in fake.done}


def test_a_task_that_is_given_up_ends_the_render_when_all_else_is_drawn() -> None:
    def plan(worker: str, function: Any, given: tuple[Any, ...]) -> Any:
        if function is on_worker.draw and '"begin": 1,' in given[0]:
            return Failed(worker, "planted").to_bytes()
        return function(*given)

    pool = WorkerPool(Fake(["a", "b", "c", "d"], plan))
    pool.workers.wait()
    made = scene()
    session = Session(made, made.camera(), settings=HOW)
    work = work_of(pool)(session, (0, 64), None, None)
    wanted = r"cluster: samples 1:2 failed on \w, \w, \w: planted"
    with pytest.raises(InputError, match=wanted):
        Loop(session, work, Checkpoint(None), Reporter(), Control()).run()
    assert session.ranges == [(0, 1), (2, 64)]


def test_where_every_task_fails_the_render_ends_soon() -> None:
    names = ["a", "b", "c", "d"]
    fake = Fake(names, failed_on(set(names)))
    with pytest.raises(InputError, match=r"no space; in all, samples 0:\d were not drawn"):
        drawn(WorkerPool(fake))
    assert len(fake.done) < 60  # of 3 x 64


def test_a_worker_whose_disk_is_full_draws_nothing() -> None:
    class Full(Fake):
        def run(self, function: Any, *given: Any, workers: list[str], **how: Any) -> dict[str, Any]:
            if function is on_worker.keep and workers == ["full"]:
                return {"full": "/values: cannot write: No space left on device"}
            return super().run(function, *given, workers=workers)

    def plan(worker: str, function: Any, given: tuple[Any, ...]) -> Any:
        if worker == "full" and function is on_worker.draw:
            return Needs(worker, [json.loads(given[0])["scene"]]).to_bytes()
        return function(*given)

    told: list[str] = []
    pool = WorkerPool(Full(["good", "full"], plan), tell=told.append)
    assert np.array_equal(drawn(pool).rgb, alone().rgb)
    assert pool.workers.good == {"good"}
    assert sum("No space left on device; this worker is not used" in text for text in told) == 1
    with pytest.raises(InputError, match="failed on full: /values: cannot write: No space left"):
        drawn(WorkerPool(Full(["full"], plan)))


def test_a_worker_that_goes_while_it_gets_values_costs_nothing() -> None:
    class Going(Fake):
        def run(self, function: Any, *given: Any, workers: list[str], **how: Any) -> dict[str, Any]:
            if function is on_worker.keep and "going" in workers:
                self.names.remove("going")
                return {"going": OSError("connection lost")}
            return super().run(function, *given, workers=workers)

    pool = WorkerPool(Going(["good", "going"]))
    assert np.array_equal(drawn(pool).rgb, alone().rgb)


def test_a_late_task_is_drawn_twice_and_counts_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sharing, "STEP_S", 0.05)
    fake = Fake(["quick", "slow"], slow={"slow": 60.0})
    began = time.monotonic()
    assert np.array_equal(drawn(WorkerPool(fake)).rgb, alone().rgb)
    assert time.monotonic() - began < 30
    assert fake.gone  # the task of the slow worker


def test_a_late_answer_of_a_worker_thought_dead_counts_once() -> None:
    fake = Fake(["a", "b"])
    pool = WorkerPool(fake)
    pool.workers.wait()
    made = scene()
    session = Session(made, made.camera(), settings=HOW)
    work: Any = work_of(pool)(session, (0, 64), None, None)
    while session.ranges != [(0, 64)]:
        assert work.prepare(1.0)
        for submission in list(pool.submissions):  # each comes a second time
            pool.begin(submission.task)
        work.draw(lambda fraction: True)
    assert np.array_equal(session.frame().rgb, alone().rgb)


def test_workers_of_another_build_draw_nothing() -> None:
    class Mixed(Fake):
        def run(self, function: Any, *given: Any, workers: Any, **how: Any) -> dict[str, Any]:
            found = super().run(function, *given, workers=workers)
            if function is on_worker.worker_build:
                found |= {"old": "0.9 x86_64 SSE4", "bare": ModuleNotFoundError("no daguerre")}
            return {name: value for name, value in found.items() if name in workers}

    told: list[str] = []
    fake = Mixed(["good", "old", "bare"])
    assert np.array_equal(drawn(WorkerPool(fake, tell=told.append)).rgb, alone().rgb)
    assert {name for name, _ in fake.done} == {"good"}
    assert any(f"old: build: wanted the same as the client's, {build()}" in text for text in told)
    assert any("bare: it has no daguerre of this version" in text for text in told)
    with pytest.raises(InputError, match="no worker can draw: old: build"):
        drawn(WorkerPool(Mixed(["old"])))


def test_wrong_sums_refuse_their_worker() -> None:
    def plan(worker: str, function: Any, given: tuple[Any, ...]) -> Any:
        data = function(*given)
        found = answer_of(data)
        if worker == "liar" and isinstance(found, Sums):
            head, words = bytes(data).split(b"\n", 1)
            key = found.key | {"scene": "another"}
            lie = json.loads(head) | {"key": key, "worker": worker}
            return memoryview(head_line(**lie) + words)
        return data

    told: list[str] = []
    pool = WorkerPool(Fake(["good", "liar"], plan), tell=told.append)
    assert np.array_equal(drawn(pool).rgb, alone().rgb)
    assert pool.workers.good == {"good"}
    assert any("liar: scene: wanted the same as the client's" in text for text in told)


def test_damaged_answers_are_drawn_again() -> None:
    spoilt: list[bytes] = []

    def plan(worker: str, function: Any, given: tuple[Any, ...]) -> Any:
        data = function(*given)
        if isinstance(answer_of(data), Sums) and len(spoilt) < 2:
            spoilt.append(data)
            return bytes(data[:-1]) + bytes([data[-1] ^ 1])
        return data

    pool = WorkerPool(Fake(["a", "b", "c", "d"], plan))
    assert np.array_equal(drawn(pool).rgb, alone().rgb)
    assert len(spoilt) == 2


def test_no_worker_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(workers, "PATIENCE_S", 0.1)
    with pytest.raises(InputError, match=r"tcp://127.0.0.1:1: wanted a worker within 0.1 s"):
        drawn(WorkerPool(Fake([])))


def test_tasks_bound_to_a_worker_that_goes_begin_anew() -> None:
    fake = Fake(["a", "b", "c"], failed_on({"b"}), slow={"c": 1e9})
    pool = WorkerPool(fake)
    pool.workers.wait()
    made = scene()
    session = Session(made, made.camera(), settings=HOW)
    place = pool.values.keep(session.scene), pool.values.keep((session.camera, HOW, None))
    submission = pool.begin(on_worker.Task(*place, 0, 1), but={"a", "b"})
    assert submission.only == {"c"}
    fake.names.remove("c")
    pool.look()
    assert [one.task for one in pool.submissions] == [submission.task]
    assert not pool.submissions[0].only


def test_pictures_of_a_sequence_go_to_a_worker_each(tmp_path: Path) -> None:
    drew: dict[str, list[str]] = {}

    def plan(worker: str, function: Any, given: tuple[Any, ...]) -> Any:
        answer = function(*given)
        if function is on_worker.draw and isinstance(answer, memoryview):
            drew.setdefault(json.loads(given[0])["scene"], []).append(worker)
        return answer

    def job(name: str) -> Job:
        output = Output((tmp_path / f"{name}.####.exr",))
        settings = HOW.with_(spp=16)
        return Job(scene(), in_order([Picture(View(), settings, output)], range(1, 8)))

    fake = Fake(["a", "b", "c"])
    fake.plan = plan
    pool, many = WorkerPool(fake), job("many")
    pool.workers.wait()
    many.work_of = work_of(pool, many)
    assert many.run()
    assert job("alone").run()
    for frame in range(1, 8):
        names = (tmp_path / f"{name}.{frame:04d}.exr" for name in ("many", "alone"))
        a, b = (dg.load_frame(name).rgb for name in names)
        assert np.array_equal(a, b), frame
    assert len(drew) == 7
    by_one = [names for names in drew.values() if len(set(names)) == 1]
    assert len(by_one) >= 4  # the last ones are drawn by whoever is idle
    assert {names[0] for names in by_one} == {"a", "b", "c"}
    assert len(pool.values._kept) == 2  # scene and view of the last one


@pytest.mark.parametrize("slow", [{}, {"a": 0.5, "b": 0.5}], ids=["done", "under way"])
def test_workers_do_the_pilot_renders_of_pictures_to_come(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, slow: dict[str, float]
) -> None:
    at: list[str] = []
    pilot = light_plan.pilot

    def plan(worker: str, function: Any, given: tuple[Any, ...]) -> Any:
        at.append(worker)
        answer = function(*given)
        at.pop()
        return answer

    def counted(*given: Any) -> Any:
        pilots.append(at[-1] if at else "client")
        return pilot(*given)

    pilots: list[str] = []
    monkeypatch.setattr(light_plan, "pilot", counted)
    settings = HOW.with_(spp=1, light_paths="auto")
    pictures = in_order([Picture(View(), settings, Output((tmp_path / "a.#.exr",)))], range(1, 6))
    job, fake = Job(scene(), pictures), Fake(["a", "b"], plan, slow)
    pool = WorkerPool(fake)
    pool.workers.wait()
    job.work_of = work_of(pool, job)
    assert job.run()
    assert pilots[0] == "client"
    assert "client" not in pilots[1:]
    assert {"a", "b"} >= set(pilots[1:]) != set()


def test_a_stop_ends_the_wait_for_a_pilot_render(tmp_path: Path) -> None:
    class Stopping(Control):
        def poll(self) -> None:
            self.stops = 1

    picture = Picture(View(), HOW.with_(spp=1), Output((tmp_path / "a.#.exr",)))
    job = Job(scene(), in_order([picture], range(1, 4)), control=Stopping())
    pool = WorkerPool(Fake(["a"], slow={"a": 60.0}))
    pool.workers.wait()
    spread = Spread(pool, job)
    session = job.open(job.pictures[0])
    sharing_ = sharing.Sharing(session, pool, spread.open(session))
    spread.fill(sharing_, (0, 1), [])
    began = time.monotonic()
    assert spread.piloted(job.pictures[1]) is None
    assert time.monotonic() - began < 10
    assert job.control.stops


def test_tasks_are_long_if_their_answers_are_work() -> None:
    pool = WorkerPool(Fake(["a", "b"]))
    pool.workers.wait()
    made = scene()
    session, spread = Session(made, made.camera(), settings=HOW), Spread(pool)
    one = sharing.Sharing(session, pool, spread.open(session))
    assert one.size(1e9) == 1  # nothing is known
    pool.per_second = 2.0
    assert one.size(1e9) == 2 * sharing.TASK_S
    pool.answer_s = 3.0
    assert one.size(1e9) == 2 * sharing.WORTH * 3
    pool.answer_s = 100.0
    assert one.size(1e9) == 2 * sharing.LONG_S
    pool.answer_s = 0.1
    assert one.size(20) == 5  # two for each worker
    pool.answer_s = 0.4
    assert one.size(20) == 2 * sharing.LAST_WORTH * 0.4  # a shorter one would not pay
    pool.answer_s = 3.0
    assert one.size(20) == 10  # none is idle


def test_a_remnant_is_no_task_of_its_own() -> None:
    pool = WorkerPool(Fake(["a"]))
    pool.workers.wait()
    made = scene()
    session, spread = Session(made, made.camera(), settings=HOW), Spread(pool)
    one = sharing.Sharing(session, pool, spread.open(session))
    for last, wanted in ((4, [(0, 4)]), (11, [(0, 3), (3, 6)])):
        with mock.patch.object(one, "size", return_value=3.0):
            spread.fill(one, (0, last), [])
        assert [
            (submission.task.begin, submission.task.end) for submission in pool.submissions
        ] == wanted
        pool.drop_all()


def test_answers_of_workers_that_the_client_cannot_reach_come_through_the_scheduler() -> None:
    fake = Fake(["a", "b"], reached=["a"])  # the fake checks which way is taken
    assert np.array_equal(drawn(WorkerPool(fake)).rgb, alone().rgb)


def test_a_wish_for_values_of_a_picture_to_come_is_served_at_once() -> None:
    pool = WorkerPool(Fake(["a"]))
    pool.workers.wait()
    made = scene()
    keep = pool.values.keep
    submission = pool.begin(
        on_worker.Task(keep(made), keep((made.camera(), HOW, None, None)), 0, 1)
    )
    assert submission.has_words
    pool.serve()
    (again,) = pool.submissions
    assert again.task == submission.task
    assert again.has_sums
