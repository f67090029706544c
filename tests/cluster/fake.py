"""A client of Dask whose workers are this process and do what a test wants."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

PLAN = Callable[[str, Any, tuple[Any, ...]], Any]


@dataclass
class Future:
    """Result of a task that is known at once, or later."""

    key: str
    found: Any
    ready: float = 0.0
    cancelled: bool = False

    @property
    def status(self) -> str:
        if self.cancelled:
            return "cancelled"
        return "finished" if time.monotonic() >= self.ready else "pending"

    @property
    def type(self) -> type:
        return type(self.found)

    def result(self) -> Any:
        if isinstance(self.found, Exception):
            raise self.found
        return self.found


@dataclass
class Fake:
    """Client of Dask whose workers all are this process.

    Attributes:
        names: Addresses of the workers.
        plan: Called with worker, function and arguments instead of the function.
        slow: Seconds that a worker takes more, by its address.
        reached: Workers that accept connections; None: all.
    """

    names: list[str]
    plan: PLAN = lambda worker, function, given: function(*given)
    slow: dict[str, float] = field(default_factory=dict)
    reached: list[str] | None = None
    done: list[tuple[str, str]] = field(default_factory=list)
    gone: list[str] = field(default_factory=list)
    security: Any = None
    status: str = "running"
    turn: int = 0
    where: list[tuple[Future, str]] = field(default_factory=list)

    scheduler = SimpleNamespace(address="tcp://127.0.0.1:1")

    def nthreads(self) -> dict[str, int]:
        return dict.fromkeys(self.names, 1)

    def run(self, function: Any, *given: Any, workers: list[str], **how: Any) -> dict[str, Any]:
        return {name: function(*given) for name in workers}

    def submit(self, function: Any, *given: Any, workers: Any = None, **how: Any) -> Future:
        names = [name for name in self.names if workers is None or name in workers]
        self.turn += 1
        name = names[self.turn % len(names)]
        given = tuple(one.result() if isinstance(one, Future) else one for one in given)
        made = Future(f"task-{self.turn}", None, time.monotonic() + self.slow.get(name, 0.0))
        try:
            made.found = self.plan(name, function, given)
        except Exception as error:
            made.found = error
        self.done.append((name, function.__name__))
        self.where.append((made, name))
        return made

    def gather(self, future: Future, direct: bool) -> Any:
        assert direct == (self.reached is None)
        return future.result()

    def sync(self, function: Any) -> Any:
        return self.names if self.reached is None else self.reached

    def processing(self) -> dict[str, list[str]]:
        held: dict[str, list[str]] = {name: [] for name in self.names}
        for future, name in self.where:
            if future.status == "pending":
                held[name].append(future.key)
        return held

    def cancel(self, futures: list[Future], **how: Any) -> None:
        for future in futures:
            self.gone.append(future.key)
            future.cancelled = True
