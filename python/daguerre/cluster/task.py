"""Tasks: functions that a worker runs; they take and return text and bytes."""

from __future__ import annotations

import json
import threading
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from functools import lru_cache
from typing import Any

import daguerre._core as _core
from daguerre.errors import DaguerreError, MismatchError
from daguerre.rendering.adaptive import Round
from daguerre.rendering.identity import build
from daguerre.rendering.session import Session

from .answers import Failed, Needs, Sums, answer_of, packed_sums
from .store import Store

#: One task draws at a time, by all threads of the worker.
_DRAWS = threading.Lock()


@dataclass(frozen=True)
class SceneKey:
    """Hashes of a scene, and of its camera and settings."""

    scene: str
    view: str


@dataclass(frozen=True)
class Task:
    """Part of a picture to draw.

    Attributes:
        scene: Hash of the scene.
        view: Hash of camera and settings.
        begin: First sample of every pixel, or first part of the round.
        end: One past the last.
        round: Hash of a round of adaptive sampling; None: samples of every pixel.
    """

    scene: str
    view: str
    begin: int
    end: int
    round: str | None = None

    @property
    def values(self) -> list[str]:
        """Hashes of the values that it needs."""
        return [name for name in (self.scene, self.view, self.round) if name is not None]

    @property
    def words(self) -> str:
        """The samples, or the parts of a round."""
        what = "samples" if self.round is None else "parts of a round"
        return f"{what} {self.begin}:{self.end}"

    def to_text(self) -> str:
        """JSON of the task."""
        return json.dumps(asdict(self))


def draw(text: str) -> bytes | memoryview:
    """Draws a task; returns an answer: sums as a memoryview, which Dask does not pickle."""
    return _answered(Task(**json.loads(text)), _drawn)


def fold(text: str, *answers: memoryview) -> bytes | memoryview:
    """Adds answers of tasks with adjacent samples; returns a single answer for all.

    If one of them is no sums, the new answer has failed, and the client looks at each by itself.
    """
    return _answered(Task(**json.loads(text)), lambda task: _folded(task, answers))


def keep(name: str, data: bytes) -> str:
    """Keeps a value for tasks to come; returns why not, or nothing."""
    try:
        Store().put(name, data)
    except Exception as error:
        return _reason(error)
    return ""


def worker_build() -> str:
    """Build of this worker."""
    return build()


def _answered(task: Task, act: Callable[[Task], memoryview]) -> bytes | memoryview:
    """Answer of an act, also if it raises: the client unpickles nothing that a worker made.

    Dask tells its client the type of a result before the client fetches it.
    """
    try:
        with _DRAWS:
            lacking = Store().lacks(task.values)
            if not lacking:
                return act(task)
            return Needs(_address(), lacking).to_bytes()
    except Exception as error:
        return Failed(_address(), _reason(error)).to_bytes()


def _reason(error: Exception) -> str:
    """Sentence that says why a worker cannot do its task."""
    if isinstance(error, MemoryError):
        return "out of memory"
    return str(error) if isinstance(error, DaguerreError | OSError) else repr(error)


def _drawn(task: Task) -> memoryview:
    began = time.monotonic()
    session = _session(task.scene, task.view, _threads())
    ready = time.monotonic()
    session.clear()
    if task.round is None:
        session.draw(task.begin, task.end)
    else:
        begin, count = Store().value(task.round)
        session.round = Round(begin, count, task.begin)
        session.draw_round(task.end)
    facts = {
        "seconds": time.monotonic() - ready,
        "set_up_s": ready - began,
        "pack_s": _pack_s,
        "rays": int(session.counters.rays),
        "tasks": 1,
    }
    return _packed(session, facts)


def _folded(task: Task, answers: tuple[memoryview, ...]) -> memoryview:
    session = _session(task.scene, task.view, _threads())
    session.clear()
    facts: dict[str, Any] = dict.fromkeys(_ADDED, 0)
    for data in answers:
        found = answer_of(data)
        if not isinstance(found, Sums):
            raise MismatchError("fold: wanted sums of all tasks")
        found.check_key(session.key)
        session.add(found.parts)
        facts = {name: value + found.fact(name) for name, value in facts.items()}
    return _packed(session, facts)


def _packed(session: Session, facts: dict[str, Any]) -> memoryview:
    """Sums of a session; with the result of the pilot render, which spares the client its own."""
    global _pack_s
    began = time.monotonic()
    facts["piloted"] = session.light_plan.piloted
    found = packed_sums(_address(), session.key, session.state(), facts)
    _pack_s = time.monotonic() - began
    return found


#: Facts that add up over tasks.
_ADDED = ("seconds", "set_up_s", "pack_s", "rays", "tasks")
#: Time that the last sums took to be packed, s.
_pack_s = 0.0


@lru_cache(maxsize=1)
def _scene(name: str) -> Any:
    return Store().value(name)


def _session(scene: str, view: str, threads: int) -> Session:
    """Session of a picture; the newest is kept.

    The next session reuses its memory, and its built scene if it shows the same scene.
    """
    global _last, _kept
    _kept = _kept or _core.KeptFilms()
    if _last is None or _last[0] != (scene, view, threads):
        built = None if _last is None else _last[1].built
        _last = None  # its film ends here
        camera, settings, piloted, origin = Store().value(view)
        settings = replace(settings, threads=threads)
        fixed = {"built": built, "piloted": piloted, "origin": origin}
        made = Session(_scene(scene), camera, settings=settings, **fixed)
        _last = (scene, view, threads), made
    return _last[1]


#: The newest session, with its scene, view and number of threads.
_last: tuple[tuple[str, str, int], Session] | None = None
#: Keeps the memory of films for the next session.
_kept: Any = None


def _worker() -> Any:
    """Worker of Dask that runs this; None: none does, as in a test."""
    from distributed import get_worker

    try:
        return get_worker()
    except ValueError:
        return None


def _threads() -> int:
    """Threads of the worker; 0: all cores."""
    worker = _worker()
    return 0 if worker is None else int(worker.state.nthreads)


def _address() -> str:
    worker = _worker()
    return "worker" if worker is None else str(worker.address)
